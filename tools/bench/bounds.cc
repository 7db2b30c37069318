#include "tools/bench/bounds.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "compiler/base/json.h"

namespace parallax::tools {
namespace {

using Ratios = std::map<std::string, double>;

/// Reads `{"name": ratio, ...}`; ratios are positive and finite.
bool read_ratios(const nlohmann::json& document, const char* key, Ratios& out, std::string& error) {
  if (!document.contains(key) || !document[key].is_object()) {
    error = fmt::format("`{}` is missing or no object", key);
    return false;
  }
  for (const auto& [name, value] : document[key].items()) {
    const bool usable =
        value.is_number() && value.get<double>() > 0 && std::isfinite(value.get<double>());
    if (!usable) {
      error = fmt::format("`{}`: `{}` has no positive ratio", key, name);
      return false;
    }
    out[name] = value.get<double>();
  }
  return true;
}

nlohmann::ordered_json rounded(const Ratios& ratios) {
  auto out = nlohmann::ordered_json::object();
  for (const auto& [name, ratio] : ratios) out[name] = std::stod(fmt::format("{:.3g}", ratio));
  return out;
}

}  // namespace

std::optional<Bounds> parse_bounds(std::string_view text, std::string& error) {
  const auto document = nlohmann::json::parse(text, nullptr, false);
  if (!document.is_object()) {
    error = "no JSON object";
    return std::nullopt;
  }
  Bounds bounds;
  if (!read_ratios(document, "questions", bounds.questions, error) ||
      !read_ratios(document, "builds", bounds.builds, error)) {
    return std::nullopt;
  }
  return bounds;
}

std::string to_json(const Bounds& bounds) {
  const nlohmann::ordered_json document = {{"questions", rounded(bounds.questions)},
                                           {"builds", rounded(bounds.builds)}};
  return base::json_text(document, 2) + '\n';
}

BoundVerdict judge_question(double ratio, std::optional<double> recorded) {
  if (!recorded) return BoundVerdict::kUnknown;
  if (ratio >= kSlowQuestion * *recorded) return BoundVerdict::kExceeded;
  return ratio * kSlowQuestion <= *recorded ? BoundVerdict::kFaster : BoundVerdict::kWithin;
}

BoundVerdict judge_build(double ratio, std::optional<double> recorded) {
  if (!recorded) return BoundVerdict::kUnknown;
  if (ratio > kTooLongBuild * *recorded) return BoundVerdict::kExceeded;
  if (ratio > kLongBuild * *recorded) return BoundVerdict::kLonger;
  return ratio * kLongBuild < *recorded ? BoundVerdict::kFaster : BoundVerdict::kWithin;
}

std::string verdict_line(const std::string& name, double ratio, std::optional<double> recorded,
                         BoundVerdict verdict) {
  const auto* words = "";
  switch (verdict) {
    case BoundVerdict::kWithin:
      words = "ok";
      break;
    case BoundVerdict::kFaster:
      words = "faster than recorded: record it (--record)";
      break;
    case BoundVerdict::kLonger:
      words = "LONGER THAN RECORDED";
      break;
    case BoundVerdict::kExceeded:
      words = "TOO SLOW";
      break;
    case BoundVerdict::kUnknown:
      words = "NOT RECORDED: record it (--record)";
      break;
  }
  const auto before = recorded ? fmt::format("{:.3g}", *recorded) : std::string("-");
  const auto change = recorded ? fmt::format("{:.2f} x", ratio / *recorded) : std::string("");
  return fmt::format("  {:<36}{:>9.3g} {:>9} {:>8}  {}\n", name, ratio, before, change, words);
}

std::optional<double> recorded_ratio(const Ratios& ratios, const std::string& name) {
  const auto found = ratios.find(name);
  if (found == ratios.end()) return std::nullopt;
  return found->second;
}

}  // namespace parallax::tools
