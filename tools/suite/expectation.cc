#include "tools/suite/expectation.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>
#include <set>

namespace parallax::tools {

std::vector<std::string> unmet(const harness::Expectation& expect, std::string_view run_document) {
  const auto run = nlohmann::json::parse(run_document, nullptr, false);
  if (run.is_discarded() || !run.is_object() || run.value("status", "") != "ok") {
    return {"the run gave no result"};
  }
  std::vector<std::string> out;
  const auto verdict = run.value("verdict", "");
  if (expect.verdict && verdict != *expect.verdict) {
    out.push_back(fmt::format("verdict {}, expected {}", verdict, *expect.verdict));
  }
  const auto iterations = run.value("iterations", std::int64_t{-1});
  if (expect.iterations && iterations != *expect.iterations) {
    out.push_back(fmt::format("{} iterations, expected {}", iterations, *expect.iterations));
  }
  const auto simulations = run.value("simulations", std::int64_t{-1});
  if (expect.max_simulations && simulations > *expect.max_simulations) {
    out.push_back(
        fmt::format("{} simulations, expected at most {}", simulations, *expect.max_simulations));
  }
  std::set<std::string> diverging;
  for (const auto& discrepancy : run.value("discrepancies", nlohmann::json::array())) {
    for (const auto& fluent : discrepancy.value("fluents", nlohmann::json::array())) {
      diverging.insert(fluent.value("fluent", ""));
    }
  }
  for (const auto& fluent : expect.fluents) {
    if (!diverging.contains(fluent)) out.push_back(fmt::format("{} did not diverge", fluent));
  }
  return out;
}

std::vector<std::string> unmet(const harness::RateExpectation& expect,
                               std::string_view rates_document) {
  const auto rates = nlohmann::json::parse(rates_document, nullptr, false);
  if (rates.is_discarded() || !rates.is_object() || rates.value("status", "") != "ok" ||
      rates.value("traces", nlohmann::json::array()).size() != 1) {
    return {"the runs gave no rate"};
  }
  const auto& any = rates["traces"][0]["any"];
  const double rate = any.value("rate", -1.0);
  const double lower = any.value("lower", 2.0), upper = any.value("upper", -1.0);
  if (lower <= expect.upper && upper >= expect.lower) return {};
  return {fmt::format(
      "discrepancies in {} of {} runs of trace {}, {:.1f} % [{:.1f}, {:.1f}], expected {:g} to "
      "{:g} %",
      any.value("count", std::int64_t{-1}), rates["traces"][0].value("runs", std::int64_t{-1}),
      expect.trace, 100 * rate, 100 * lower, 100 * upper, 100 * expect.lower, 100 * expect.upper)};
}

}  // namespace parallax::tools
