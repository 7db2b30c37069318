#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

#include "harness/config/suite_manifest.h"
#include "tools/suite/footprint.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {

/// Compares the traces of a case's models with the expectations of its manifest.
void run_traces(const harness::ManifestCase& one, const std::filesystem::path& manifest,
                const RunnerOptions& options, Footprint& footprint, const std::atomic<bool>& stop,
                CaseResult& result);

/// The number that the last line of a list of traces begins with, "4 traces, complete ...".
std::optional<std::int64_t> listed_traces(std::string_view text);

}  // namespace parallax::tools
