#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace parallax::test {

/// Shares of coverage that a run's report must state, counted from the document of `coverage
/// --json`.
inline nlohmann::json shares_of(const nlohmann::json& coverage) {
  nlohmann::json out;
  for (const std::string group :
       {"performs", "branches", "handlers", "retries", "events", "axioms"}) {
    int covered = 0, all = 0;
    for (const auto& item : coverage.at(group)) {
      ++all;
      if (item.at("hits").get<int>() > 0) ++covered;
    }
    if (all > 0) out[group] = {{"covered", covered}, {"all", all}};
  }
  return out;
}

}  // namespace parallax::test
