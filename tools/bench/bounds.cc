#include "tools/bench/bounds.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "compiler/base/json.h"

namespace parallax::tools {
namespace {

using Costs = std::map<std::string, double>;

/// Reads `{"name": cost, ...}`; costs are positive and finite.
bool read_costs(const nlohmann::json& document, const char* key, Costs& out, std::string& error) {
  if (!document.contains(key) || !document[key].is_object()) {
    error = fmt::format("`{}` is missing or no object", key);
    return false;
  }
  for (const auto& [name, value] : document[key].items()) {
    const bool usable =
        value.is_number() && value.get<double>() > 0 && std::isfinite(value.get<double>());
    if (!usable) {
      error = fmt::format("`{}`: `{}` has no positive cost", key, name);
      return false;
    }
    out[name] = value.get<double>();
  }
  return true;
}

nlohmann::ordered_json rounded(const Costs& costs) {
  auto out = nlohmann::ordered_json::object();
  for (const auto& [name, cost] : costs) out[name] = std::stod(fmt::format("{:.3g}", cost));
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
  if (!read_costs(document, "questions", bounds.questions, error) ||
      !read_costs(document, "builds", bounds.builds, error)) {
    return std::nullopt;
  }
  return bounds;
}

std::string to_json(const Bounds& bounds) {
  const nlohmann::ordered_json document = {{"questions", rounded(bounds.questions)},
                                           {"builds", rounded(bounds.builds)}};
  return base::json_text(document, 2) + '\n';
}

BoundVerdict judge_question(double cost, std::optional<double> recorded) {
  if (!recorded) return BoundVerdict::kUnknown;
  if (cost >= kSlowQuestion * *recorded) return BoundVerdict::kExceeded;
  return cost * kSlowQuestion <= *recorded ? BoundVerdict::kFaster : BoundVerdict::kWithin;
}

BoundVerdict judge_build(double cost, std::optional<double> recorded) {
  if (!recorded) return BoundVerdict::kUnknown;
  if (cost > kTooLongBuild * *recorded) return BoundVerdict::kExceeded;
  if (cost > kLongBuild * *recorded) return BoundVerdict::kLonger;
  return cost * kLongBuild < *recorded ? BoundVerdict::kFaster : BoundVerdict::kWithin;
}

std::string verdict_line(const std::string& name, double cost, std::optional<double> recorded,
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
  const auto shown = [](double value) {
    return value < 100 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
  };
  const auto before = recorded ? shown(*recorded) : std::string("-");
  const auto change = recorded ? fmt::format("{:.2f} x", cost / *recorded) : std::string("");
  return fmt::format("  {:<36}{:>9} {:>9} {:>8}  {}\n", name, shown(cost), before, change, words);
}

std::optional<double> recorded_cost(const Costs& costs, const std::string& name) {
  const auto found = costs.find(name);
  if (found == costs.end()) return std::nullopt;
  return found->second;
}

}  // namespace parallax::tools
