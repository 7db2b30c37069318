#include "tools/suite/suite_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>

#include "compiler/base/contract.h"
#include "compiler/base/file_io.h"
#include "compiler/base/xml_text.h"

namespace parallax::tools {

namespace fs = std::filesystem;

using base::xml_escaped;

namespace {

struct CaseTally {
  std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
  double wall_s = 0.0;

  void add(const CaseResult& result, bool quarantined) {
    ++tests;
    wall_s += result.wall_s;
    if (quarantined) {
      ++skipped;
      return;
    }
    failures += result.outcome == Outcome::kFailed ? 1 : 0;
    const bool is_undecided =
        result.outcome == Outcome::kSkipped || result.outcome == Outcome::kInconclusive;
    skipped += is_undecided ? 1 : 0;
    const bool no_answer = result.outcome == Outcome::kError ||
                           result.outcome == Outcome::kNotFinished ||
                           result.outcome == Outcome::kRemoved;
    errors += no_answer ? 1 : 0;
  }
  std::string attributes() const {
    return fmt::format(R"(tests="{}" failures="{}" errors="{}" skipped="{}" time="{:.3f}")", tests,
                       failures, errors, skipped, wall_s);
  }
};

/// `<failure message="first sentence">all of them</failure>`, the message behind `lead`.
void append_problem(std::string& out, std::string_view element, const CaseResult& result,
                    std::string_view lead = "") {
  std::string all;
  for (const auto& problem : result.problems) all += problem + '\n';
  const auto headline = fmt::format("{}{}", lead, all.substr(0, all.find('\n')));
  out += fmt::format("      <{0} message=\"{1}\" type=\"{2}\">{3}</{0}>\n", element,
                     xml_escaped(headline), to_string(result.outcome), xml_escaped(all));
}

/// A failure in quarantine does not count, but its problems stay readable.
void append_quarantined(std::string& out, const std::string& reason, const CaseResult& result) {
  out += fmt::format("      <skipped message=\"quarantined: {}\">", xml_escaped(reason));
  for (const auto& problem : result.problems) out += xml_escaped(problem + '\n');
  out += "</skipped>\n";
}

void append_case(std::string& out, const SuiteCase& one, const CaseResult& result,
                 const harness::Quarantine& quarantine) {
  const auto slash = one.id == one.file ? one.id.rfind('/') : std::string::npos;
  const auto name = slash == std::string::npos ? one.id : one.id.substr(slash + 1);
  out +=
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" file=\"{}\" time=\"{:.3f}\">\n",
                  xml_escaped(one.group), xml_escaped(name), xml_escaped(one.file), result.wall_s);
  const bool quarantined = is_quarantined(one, result, quarantine);
  if (quarantined) append_quarantined(out, quarantine.at(one.name()), result);
  switch (quarantined ? Outcome::kPassed : result.outcome) {
    case Outcome::kPassed:
      break;
    case Outcome::kFailed:
      append_problem(out, "failure", result);
      break;
    case Outcome::kError:
      append_problem(out, "error", result);
      break;
    case Outcome::kRemoved:
      append_problem(out, "error", result, "removed: ");
      break;
    case Outcome::kInconclusive:
      append_problem(out, "skipped", result, "inconclusive: ");
      break;
    case Outcome::kNotFinished:
      if (result.problems.empty()) {
        out += "      <error message=\"not finished\" type=\"not finished\"/>\n";
      } else {
        append_problem(out, "error", result);
      }
      break;
    case Outcome::kSkipped:
      out += "      <skipped message=\"not in this shard\"/>\n";
      break;
  }
  if (result.flaky() || !result.reused.empty()) {
    const auto note = result.flaky() ? fmt::format("flaky: passed in attempt {}", result.attempts)
                                     : result.reused;
    out += fmt::format("      <system-out>{}</system-out>\n", xml_escaped(note));
  }
  if (!result.where.empty()) {
    out += fmt::format("      <system-out>looked {}</system-out>\n", xml_escaped(result.where));
  }
  if (!result.messages.empty()) {
    out += fmt::format("      <system-err>{}</system-err>\n", xml_escaped(result.messages));
  }
  out += "    </testcase>\n";
}

constexpr std::chrono::seconds kSaveInterval{1};

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  const auto length = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return {text.data(), length};
}

}  // namespace

std::string to_junit(const std::vector<SuiteCase>& cases, const std::vector<CaseResult>& results,
                     std::string_view timestamp, const harness::Quarantine& quarantine) {
  PARALLAX_REQUIRE(cases.size() == results.size(), "a result for every case");
  CaseTally total;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    total.add(results[i], is_quarantined(cases[i], results[i], quarantine));
  }
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out += fmt::format("<testsuites name=\"parallax suite\" {}>\n", total.attributes());
  for (std::size_t i = 0; i < cases.size();) {
    CaseTally tally;
    std::string body;
    const auto& group = cases[i].group;
    for (; i < cases.size() && cases[i].group == group; ++i) {
      tally.add(results[i], is_quarantined(cases[i], results[i], quarantine));
      append_case(body, cases[i], results[i], quarantine);
    }
    out += fmt::format("  <testsuite name=\"{}\" {} timestamp=\"{}\">\n{}  </testsuite>\n",
                       xml_escaped(group), tally.attributes(), xml_escaped(timestamp), body);
  }
  return out + "</testsuites>\n";
}

bool is_quarantined(const SuiteCase& one, const CaseResult& result,
                    const harness::Quarantine& quarantine) {
  const bool bad = result.outcome == Outcome::kFailed || result.outcome == Outcome::kError ||
                   result.outcome == Outcome::kInconclusive || result.outcome == Outcome::kRemoved;
  return bad && quarantine.contains(one.name());
}

SuiteRecord::SuiteRecord(std::vector<SuiteCase> cases, const std::vector<bool>& skipped,
                         std::filesystem::path folder, std::filesystem::path junit,
                         StoredResults stored, harness::Quarantine quarantine)
    : cases_(std::move(cases)),
      results_(cases_.size()),
      folder_(std::move(folder)),
      junit_(std::move(junit)),
      stored_(std::move(stored)),
      quarantine_(std::move(quarantine)),
      timestamp_(utc_now()) {
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    if (skipped[i]) results_[i].outcome = Outcome::kSkipped;
    if (!cases_[i].is_removed) continue;
    results_[i].outcome = Outcome::kRemoved;
    results_[i].problems = {"the last suite had this case, and it is gone"};
    stored_.cases.insert_or_assign(cases_[i].name(), StoredCase{cases_[i], results_[i]});
  }
}

void SuiteRecord::forget_removed() {
  for (const auto& one : cases_) {
    if (!one.is_removed) continue;
    stored_.cases.erase(one.name());
    stored_.known.erase(one.name());
    stored_.removed.insert(one.name());
  }
}

void SuiteRecord::finish(std::size_t index, CaseResult result) {
  const std::lock_guard lock(mutex_);
  results_[index] = std::move(result);
  if (std::chrono::steady_clock::now() - last_save_ < kSaveInterval) return;
  base::DiagnosticSink unread;  // the last save reports
  (void)save(unread);
}

base::Status SuiteRecord::save(base::DiagnosticSink& sink) {
  last_save_ = std::chrono::steady_clock::now();
  auto saved = write_results(folder_, stored_, cases_, results_, sink);
  if (!saved || junit_.empty()) return saved;
  return base::write_file_atomically(junit_, to_junit(cases_, results_, timestamp_, quarantine_),
                                     sink, base::TextForm::kMarkup);
}

std::size_t SuiteRecord::count(Outcome outcome) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    const bool counts = !is_quarantined(cases_[i], results_[i], quarantine_);
    count += counts && results_[i].outcome == outcome ? 1 : 0;
  }
  return count;
}

std::size_t SuiteRecord::quarantined() const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    count += is_quarantined(cases_[i], results_[i], quarantine_) ? 1 : 0;
  }
  return count;
}

}  // namespace parallax::tools
