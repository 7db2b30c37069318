#include "compiler/base/json.h"

#include <algorithm>

#include "compiler/base/shown_text.h"

template class nlohmann::basic_json<>;
template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace parallax::base {
namespace {

template <typename Json>
std::string text_of(const Json& json, int indent) {
  auto text = json.dump(indent, ' ', false, Json::error_handler_t::replace);
  // The library escapes C0 only. Whatever else steers a display stands in a string, too.
  const bool is_plain = std::all_of(text.begin(), text.end(),
                                    [](char c) { return static_cast<unsigned char>(c) < 0x7F; });
  return is_plain ? text : shown_markup(text);
}

template <typename Json>
Json parsed(std::string_view text) {
  return Json::parse(text.begin(), text.end(), nullptr, false);
}

}  // namespace

std::string json_text(const nlohmann::json& json, int indent) { return text_of(json, indent); }

std::string json_text(const nlohmann::ordered_json& json, int indent) {
  return text_of(json, indent);
}

nlohmann::json parse_json(std::string_view text) { return parsed<nlohmann::json>(text); }

nlohmann::ordered_json parse_ordered_json(std::string_view text) {
  return parsed<nlohmann::ordered_json>(text);
}

std::string json_quoted(std::string_view text) { return json_text(nlohmann::json(text)); }

}  // namespace parallax::base
