#include "tools/cli/suite_output.h"

#include <unistd.h>

#include <filesystem>
#include <set>

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "tools/suite/suite_summary.h"

namespace parallax::tools {
namespace {

/// Does the file look like a JUnit report?
bool is_junit(std::string_view text) {
  constexpr std::size_t kHead = 4096;
  return text.starts_with("<") &&
         text.substr(0, kHead).find("<testsuite") != std::string_view::npos;
}

/// May `file` be replaced: is it new, empty, or something that `is_ours`?
bool may_replace(const std::string& file, const std::string& option,
                 bool (*is_ours)(std::string_view), Invocation& invocation) {
  if (file.empty()) return true;
  auto& sink = invocation.sink();
  if (!base::check_output(file, invocation.files(), sink)) return false;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return true;
  const auto text = base::read_file(file, sink);
  if (!text) return false;
  if (text->empty() || is_ours(*text)) return true;
  sink.error_about(
      codes::kUsage, file,
      fmt::format("this file is there already and is no report that {} could replace", option));
  return false;
}

bool is_markdown(std::string_view text) { return text.starts_with(kMarkdownMark); }

}  // namespace

bool may_write(const SuiteOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto results = std::filesystem::path(options.out) / kResultsFile;
  if (!base::check_output(results, invocation.files(), sink)) return false;
  std::error_code error;
  base::DiagnosticSink unread;
  if (std::filesystem::exists(results, error) && !std::filesystem::is_empty(results, error) &&
      !read_results(options.out, unread)) {
    sink.error_about(codes::kUsage, results.string(),
                     "this file is there already and holds no results that --out could replace");
    return false;
  }
  return may_replace(options.junit, "--junit", is_junit, invocation) &&
         may_replace(options.markdown, "--markdown", is_markdown, invocation);
}

int conclude(SuiteRecord& record, const SuiteOptions& options, Invocation& invocation) {
  auto& sink = invocation.sink();
  bool saved = record.save(sink).has_value();
  if (!options.markdown.empty()) {
    saved = base::write_output(options.markdown, summary_markdown(record), invocation.files(), sink)
                .has_value() &&
            saved;
  }
  if (options.annotations == "github") write_error(github_annotations(record), {.commands = true});
  if (invocation.options().json) {
    invocation.document(summary_document(record));
  } else {
    invocation.result(summary_text(record));
  }
  // Cases that are gone have been told, also those that the list of quarantine knows.
  if (record.count(Outcome::kRemoved) + record.quarantined() > 0) {
    record.forget_removed();
    saved = record.save(sink).has_value() && saved;
  }
  if (record.count(Outcome::kFailed) + record.count(Outcome::kError) > 0) return 1;
  const auto open = record.count(Outcome::kNotFinished) + record.count(Outcome::kInconclusive) +
                    record.count(Outcome::kRemoved);
  return saved && open > 0 ? 4 : 0;
}

SuiteVoice suite_voice(Invocation& invocation) {
  SuiteVoice out;
  out.remark = [&](const std::string& text) { invocation.remark(text); };
  out.finished = [&](const SuiteCase& one, const CaseResult& result) {
    const bool is_remark = result.outcome == Outcome::kPassed && !result.flaky();
    if (!is_remark && !invocation.options().json) {
      invocation.result(line_of(one, result, invocation.color_on(STDOUT_FILENO)) + '\n');
    } else if (!invocation.options().quiet) {
      const bool color = invocation.color_on(STDERR_FILENO);
      write_error(line_of(one, result, color) + '\n', {.colors = color});
    }
  };
  return out;
}

void tell_removed(const SuiteRecord& record, const SuiteVoice& voice) {
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    const auto& one = record.cases()[i];
    if (one.is_removed) voice.finished(one, record.results()[i]);
  }
}

base::Result<harness::Quarantine> quarantine_of(const SuiteOptions& options,
                                                Invocation& invocation) {
  if (options.quarantine.empty()) return harness::Quarantine{};
  return harness::load_quarantine(options.quarantine, invocation.files(), invocation.sink());
}

void speak_of_quarantine(const SuiteRecord& record, bool whole, const Invocation& invocation) {
  std::set<std::string> known;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    const auto name = record.cases()[i].name();
    known.insert(name);
    if (!record.quarantine().contains(name)) continue;
    const auto& result = record.results()[i];
    if (result.outcome == Outcome::kPassed && !result.flaky()) {
      invocation.remark(fmt::format("{} passes: take it from the quarantine list", name));
    }
  }
  if (!whole) return;
  for (const auto& [name, reason] : record.quarantine()) {
    if (!known.contains(name)) {
      invocation.remark(fmt::format("the quarantine list names {}, which is no case", name));
    }
  }
}

}  // namespace parallax::tools
