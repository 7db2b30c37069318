#pragma once

#include <atomic>
#include <filesystem>

#include "harness/config/suite_manifest.h"
#include "tools/suite/footprint.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {

/// Holds the traces of a case's models against what its manifest expects of them.
void run_traces(const harness::ManifestCase& one, const std::filesystem::path& manifest,
                const RunnerOptions& options, Footprint& footprint, const std::atomic<bool>& stop,
                CaseResult& result);

}  // namespace parallax::tools
