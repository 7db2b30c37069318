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

}  // namespace parallax::tools
