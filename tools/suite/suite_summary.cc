#include "tools/suite/suite_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "compiler/base/json.h"
#include "compiler/base/markdown.h"
#include "compiler/base/shown_text.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMaxRows = 200;

/// The state of a case, in a word.
std::string standing(const SuiteRecord& record, std::size_t i) {
  const auto& result = record.results()[i];
  if (is_quarantined(record.cases()[i], result, record.quarantine())) return "quarantined";
  if (result.flaky()) return "flaky";
  return std::string(to_string(result.outcome));
}

std::string first_line(const CaseResult& result) {
  if (result.problems.empty()) return {};
  const auto& problem = result.problems.front();
  return problem.substr(0, problem.find('\n'));
}

/// Why the case needs attention, in a line.
std::string reason(const SuiteRecord& record, std::size_t i) {
  const auto& one = record.cases()[i];
  const auto& result = record.results()[i];
  if (is_quarantined(one, result, record.quarantine())) {
    return fmt::format("{} ({})", record.quarantine().at(one.name()), first_line(result));
  }
  if (result.flaky()) return fmt::format("passed in attempt {}", result.attempts);
  auto text = first_line(result);
  return text.empty() && result.outcome == Outcome::kNotFinished ? "the suite ended first" : text;
}

bool wants_attention(const SuiteRecord& record, std::size_t i) {
  const auto& result = record.results()[i];
  return result.flaky() ||
         (result.outcome != Outcome::kPassed && result.outcome != Outcome::kSkipped);
}

/// As workflow commands want it: data, or the value of a property.
std::string github_text(std::string_view text, bool is_property) {
  std::string out;
  for (const char c : base::printable(text)) {
    if (c == '%' || (is_property && (c == ':' || c == ','))) {
      out += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    } else {
      out += c;
    }
  }
  return out;
}

std::size_t count_if(const SuiteRecord& record, bool (*holds)(const CaseResult&)) {
  std::size_t count = 0;
  for (const auto& result : record.results()) count += holds(result) ? 1 : 0;
  return count;
}

std::size_t flaky_cases(const SuiteRecord& record) {
  return count_if(record, [](const CaseResult& result) { return result.flaky(); });
}

std::size_t reused_cases(const SuiteRecord& record) {
  return count_if(record, [](const CaseResult& result) { return !result.reused.empty(); });
}

/// Cases that passed without every initial state being tried, a line each.
std::string narrow_passes(const SuiteRecord& record) {
  std::string out;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    const auto& result = record.results()[i];
    if (result.outcome != Outcome::kPassed || result.where.empty()) continue;
    if (result.verdict == "discrepancy") continue;  // which ended the run
    out += fmt::format("\n{} looked {} only.\n", base::markdown_text(record.cases()[i].name()),
                       result.where);
  }
  return out;
}

}  // namespace

std::string summary_text(const SuiteRecord& record) {
  auto text = fmt::format("{} passed, {} failed", record.count(Outcome::kPassed),
                          record.count(Outcome::kFailed));
  const auto append = [&](std::size_t count, std::string_view words) {
    if (count > 0) text += fmt::format(", {} {}", count, words);
  };
  append(record.count(Outcome::kError), "without an answer");
  append(record.count(Outcome::kInconclusive), "inconclusive");
  append(record.count(Outcome::kNotFinished), "not run");
  append(record.count(Outcome::kRemoved), "removed");
  append(record.count(Outcome::kSkipped), "in other shards");
  append(record.quarantined(), "quarantined");
  append(flaky_cases(record), "flaky");
  append(reused_cases(record), "not run again");
  return text + '\n';
}

std::string summary_document(const SuiteRecord& record) {
  auto list = nlohmann::json::array();
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    const auto& result = record.results()[i];
    list.push_back({{"case", record.cases()[i].name()},
                    {"outcome", to_string(result.outcome)},
                    {"problems", result.problems},
                    {"timing", {{"wall_s", result.wall_s}}}});
    auto& item = list.back();
    if (record.cases()[i].line > 0) item["line"] = record.cases()[i].line;
    if (!result.golden_written.empty()) item["golden_written"] = result.golden_written;
    if (!result.reused.empty()) item["reused"] = result.reused;
    if (result.attempts > 1) item["attempts"] = result.attempts;
    if (!result.shown.empty()) item["known"] = result.shown;
    if (!result.standing.empty()) item["standing"] = result.standing;
    if (!result.where.empty()) item["where"] = result.where;
    if (is_quarantined(record.cases()[i], result, record.quarantine())) {
      item["quarantined"] = record.quarantine().at(record.cases()[i].name());
    }
  }
  const nlohmann::json document = {{"status", "ok"},
                                   {"passed", record.count(Outcome::kPassed)},
                                   {"failed", record.count(Outcome::kFailed)},
                                   {"errors", record.count(Outcome::kError)},
                                   {"inconclusive", record.count(Outcome::kInconclusive)},
                                   {"not_run", record.count(Outcome::kNotFinished)},
                                   {"removed", record.count(Outcome::kRemoved)},
                                   {"skipped", record.count(Outcome::kSkipped)},
                                   {"quarantined", record.quarantined()},
                                   {"flaky", flaky_cases(record)},
                                   {"reused", reused_cases(record)},
                                   {"unused_goldens", record.unused_goldens()},
                                   {"cases", list}};
  return base::json_text(document) + '\n';
}

std::string summary_markdown(const SuiteRecord& record) {
  auto out = fmt::format("{}\n### Suite: {}\n", kMarkdownMark, summary_text(record));
  std::size_t rows = 0, hidden = 0;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    if (!wants_attention(record, i)) continue;
    if (rows == kMaxRows) {
      ++hidden;
      continue;
    }
    if (rows++ == 0) out += "| case | | what | s |\n|---|---|---|---:|\n";
    out += fmt::format("| {} | {} | {} | {:.1f} |\n", base::markdown_text(record.cases()[i].name()),
                       standing(record, i), base::markdown_text(reason(record, i)),
                       record.results()[i].wall_s);
  }
  if (hidden > 0) out += fmt::format("\n{} more cases are not listed.\n", hidden);
  for (const auto& file : record.unused_goldens()) {
    out += fmt::format("\n{} is a golden file of no case.\n", base::markdown_text(file));
  }
  return out + narrow_passes(record);
}

std::string github_annotations(const SuiteRecord& record) {
  std::string out;
  for (std::size_t i = 0; i < record.cases().size(); ++i) {
    if (!wants_attention(record, i)) continue;
    const auto& one = record.cases()[i];
    const auto how = standing(record, i);
    const bool is_error = how == "failed" || how == "error";
    out +=
        fmt::format("::{} file={},line={},title={}::{}\n", is_error ? "error" : "warning",
                    github_text(one.file, true), std::max(one.line, 1U),
                    github_text(how + ": " + one.id, true), github_text(reason(record, i), false));
  }
  return out;
}

}  // namespace parallax::tools
