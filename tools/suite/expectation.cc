#include "tools/suite/expectation.h"

#include <fmt/format.h>

#include <cstdint>
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
  std::set<std::string> diverging, earlier;
  for (const auto& discrepancy : run.value("discrepancies", nlohmann::json::array())) {
    for (const auto& fluent : discrepancy.value("fluents", nlohmann::json::array())) {
      diverging.insert(fluent.value("fluent", ""));
    }
    for (const auto& fluent : discrepancy.value("first", nlohmann::json::array())) {
      earlier.insert(fluent.value("fluent", ""));
    }
  }
  if (run.value("compare", "") != "final") diverging.merge(earlier);
  for (const auto& fluent : expect.fluents) {
    if (diverging.contains(fluent)) continue;
    out.push_back(fmt::format("{} {}", fluent,
                              earlier.contains(fluent)
                                  ? "diverged on the way, but not in the end, which is what counts"
                                  : "did not diverge"));
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

std::string first_error(const std::string& document) {
  const auto json = nlohmann::json::parse(document, nullptr, false);
  if (!json.is_object()) return {};
  for (const auto& diagnostic : json.value("diagnostics", nlohmann::json::array())) {
    if (diagnostic.value("severity", "") != "error") continue;
    return fmt::format("{}: {}", diagnostic.value("code", ""), diagnostic.value("message", ""));
  }
  return {};
}

std::string first_discrepancy(const std::string& run_document) {
  const auto run = nlohmann::json::parse(run_document, nullptr, false);
  for (const auto& found : run.value("discrepancies", nlohmann::json::array())) {
    return fmt::format("{}.{}: {}", found.value("trace", std::int64_t{0}),
                       found.value("sample", std::int64_t{0}), found.value("words", ""));
  }
  return {};
}

bool has_failed(const std::string& document) {
  const auto json = nlohmann::json::parse(document, nullptr, false);
  return !json.is_object() || json.value("status", "") != "ok";
}

}  // namespace parallax::tools
