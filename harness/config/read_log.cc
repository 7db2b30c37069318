#include "harness/config/read_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "harness/config/yaml_reader.h"

namespace parallax::harness {

std::string number_text(double value) {
  constexpr double kMostWhole = 9007199254740992.0;  // 2^53: whole numbers below it are exact
  if (std::trunc(value) == value && std::abs(value) < kMostWhole) {
    return fmt::format("{}", static_cast<std::int64_t>(value));
  }
  return fmt::format("{}", value);
}

std::string list_text(std::span<const std::string> items) {
  return fmt::format("[{}]", fmt::join(items, ", "));
}

void ReadLog::attach(YamlNode& root) {
  root.log = this;
  root.id = static_cast<std::uint32_t>(notes_.size());
  notes_.emplace_back();
  for (auto& entry : root.entries) attach(entry.value);
  // Corners of hulls are many, and nothing is said of a number inside a list.
  for (auto& item : root.items) {
    if (!item.is_list()) attach(item);
  }
}

ReadLog::Notes* ReadLog::of(const YamlNode& node) {
  return node.log == nullptr ? nullptr : &node.log->notes_[node.id];
}

const ReadLog::Notes& ReadLog::notes(const YamlNode& node) const {
  return notes_[node.log == this ? node.id : 0];
}

void ReadLog::fallback(const YamlNode& map, std::string_view key, std::string value) {
  auto* notes = of(map);
  if (notes == nullptr) return;
  const auto& required = notes->required;
  if (std::find(required.begin(), required.end(), key) != required.end()) return;
  notes->fallbacks.insert_or_assign(std::string(key), std::move(value));
}

void ReadLog::fallback(const YamlNode& map, std::string_view key, double value) {
  // A value that is filled in later from other values is no number yet.
  if (map.log != nullptr && std::isfinite(value)) fallback(map, key, number_text(value));
}

void ReadLog::fallback(const YamlNode& map, std::string_view key, std::span<const double> values) {
  if (map.log == nullptr) return;
  std::vector<std::string> items;
  for (const double value : values) {
    if (!std::isfinite(value)) return;
    items.push_back(number_text(value));
  }
  fallback(map, key, list_text(items));
}

void ReadLog::fallback(const YamlNode& map, std::string_view key,
                       const std::vector<std::string>& values) {
  if (map.log != nullptr) fallback(map, key, list_text(values));
}

void ReadLog::required(const YamlNode& map, std::string_view key) {
  auto* notes = of(map);
  if (notes == nullptr) return;
  notes->required.emplace_back(key);
  notes->fallbacks.erase(std::string(key));
}

void ReadLog::known(const YamlNode& map, std::span<const std::string_view> keys) {
  if (auto* notes = of(map)) notes->known.assign(keys.begin(), keys.end());
}

void ReadLog::stands_for(const YamlNode& scalar, std::string_view key) {
  if (auto* notes = of(scalar)) notes->stands_for = key;
}

void ReadLog::text(const YamlNode& scalar) {
  if (auto* notes = of(scalar)) notes->is_text = true;
}

void ReadLog::optional(const YamlNode& map) {
  if (auto* notes = of(map)) notes->is_optional = true;
}

}  // namespace parallax::harness
