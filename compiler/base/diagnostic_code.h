#pragma once

#include <cstdint>
#include <string_view>

/// The registry of diagnostics stands in codes/*.def by subject, so that a new one recompiles only
/// the sources that include its subject's header. Each has one line:
/// PARALLAX_DIAGNOSTIC(name, code, severity, class, fmt format of the message, how to mend it)
/// A code is never reused. Messages: lower case, no full stop, source quoted in backticks.
namespace parallax::base {

/// One kind of diagnostic; its values are the names in parallax::codes. Orders as the codes do:
/// by number, errors before warnings.
enum class DiagnosticCode : std::uint16_t {};

/// Code of an id such as "E5102", "W7002" or "CPL012". Plan ids take the numbers from 3900 on, so
/// they come between the other E3xxx codes and E4000.
constexpr DiagnosticCode code_of(std::string_view id) {
  const bool plan = id.front() == 'C';
  unsigned number = 0;
  for (const char c : id.substr(plan ? 3 : 1))
    number = 10 * number + static_cast<unsigned>(c - '0');
  if (plan) number += 3900;
  return static_cast<DiagnosticCode>(2 * number + (id.front() == 'W' ? 1 : 0));
}

}  // namespace parallax::base
