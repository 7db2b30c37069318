#pragma once

#include <chrono>
#include <filesystem>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/config/quarantine.h"
#include "tools/suite/suite_case.h"
#include "tools/suite/suite_results.h"

namespace parallax::tools {

/// The report of a suite: a testsuite for each group, a testcase for each case. A case that has not
/// finished is an error, so that a crash of the suite is never a case less. `cases` and `results`
/// run parallel; cases of one group must stand together. `timestamp` is ISO 8601. A case that
/// failed in `quarantine` is skipped, with its reason and its problems.
std::string to_junit(const std::vector<SuiteCase>& cases, const std::vector<CaseResult>& results,
                     std::string_view timestamp, const harness::Quarantine& quarantine = {});

/// Did the case fail although it may?
bool is_quarantined(const SuiteCase& one, const CaseResult& result,
                    const harness::Quarantine& quarantine);

/// The results of a running suite, kept on disk while it runs: every case is listed there as not
/// finished from the beginning, and the files are rewritten at most once a second. Thread-safe.
class SuiteRecord {
 public:
  /// `junit` may be empty: then no such report is written. The results are laid over `stored`,
  /// whose identity is theirs. Cases of `skipped` (parallel to `cases`) are marked so, and those
  /// that are removed as such: the file lists them until `forget_removed`, so that a suite that is
  /// killed before it tells them hides none. Call `save` before the first case.
  SuiteRecord(std::vector<SuiteCase> cases, const std::vector<bool>& skipped,
              std::filesystem::path folder, std::filesystem::path junit, StoredResults stored,
              harness::Quarantine quarantine = {});

  const std::vector<SuiteCase>& cases() const { return cases_; }
  const std::vector<CaseResult>& results() const { return results_; }
  void finish(std::size_t index, CaseResult result);
  /// Writes the files; reports kFileNotWritable.
  base::Status save(base::DiagnosticSink& sink);
  /// To be called when cases that are removed have been told: the next `save` lists them no more.
  void forget_removed();
  /// Cases of that outcome, but for those that failed and may.
  std::size_t count(Outcome outcome) const;
  std::size_t quarantined() const;
  const harness::Quarantine& quarantine() const { return quarantine_; }
  /// Golden files that no case names.
  const std::vector<std::string>& unused_goldens() const { return unused_goldens_; }
  void note_unused_goldens(std::vector<std::string> files) { unused_goldens_ = std::move(files); }

 private:
  std::vector<SuiteCase> cases_;
  std::vector<CaseResult> results_;
  std::filesystem::path folder_, junit_;
  StoredResults stored_;
  harness::Quarantine quarantine_;
  std::vector<std::string> unused_goldens_;
  std::string timestamp_;  // of the beginning, ISO 8601
  std::chrono::steady_clock::time_point last_save_;
  std::mutex mutex_;
};

}  // namespace parallax::tools
