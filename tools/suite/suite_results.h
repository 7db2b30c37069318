#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "compiler/base/diagnostic.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// The file in the suite's output folder that --rerun-failed reads.
inline constexpr const char* kResultsFile = "results.json";

/// Outcome by the name of the case, as text (`passed`, `failed`, ...).
using EarlierResults = std::map<std::string, std::string>;

/// Reads the results of an earlier suite; kNoEarlierResults if there are none or they are broken.
base::Result<EarlierResults> read_results(const std::filesystem::path& folder,
                                          base::DiagnosticSink& sink);

/// Writes `earlier` with the given results laid over it. Skipped cases are left out.
base::Status write_results(const std::filesystem::path& folder, EarlierResults earlier,
                           const std::vector<SuiteCase>& cases,
                           const std::vector<CaseResult>& results, base::DiagnosticSink& sink);

}  // namespace parallax::tools
