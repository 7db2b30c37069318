#include "tools/cli/merge_shards.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <tuple>

#include "compiler/base/codes/files.h"
#include "compiler/base/folder_lock.h"
#include "compiler/base/write_gate.h"
#include "tools/cli/suite_history_option.h"
#include "tools/cli/suite_output.h"
#include "tools/suite/collected_cases.h"
#include "tools/suite/suite_loop.h"
#include "tools/suite/suite_merge.h"

namespace parallax::tools {
namespace {

/// Adds the cases that the last suite in --out, or in the history, had and the shards have not.
void add_removed(const SuiteOptions& options, MergedSuite& merged) {
  const auto& suite = merged.identity;
  base::DiagnosticSink unread;
  auto earlier = read_results(options.out, unread);
  auto last = last_names(earlier ? *std::move(earlier) : StoredResults{}, options.history,
                         [&](const SuiteSelection& other) {
                           return normal_paths(other.paths) == normal_paths(suite.paths) &&
                                  other.only == suite.only && other.fast == suite.fast;
                         });
  last.insert(merged.removed.begin(), merged.removed.end());
  std::set<std::string> names;
  for (const auto& one : merged.cases) names.insert(one.name());
  for (auto& one : removed_cases(names, last, suite.only, Shard{})) {
    const auto at = std::upper_bound(merged.cases.begin(), merged.cases.end(), one,
                                     [](const SuiteCase& a, const SuiteCase& b) {
                                       return std::tie(a.group, a.id) < std::tie(b.group, b.id);
                                     });
    merged.results.insert(merged.results.begin() + (at - merged.cases.begin()), CaseResult{});
    merged.cases.insert(at, std::move(one));
  }
}

}  // namespace

int merge_shards(const SuiteOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto quarantine = quarantine_of(options, invocation);
  if (!options.out_given && !base::check_unnamed_output(options.out, ".", "--out", sink)) return 0;
  const auto lock = base::FolderLock::claim(options.out, sink);
  if (!lock) return 0;
  auto merged = merge_suites(options.merge, sink);
  if (!quarantine || !merged || !may_write(options, invocation) ||
      !may_append(options, invocation)) {
    return 0;
  }
  for (const auto& folder : options.merge) {
    std::error_code error;
    if (!std::filesystem::equivalent(folder, options.out, error)) continue;
    sink.error_about(codes::kUsage, options.out,
                     "--out: the merged results would replace those of a shard");
    return 0;
  }
  const auto suite = merged->identity;
  add_removed(options, *merged);
  StoredResults stored{suite, {}};
  const std::vector<bool> none(merged->cases.size(), false);
  SuiteRecord record(std::move(merged->cases), none, options.out, options.junit, std::move(stored),
                     *quarantine);
  const auto voice = suite_voice(invocation);
  for (std::size_t i = 0; i < merged->results.size(); ++i) {
    if (record.cases()[i].is_removed) continue;
    const auto& result = merged->results[i];
    if (result.outcome != Outcome::kPassed) voice.finished(record.cases()[i], result);
    record.finish(i, std::move(merged->results[i]));
  }
  tell_removed(record, voice);
  for (const auto& folder : merged->lost) {
    invocation.remark(fmt::format("{} has no results that can be read",
                                  (std::filesystem::path(folder) / kResultsFile).string()));
  }
  for (const auto& shard : merged->missing) {
    invocation.remark(fmt::format("shard {0} is missing: run it with --shard {0} and merge again",
                                  to_string(shard)));
  }
  speak_of_quarantine(record, true, invocation);
  append_to_history(record, suite, options, invocation);
  return conclude(record, options, invocation);
}

}  // namespace parallax::tools
