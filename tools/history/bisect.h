#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"

namespace parallax::tools {

struct BisectOptions {
  std::string old_revision, new_revision;  // as git reads them
  std::string scenario;                    // where it lies, or lay, in the user's checkout
  std::string case_id;                     // of the case, if the file is a manifest of a suite
  std::vector<std::string> run_options;    // of `parallax run`, or of `parallax suite`
  bool allow_commands = false;             // start what the scenario names as its simulator
  bool allow_outside = false;
  bool first_parent = false;
};

/// Result of the scenario at one revision.
struct RevisionVerdict {
  std::string revision;  // its full hash
  std::string subject;
  /// "no-discrepancy" or "discrepancy", of a case "passed" or "failed"; empty: it says nothing of
  /// the change.
  std::string verdict;
  std::string words;            // the first discrepancy or problem; or why there is no verdict
  bool input_is_wrong = false;  // the scenario is missing, or was refused
};

struct BisectResult {
  RevisionVerdict old_end, new_end;
  /// The revisions between them that were tried, in order.
  std::vector<RevisionVerdict> tried;
  /// The revision that changed the verdict; several where only skipped ones are left between the
  /// two verdicts; none if the verdicts of the ends are equal, or one of them has none.
  std::vector<RevisionVerdict> changed_by;
  /// `parallax diff --stat` of the scenario before and at the one revision, or why there is none.
  std::string difference;
  bool stopped = false;

  bool ends_have_verdicts() const { return !old_end.verdict.empty() && !new_end.verdict.empty(); }
};

/// Finds the revision that changed the verdict of a scenario, or the outcome of a case, with `git
/// bisect`, in a temporary repository, which borrows the objects of the user's. The user's
/// repository, its checkout and its refs are only read, and none of its hooks, filters and settings
/// are used. Each revision is run in a process of its own. Reports unknown revisions as kUsage.
/// `tell` is called for each revision that was tried.
base::Result<BisectResult> bisect_verdict(const BisectOptions& options,
                                          const std::function<void(const RevisionVerdict&)>& tell,
                                          const std::atomic<bool>& stop,
                                          base::DiagnosticSink& sink);

}  // namespace parallax::tools
