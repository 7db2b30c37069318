#include "tools/suite/suite_summary.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/suite/case_result.h"

namespace parallax::tools {
namespace {

SuiteCase named(const std::string& id) {
  return {"m/suite.yaml", id, "m/suite.yaml", harness::ManifestCase{}};
}

/// A record in a folder that is never written.
SuiteRecord record_of(std::vector<SuiteCase> cases, harness::Quarantine quarantine = {}) {
  const std::vector<bool> none(cases.size(), false);
  return SuiteRecord(std::move(cases), none, "/nonexistent/suite", "", {}, std::move(quarantine));
}

void fill(SuiteRecord& record, const std::vector<CaseResult>& results) {
  for (std::size_t i = 0; i < results.size(); ++i) record.finish(i, results[i]);
}

TEST_CASE("a known failure counts neither as passed nor as failed, and stays to be read") {
  auto flaky = result(Outcome::kPassed);
  flaky.attempts = 2;
  const std::vector<CaseResult> results = {result(Outcome::kFailed, "2 traces"),
                                           result(Outcome::kFailed, "3 traces"), flaky,
                                           result(Outcome::kPassed)};
  auto record = record_of({named("a"), named("b"), named("c"), named("d")},
                          {{"m/suite.yaml:a", "the door jams"}, {"m/suite.yaml:d", "over"}});
  fill(record, results);
  CHECK(summary_text(record) == "2 passed, 1 failed, 1 quarantined, 1 flaky\n");
  const auto document = nlohmann::json::parse(summary_document(record));
  CHECK(document["failed"] == 1);
  CHECK(document["quarantined"] == 1);
  CHECK(document["cases"][0]["quarantined"] == "the door jams");
  CHECK_FALSE(document["cases"][3].contains("quarantined"));  // it passes
  const auto junit = to_junit(record.cases(), record.results(), "now", record.quarantine());
  CHECK(holds(junit, R"(tests="4" failures="1" errors="0" skipped="1")"));
  CHECK(holds(junit, R"(<skipped message="quarantined: the door jams">2 traces)"));
}

TEST_CASE("a summary in Markdown holds no markup but its own") {
  const std::string hostile = "x|y](http://h) <script>`@all`\n# no";
  auto one = named("a");
  one.file = one.group = hostile;
  const std::vector<CaseResult> results = {result(Outcome::kFailed, hostile)};
  auto record = record_of({one});
  fill(record, results);
  const auto text = summary_markdown(record);
  CHECK(text.starts_with(kMarkdownMark));
  CHECK_FALSE(holds(text, "<script>"));
  CHECK_FALSE(holds(text, "@all"));
  CHECK_FALSE(holds(text, "\n# no"));
  CHECK_FALSE(holds(text, "](http"));
  // A mark, a heading, an empty line, two lines of a head, one row.
  CHECK(std::count(text.begin(), text.end(), '\n') == 6);
}

TEST_CASE("an annotation is one command, whatever the names") {
  auto one = named("a::b,c");
  one.file = "dir,with:colon%/s.yaml";
  one.line = 7;
  const std::vector<CaseResult> results = {result(Outcome::kError, "50 % lost\nmore"),
                                           result(Outcome::kPassed), result(Outcome::kNotFinished)};
  auto record = record_of({one, named("b"), named("c")});
  fill(record, results);
  const auto text = github_annotations(record);
  CHECK(text ==
        "::error file=dir%2Cwith%3Acolon%25/s.yaml,line=7,title=error%3A a%3A%3Ab%2Cc::50 %25 "
        "lost\n"
        "::warning file=m/suite.yaml,line=1,title=not finished%3A c::the suite ended first\n");
}

}  // namespace
}  // namespace parallax::tools
