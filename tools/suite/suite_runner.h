#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/suite/suite_case.h"
#include "tools/suite/suite_ledger.h"

namespace parallax::tools {

class LastPasses;

struct RunnerOptions {
  std::filesystem::path out;  // run folders of scenarios are made below it
  std::uint64_t seed = 1;
  std::int64_t retries = 0;  // more attempts where one did not pass
  bool update_goldens = false;
  bool confirms = false;                    // discrepancies of cases that fail are repeated
  bool allow_commands = false;              // start what scenarios name as their simulators
  bool allow_outside = false;               // files may name any other
  const SuiteLedger* ledger = nullptr;      // of known discrepancies; null: none is asked
  const LastPasses* last_passes = nullptr;  // compared with failures; null: nothing
  /// For cases that are expected to fail: does only what shows whether they do. Traces beyond the
  /// expected number are not looked for, and the limit of a model's case is processor time.
  bool ends_early = false;
  std::vector<std::string> elsewhere = {};  // options of commands that simulate: where workers are
  std::optional<double> time_limit_s = {};  // of the processes of a scenario without one of its own
  /// Names of run folders that several cases would have (shared_run_folders). These get a hash of
  /// the case's file at the end.
  std::set<std::string> shared_folders = {};
};

/// Names of the run folders that more than one scenario would have: those of `x/y_z.yaml` and
/// `x_y/z.yaml`.
std::set<std::string> shared_run_folders(const std::vector<SuiteCase>& cases);

/// Runs one case in processes of its own, again where it did not pass and `retries` allow it, so
/// that neither a crash nor a limit ends the suite, and compares the answer with the expectation. A
/// case that `stop` has cut off is kNotFinished. With `update_goldens` a golden that differs or is
/// missing is written, provided that everything else is as expected, and only below the folder of
/// its manifest.
CaseResult run_case(const SuiteCase& one, const RunnerOptions& options,
                    const std::atomic<bool>& stop);

/// The difference of `actual` from `expected`, by lines: expected ones with `-`, found ones with
/// `+`, two common lines before and after, line numbers of `expected` at each stretch; the rest is
/// counted when it is long. Empty if the texts are the same. Compared as `base::line_changes` does.
std::string text_difference(std::string_view expected, std::string_view actual);

}  // namespace parallax::tools
