#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

#include "tools/suite/suite_case.h"

namespace parallax::tools {

struct RunnerOptions {
  std::filesystem::path out;  // run folders of scenarios are made below it
  std::uint64_t seed = 1;
  bool update_goldens = false;
};

/// Runs one case in processes of its own, so that neither a crash nor a limit ends the suite, and
/// holds the answer against the expectation. A case that `stop` has cut off is kNotFinished.
/// With `update_goldens` a golden that differs or is missing is written, provided that everything
/// else is as expected.
CaseResult run_case(const SuiteCase& one, const RunnerOptions& options,
                    const std::atomic<bool>& stop);

}  // namespace parallax::tools
