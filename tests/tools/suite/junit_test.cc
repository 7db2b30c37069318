#include <doctest/doctest.h>

#include <string>

#include "tests/tools/suite/case_result.h"
#include "tools/suite/suite_record.h"

namespace parallax::tools {
namespace {

SuiteCase manifest_case(const std::string& id) {
  return {"m/suite.yaml", id, "m/suite.yaml", harness::ManifestCase{}};
}

TEST_CASE("each outcome has its element, and the counts are of their kinds") {
  const std::vector<SuiteCase> cases = {manifest_case("a"), manifest_case("b"), manifest_case("c"),
                                        manifest_case("d"), manifest_case("e"), manifest_case("f"),
                                        manifest_case("g")};
  const std::vector<CaseResult> results = {
      result(Outcome::kPassed),
      result(Outcome::kFailed, "2 traces, expected 3 traces"),
      result(Outcome::kError, "the program was ended by signal 11"),
      result(Outcome::kNotFinished),
      result(Outcome::kSkipped),
      result(Outcome::kInconclusive, "no verdict"),
      result(Outcome::kRemoved, "it is gone")};
  const auto text = to_junit(cases, results, "2026-01-01T00:00:00Z");
  CHECK(holds(
      text, R"(<testsuites name="parallax suite" tests="7" failures="1" errors="3" skipped="2")"));
  CHECK(holds(text, R"(<failure message="2 traces, expected 3 traces" type="failed">)"));
  CHECK(holds(text, R"(<error message="the program was ended by signal 11" type="error">)"));
  CHECK(holds(text, R"(<error message="not finished" type="not finished"/>)"));
  CHECK(holds(text, R"(<skipped message="not in this shard"/>)"));
  CHECK(holds(text, R"(<skipped message="inconclusive: no verdict" type="inconclusive">)"));
  CHECK(holds(text, R"(<error message="removed: it is gone" type="removed">)"));
  CHECK(holds(text,
              R"(<testcase classname="m/suite.yaml" name="a" file="m/suite.yaml" time="0.000">)"));
}

TEST_CASE("names and messages that look like markup stay text") {
  auto one = manifest_case("a");
  one.file = one.group = "x\"><evil>.yaml";
  auto bad = result(Outcome::kFailed, "<b>\nsecond line");
  bad.messages = "</system-err>\x1b";
  const auto text = to_junit({one}, {bad}, "now");
  CHECK_FALSE(holds(text, "<evil>"));
  CHECK_FALSE(holds(text, "<b>"));
  CHECK(holds(text, R"(message="&lt;b&gt;")"));
  CHECK(holds(text, "<system-err>&lt;/system-err&gt;\\x1B</system-err>"));
}

TEST_CASE("a scenario is named by its file within its folder") {
  const SuiteCase scenario{"s/two/edge.yaml", "s/two/edge.yaml", "s/two", harness::Expectation{}};
  const auto text = to_junit({manifest_case("a"), scenario},
                             {result(Outcome::kPassed), result(Outcome::kPassed)}, "now");
  CHECK(holds(text, R"(<testsuite name="m/suite.yaml" tests="1")"));
  CHECK(holds(text, R"(<testsuite name="s/two" tests="1")"));
  CHECK(holds(text, R"(classname="s/two" name="edge.yaml" file="s/two/edge.yaml")"));
}

}  // namespace
}  // namespace parallax::tools
