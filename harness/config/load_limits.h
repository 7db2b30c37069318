#pragma once

#include <atomic>
#include <filesystem>

#include "harness/config/scenario.h"

namespace parallax::harness {

struct ScenarioSettings;

/// Limits on reading a scenario, and what to tell besides.
struct LoadLimits {
  bool allow_outside = false;  // as in the load_scenario of scenario.h
  /// Ends the processes that read meshes and worlds of other formats when it is raised; what they
  /// were reading is then reported as not to be read.
  const std::atomic<bool>* stop = nullptr;
  /// Receives the values of the scenario, for comparison with another one; may be null.
  ScenarioSettings* settings = nullptr;
};

base::Result<Scenario> load_scenario(const std::filesystem::path& path, base::SourceFiles& files,
                                     base::DiagnosticSink& sink, const LoadLimits& limits);

}  // namespace parallax::harness
