#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace parallax::harness {

/// The identity of a program at work: two with the same identity give the same runs.
struct ProgramIdentity {
  std::string version;  // "0.2.0"
  std::string build;  // tells builds apart, those of the libraries that are loaded with it as well
  std::string arithmetic;  // tells processors apart (arithmetic_digits); empty: it does not say
  friend bool operator==(const ProgramIdentity&, const ProgramIdentity&) = default;
};

/// The identity of this process.
ProgramIdentity this_program(std::string version);

/// "0.2.0 (build 5f2c..., arithmetic 81d0...)".
std::string to_string(const ProgramIdentity& identity);

/// The line with which a worker says who it is, before it is asked anything.
std::string greeting_line(const ProgramIdentity& identity);
/// None for a line that is no such line.
std::optional<ProgramIdentity> parse_greeting(std::string_view line);

}  // namespace parallax::harness
