#pragma once

#include <optional>
#include <string>

#include "compiler/base/json.h"
#include "runtime/compare/trace_difference.h"

namespace parallax::tools {

/// "12", "at least 200", "an unknown number".
inline std::string number_text(const std::optional<runtime::TraceNumber>& number) {
  if (!number) return "an unknown number";
  return (number->exact ? "" : "at least ") + number->value.get_str();
}

/// A number, or a text where it is too large for one; null: not known.
inline nlohmann::ordered_json number_json(const std::optional<runtime::TraceNumber>& number) {
  if (!number) return nullptr;
  const bool small = number->value <= mpz_class("9007199254740992");
  return small ? nlohmann::ordered_json(number->value.get_ui())
               : nlohmann::ordered_json(number->value.get_str());
}

}  // namespace parallax::tools
