#include <charconv>
#include <cstdint>
#include <functional>
#include <vector>

#include "tools/bench/families/families.h"

namespace parallax::tools {
namespace {

using Parameters = std::vector<int>;

struct Family {
  std::string_view name;
  std::size_t parameters = 0;
  std::size_t may_be_negative = 0;  // the last so many
  std::function<std::optional<std::string>(const Parameters&)> text;
};

/// A share of nothing, or nobody to pay: such a bank has no transfer.
std::optional<BankSize> bank_size(const Parameters& p) {
  if (p[0] < 2 || p[1] < p[0]) return std::nullopt;
  return BankSize{p[0], p[1], p[2], p[3]};
}

const std::vector<Family>& families() {
  static const std::vector<Family> all = {
      {"lamps", 2, 0, [](const Parameters& p) { return lamps_model(p[0], p[1]); }},
      {"robot", 3, 1,
       [](const Parameters& p) -> std::optional<std::string> {
         const std::int64_t horizon = p[1] * (std::int64_t{p[0]} + 1) + p[2];
         if (p[0] < 2 || horizon < 1 || horizon > kMaxFamilyParameter) return std::nullopt;
         return robot_model(p[0], p[1], p[2]);
       }},
      {"pigeon", 2, 0, [](const Parameters& p) { return pigeon_model(p[0], p[1]); }},
      {"chain", 1, 0,
       [](const Parameters& p) -> std::optional<std::string> {
         if (p[0] < 2) return std::nullopt;
         return chain_model(p[0]);
       }},
      {"bankproj", 4, 0,
       [](const Parameters& p) -> std::optional<std::string> {
         const auto size = bank_size(p);
         if (!size) return std::nullopt;
         return bank_projection_model(*size);
       }},
      {"bankplan", 4, 0,
       [](const Parameters& p) -> std::optional<std::string> {
         const auto size = bank_size(p);
         if (!size) return std::nullopt;
         return bank_planning_model(*size);
       }},
      {"falling", 1, 0,
       [](const Parameters& p) -> std::optional<std::string> {
         if (p[0] < 3) return std::nullopt;
         return falling_model(p[0]);
       }},
  };
  return all;
}

/// `7`, or `m1` for -1 (a name that is also a file name).
std::optional<int> parameter(std::string_view word) {
  const bool negative = word.starts_with('m');
  if (negative) word.remove_prefix(1);
  int value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  if (value < 0 || value > kMaxFamilyParameter) return std::nullopt;
  return negative ? -value : value;
}

/// `robot`, `4`, `2`, `8`.
std::vector<std::string_view> words_of(std::string_view name) {
  std::vector<std::string_view> words;
  while (true) {
    const auto end = name.find('_');
    words.push_back(name.substr(0, end));
    if (end == std::string_view::npos) return words;
    name.remove_prefix(end + 1);
  }
}

}  // namespace

std::optional<std::string> family_model(std::string_view name) {
  const auto words = words_of(name);
  for (const auto& family : families()) {
    if (family.name != words.front() || family.parameters + 1 != words.size()) continue;
    Parameters parameters;
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto value = parameter(words[i]);
      const bool any_sign = i + family.may_be_negative >= words.size();
      if (!value || (!any_sign && *value < 1)) return std::nullopt;
      parameters.push_back(*value);
    }
    return family.text(parameters);
  }
  return std::nullopt;
}

}  // namespace parallax::tools
