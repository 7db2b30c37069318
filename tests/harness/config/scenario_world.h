#pragma once

#include <doctest/doctest.h>

#include <string>
#include <utility>

#include "harness/config/scenario.h"

namespace parallax::harness {

/// A scenario below `scenarios`.
inline Scenario scenario_of(const std::string& scenario_file) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  auto scenario = load_scenario(PARALLAX_SOURCE_DIR "/scenarios/" + scenario_file, files, sink);
  std::string reports;
  for (const auto& d : sink.sorted()) reports += d.message + "\n";
  CAPTURE(reports);
  REQUIRE(scenario.has_value());
  return *std::move(scenario);
}

inline WorldSpec world_of(const std::string& scenario_file) {
  return scenario_of(scenario_file).world;
}

}  // namespace parallax::harness
