#include "tools/cli/suite_history_option.h"

#include <filesystem>
#include <set>

#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "tools/cli/limits.h"
#include "tools/history/change_points.h"
#include "tools/history/git.h"
#include "tools/suite/since_last_pass.h"
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

/// The suite's last line; null: there is none.
const HistoryLine* last_line(const History& history, const HistoryLine& suite) {
  for (auto at = history.lines.rbegin(); at != history.lines.rend(); ++at) {
    if (at->is_same_suite(suite)) return &*at;
  }
  return nullptr;
}

/// Notes by value what changed in the files of cases since the suite's last line, as far as the
/// texts of then were kept.
void note_changes(const SuiteRecord& record, const std::string& file, const HistoryTexts& texts,
                  HistoryLine& line) {
  base::DiagnosticSink unread;
  const auto history = read_history(file, unread);
  const auto* last = history ? last_line(*history, line) : nullptr;
  if (last == nullptr) return;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    const auto& one = record.cases()[i];
    const auto now = line.cases.find(one.name());
    const auto then = last->cases.find(one.name());
    if (now == line.cases.end() || then == last->cases.end()) continue;
    if (now->second.files.empty() || now->second.files == then->second.files) continue;
    const auto before = texts.told->find(one);
    if (!before || before->files != then->second.files) continue;
    now->second.changes =
        changed_values(one, *before, record.results()[i], *texts.runner, stop_flag());
  }
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
                       const SuiteOptions& options, Invocation& invocation,
                       const HistoryTexts& texts) {
  if (options.history.empty()) return;
  if (record.count(Outcome::kNotFinished) > 0) {
    return invocation.remark("the suite was ended, so nothing is appended to " + options.history);
  }
  auto& sink = invocation.sink();
  std::error_code error;
  auto line = history_line(record, suite, options.revision);
  if (line.revision.empty() && !suite.paths.empty()) {
    line.revision = revision_of(suite.paths.front(), files_of(record)).value_or("");
    const auto words = commit_words_at(suite.paths.front()).value_or(CommitWords{});
    line.subject = words.subject;
    line.date = words.date;
  }
  if (texts.told != nullptr) note_changes(record, options.history, texts, line);
  if (!append_history(options.history, line, sink)) return;
  for (std::size_t i = 0; i < record.cases().size() && texts.told != nullptr; ++i) {
    if (!record.cases()[i].is_removed) {
      texts.told->keep_any(record.cases()[i], record.results()[i]);
    }
  }
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
