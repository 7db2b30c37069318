#include "tools/cli/suite_history_option.h"

#include <filesystem>
#include <set>

#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "tools/history/change_points.h"
#include "tools/history/git.h"
#include "tools/suite/suite_history.h"

namespace parallax::tools {
namespace {

/// All inputs of the cases.
std::set<std::string> files_of(const SuiteRecord& record) {
  std::set<std::string> out;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    if (record.cases()[i].is_removed) continue;
    out.insert(record.cases()[i].file);
    for (const auto& input : record.results()[i].inputs) out.insert(input.path);
  }
  return out;
}

}  // namespace

std::string unfit_for_history(const SuiteOptions& options) {
  if (options.history.empty()) return {};
  if (options.rerun_failed) return "--history is of whole suites, without --rerun-failed";
  if (options.merge.empty() && options.shard != "1/1") {
    return "--history is of whole suites: merge the shards, and append with --merge";
  }
  return {};
}

void append_to_history(const SuiteRecord& record, const SuiteIdentity& suite,
                       const SuiteOptions& options, Invocation& invocation) {
  if (options.history.empty()) return;
  if (record.count(Outcome::kNotFinished) > 0) {
    return invocation.remark("the suite was ended, so nothing is appended to " + options.history);
  }
  auto& sink = invocation.sink();
  std::error_code error;
  auto revision = options.revision;
  if (revision.empty() && !suite.paths.empty()) {
    revision = revision_of(suite.paths.front(), files_of(record)).value_or("");
  }
  if (!append_history(options.history, history_line(record, suite, revision), sink)) return;
  const auto history = read_history(options.history, sink);
  if (!history || history->lines.empty()) return;
  for (const auto& remark : remarks_on(*history, options.history)) invocation.remark(remark);
  for (const auto& lines : suites_of(*history)) {
    if (!history->lines[lines.front()].is_same_suite(history->lines.back())) continue;
    const auto changes = find_changes(*history, lines, kHistoryConfidence);
    for (const auto& point : changes.points) {
      if (point.line + 1 != lines.size()) continue;
      invocation.remark(base::printable(change_text(point, *history, lines)));
    }
    for (const auto& slower : slower_cases(*history, lines)) {
      invocation.remark(base::printable(slower));
    }
  }
}

bool may_append(const SuiteOptions& options, Invocation& invocation) {
  if (options.history.empty()) return true;
  std::error_code error;
  const auto status = std::filesystem::symlink_status(options.history, error);
  if (std::filesystem::is_symlink(status)) {
    invocation.sink().error_about(codes::kFileNotWritable, options.history,
                                  "it is a link; name the file itself");
    return false;
  }
  if (!std::filesystem::exists(status)) return true;
  if (!base::check_output(options.history, invocation.files(), invocation.sink())) return false;
  return read_history(options.history, invocation.sink()).has_value();
}

}  // namespace parallax::tools
