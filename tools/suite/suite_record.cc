#include "tools/suite/suite_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <system_error>

#include "compiler/base/contract.h"
#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "compiler/base/xml_text.h"

namespace parallax::tools {

namespace fs = std::filesystem;

using base::xml_escaped;

namespace {

struct Tally {
  std::size_t tests = 0, failures = 0, errors = 0, skipped = 0;
  double wall_s = 0.0;

  void add(const CaseResult& result) {
    ++tests;
    wall_s += result.wall_s;
    failures += result.outcome == Outcome::kFailed ? 1 : 0;
    skipped += result.outcome == Outcome::kSkipped ? 1 : 0;
    errors += result.outcome == Outcome::kError || result.outcome == Outcome::kNotFinished ? 1 : 0;
  }
  std::string attributes() const {
    return fmt::format(R"(tests="{}" failures="{}" errors="{}" skipped="{}" time="{:.3f}")", tests,
                       failures, errors, skipped, wall_s);
  }
};

/// `<failure message="first sentence">all of them</failure>`.
void append_problem(std::string& out, std::string_view element, const CaseResult& result) {
  std::string all;
  for (const auto& problem : result.problems) all += problem + '\n';
  const auto headline = all.substr(0, all.find('\n'));
  out += fmt::format("      <{0} message=\"{1}\" type=\"{2}\">{3}</{0}>\n", element,
                     xml_escaped(headline), to_string(result.outcome), xml_escaped(all));
}

void append_case(std::string& out, const SuiteCase& one, const CaseResult& result) {
  const auto slash = one.id == one.file ? one.id.rfind('/') : std::string::npos;
  const auto name = slash == std::string::npos ? one.id : one.id.substr(slash + 1);
  out +=
      fmt::format("    <testcase classname=\"{}\" name=\"{}\" file=\"{}\" time=\"{:.3f}\">\n",
                  xml_escaped(one.group), xml_escaped(name), xml_escaped(one.file), result.wall_s);
  switch (result.outcome) {
    case Outcome::kPassed:
      break;
    case Outcome::kFailed:
      append_problem(out, "failure", result);
      break;
    case Outcome::kError:
      append_problem(out, "error", result);
      break;
    case Outcome::kNotFinished:
      out += "      <error message=\"not finished\" type=\"not finished\"/>\n";
      break;
    case Outcome::kSkipped:
      out += "      <skipped message=\"not in this shard\"/>\n";
      break;
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
                     std::string_view timestamp) {
  PARALLAX_REQUIRE(cases.size() == results.size(), "a result for every case");
  Tally total;
  for (const auto& result : results) total.add(result);
  std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  out += fmt::format("<testsuites name=\"parallax suite\" {}>\n", total.attributes());
  for (std::size_t i = 0; i < cases.size();) {
    Tally tally;
    std::string body;
    const auto& group = cases[i].group;
    for (; i < cases.size() && cases[i].group == group; ++i) {
      tally.add(results[i]);
      append_case(body, cases[i], results[i]);
    }
    out += fmt::format("  <testsuite name=\"{}\" {} timestamp=\"{}\">\n{}  </testsuite>\n",
                       xml_escaped(group), tally.attributes(), xml_escaped(timestamp), body);
  }
  return out + "</testsuites>\n";
}

SuiteRecord::SuiteRecord(std::vector<SuiteCase> cases, const std::vector<bool>& skipped,
                         std::filesystem::path folder, std::filesystem::path junit,
                         EarlierResults earlier)
    : cases_(std::move(cases)),
      results_(cases_.size()),
      folder_(std::move(folder)),
      junit_(std::move(junit)),
      earlier_(std::move(earlier)),
      timestamp_(utc_now()) {
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    if (skipped[i]) results_[i].outcome = Outcome::kSkipped;
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
  auto saved = write_results(folder_, earlier_, cases_, results_, sink);
  if (!saved || junit_.empty()) return saved;
  return base::write_file_atomically(junit_, to_junit(cases_, results_, timestamp_), sink);
}

std::size_t SuiteRecord::count(Outcome outcome) const {
  std::size_t count = 0;
  for (const auto& result : results_) count += result.outcome == outcome ? 1 : 0;
  return count;
}

base::Result<EarlierResults> read_results(const fs::path& folder, base::DiagnosticSink& sink) {
  const auto path = folder / kResultsFile;
  base::DiagnosticSink unread;
  const auto text = base::read_file(path, unread);
  const auto json = text ? nlohmann::json::parse(*text, nullptr, false) : nlohmann::json();
  const bool usable = json.is_object() && json.contains("cases") && json["cases"].is_object();
  if (!usable) return sink.error_about(base::DiagnosticCode::kNoEarlierResults, path.string());
  EarlierResults results;
  for (const auto& [name, outcome] : json["cases"].items()) {
    results[name] = outcome.is_string() ? outcome.get<std::string>() : "";
  }
  return results;
}

base::Status write_results(const fs::path& folder, EarlierResults earlier,
                           const std::vector<SuiteCase>& cases,
                           const std::vector<CaseResult>& results, base::DiagnosticSink& sink) {
  for (std::size_t i = 0; i < cases.size(); ++i) {
    if (results[i].outcome == Outcome::kSkipped) continue;
    earlier[cases[i].name()] = to_string(results[i].outcome);
  }
  std::error_code error;
  fs::create_directories(folder, error);
  const nlohmann::json json = {{"schema_version", 1}, {"cases", earlier}};
  // Names are bytes of paths: what is no UTF-8 is replaced rather than refused.
  const auto text = base::json_text(json, 2) + '\n';
  return base::write_file_atomically(folder / kResultsFile, text, sink);
}

}  // namespace parallax::tools
