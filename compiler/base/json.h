#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

// Made once, in json.cc: else each batch of sources compiles reader and writer anew.
extern template class nlohmann::basic_json<>;
extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace parallax::base {

/// A document as text, on one line or with `indent` blanks for each level. Texts may hold any bytes
/// (file names do): invalid UTF-8 becomes U+FFFD, where nlohmann would throw. Characters that
/// control a display are escaped (shown_text.h), so that the text can be shown as it is.
std::string json_text(const nlohmann::json& json, int indent = -1);
std::string json_text(const nlohmann::ordered_json& json, int indent = -1);

/// Parses `text`; the result is discarded (`is_discarded`) if it is not JSON.
nlohmann::json parse_json(std::string_view text);
nlohmann::ordered_json parse_ordered_json(std::string_view text);

/// One string as JSON writes it, with its quotes.
std::string json_quoted(std::string_view text);

/// The value, if it has exactly this type. Only integers are converted, to `double`; a number that
/// does not fit gives none.
template <typename T, typename Json>
std::optional<T> json_as(const Json& value) {
  bool fits = false;
  if constexpr (std::is_same_v<T, std::string>) {
    fits = value.is_string();
  } else if constexpr (std::is_same_v<T, bool>) {
    fits = value.is_boolean();
  } else if constexpr (std::is_same_v<T, double>) {
    fits = value.is_number();
  } else if constexpr (std::is_same_v<T, std::uint64_t>) {
    fits = value.is_number_unsigned();
  } else {
    static_assert(std::is_same_v<T, std::int64_t>, "a type that JSON has");
    fits = value.is_number_integer() &&
           !(value.is_number_unsigned() && value.template get<std::uint64_t>() > INT64_MAX);
  }
  if (!fits) return std::nullopt;
  return value.template get<T>();
}

/// The member of an object; null if it is absent or `object` is not an object.
template <typename Json>
const Json* json_member(const Json& object, const char* name) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  return found == object.end() ? nullptr : &*found;
}

}  // namespace parallax::base
