#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// The report of a suite: a testsuite for each group, a testcase for each case. A case that has not
/// finished is an error, so that a crash of the suite is never a case less. `cases` and `results`
/// run parallel; cases of one group must stand together. `timestamp` is ISO 8601.
std::string to_junit(const std::vector<SuiteCase>& cases, const std::vector<CaseResult>& results,
                     std::string_view timestamp);

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

/// The results of a running suite, kept on disk while it runs: every case stands there as not
/// finished from the beginning, and the files are written anew at most once a second. Thread-safe.
class SuiteRecord {
 public:
  /// `junit` may be empty: then no such report is written. `earlier` is kept beside the new
  /// results. Cases of `skipped` (parallel to `cases`) are marked so. Call `save` before the first
  /// case.
  SuiteRecord(std::vector<SuiteCase> cases, const std::vector<bool>& skipped,
              std::filesystem::path folder, std::filesystem::path junit, EarlierResults earlier);

  const std::vector<SuiteCase>& cases() const { return cases_; }
  const std::vector<CaseResult>& results() const { return results_; }
  void finish(std::size_t index, CaseResult result);
  /// Writes the files; reports kFileNotWritable.
  base::Status save(base::DiagnosticSink& sink);
  std::size_t count(Outcome outcome) const;

 private:
  std::vector<SuiteCase> cases_;
  std::vector<CaseResult> results_;
  std::filesystem::path folder_, junit_;
  EarlierResults earlier_;
  std::string timestamp_;  // of the beginning, ISO 8601
  std::chrono::steady_clock::time_point last_save_;
  std::mutex mutex_;
};

}  // namespace parallax::tools
