// Which cases a suite has: their list, those that are gone, and how they are told.

#include <doctest/doctest.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/xml.h"
#include "tests/tools/cli_json.h"
#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// Takes the case `lit` out of the manifest.
void take_out(const SuiteFixture& cli) {
  const auto text = cli.read("s/suite.yaml");
  cli.write("s/suite.yaml", text.substr(0, text.find("  - id: lit")));
}

TEST_CASE("--collect-only lists the selected cases, and runs and writes nothing") {
  const SuiteFixture cli;
  const auto all = cli.suite({"--collect-only"});
  CHECK(all.code == 0);
  CHECK(all.out == "s/suite.yaml:both\ns/suite.yaml:lit\n");
  CHECK(holds(all.err, "2 cases"));
  CHECK_FALSE(fs::exists(cli.folder() / "out"));
  CHECK(cli.suite({"--collect-only", "--only", "lit"}).out == "s/suite.yaml:lit\n");
  const auto one = cli.suite({"--collect-only", "--shard", "1/2"}).out;
  const auto two = cli.suite({"--collect-only", "--shard", "2/2"}).out;
  CHECK((one + two == all.out || two + one == all.out));
  CHECK(cli.suite({"--collect-only", "--only", "nothing"}).code == 2);

  const auto list = json_of(cli, {"suite", "s", "wrong_model.yaml", "--collect-only"});
  REQUIRE(list["cases"].size() == 3);
  CHECK(list["cases"][2] == Json({{"case", "s/suite.yaml:lit"},
                                  {"file", "s/suite.yaml"},
                                  {"kind", "traces"},
                                  {"line", 5}}));
  CHECK(list["cases"][0]["kind"] == "scenario");
  const auto text = cli.read("wrong_model.yaml");
  const auto before = text.substr(0, text.find("expect:"));
  const auto line = 1 + std::count(before.begin(), before.end(), '\n');
  // The line of what is expected, or of its key.
  CHECK(std::abs(list["cases"][0]["line"].get<long>() - line) <= 1);
  CHECK_FALSE(fs::exists(cli.folder() / "out"));
}

TEST_CASE("a case that is gone is told and counted, once") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  take_out(cli);
  const auto listed = json_of(cli, {"suite", "s", "--collect-only"});
  CHECK(listed["removed"] == Json::array({"s/suite.yaml:lit"}));
  const auto found =
      cli.suite({"--junit", "r.xml", "--markdown", "r.md", "--annotations", "github"});
  CHECK(found.code == 4);
  CHECK(holds(found.out, "GONE  s/suite.yaml:lit\n       the last suite had this case"));
  CHECK(found.out.ends_with("\n1 passed, 0 failed, 1 removed\n"));
  CHECK(holds(cli.read("r.md"), "s/suite\\.yaml\\:lit | removed |"));
  CHECK(holds(found.err, "::warning file=s/suite.yaml,line=1,title=removed%3A lit::"));
  const auto junit = parse_xml(cli.read("r.xml"));
  REQUIRE(junit.all("error").size() == 1);
  CHECK(junit.all("error")[0]->at("type") == "removed");
  CHECK(cli.suite({}).code == 0);
}

TEST_CASE("a suite that looks at fewer cases hides none that is gone") {
  for (const std::string narrow : {"--only", "--fast"}) {
    const SuiteFixture cli;
    REQUIRE(cli.suite({"--update-goldens"}).code == 0);
    take_out(cli);
    const auto options = narrow == "--only" ? std::vector<std::string>{narrow, "both"}
                                            : std::vector<std::string>{narrow};
    const auto looked = cli.suite(options);
    // A case that the narrow suite looks at is told by itself.
    CHECK(looked.code == (narrow == "--only" ? 0 : 4));
    const auto whole = cli.suite({});
    CHECK(whole.code == (narrow == "--only" ? 4 : 0));
    CHECK(holds(whole.out, "GONE  s/suite.yaml:lit") == (narrow == "--only"));
    CHECK(cli.suite({}).code == 0);
  }
}

TEST_CASE("a suite that is killed before it tells what is gone hides nothing") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  // The scenario takes seconds, so that the suite is killed while it runs.
  const auto suite = [&](std::vector<std::string> more, ProcessOptions options = {}) {
    more.insert(more.begin(), {"suite", "s", "scenario.yaml"});
    return cli.parallax(std::move(more), std::move(options));
  };
  REQUIRE(suite({}).code == 0);
  take_out(cli);
  ProcessOptions options;
  options.signal_when = [&] {
    return holds(cli.read("out/suite/results.json"), "not finished") ? SIGKILL : 0;
  };
  REQUIRE(suite({"--no-cache"}, options).code == 128 + SIGKILL);
  CHECK(holds(suite({}).out, "GONE  s/suite.yaml:lit"));
  CHECK_FALSE(holds(suite({}).out, "GONE"));
  CHECK_FALSE(holds(cli.read("out/suite/results.json"), "s/suite.yaml:lit"));
}

TEST_CASE("a case that failed and is gone is not run again, and is told") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({}).code == 1);  // there is no golden file of `both`
  const auto text = cli.read("s/suite.yaml");
  cli.write("s/suite.yaml", "cases:\n" + text.substr(text.find("  - id: lit")));
  const auto again = json_of(cli, {"suite", "s", "--rerun-failed"}, 4);
  CHECK(again["removed"] == 1);
  // Only its name is kept, for --merge.
  const auto results = Json::parse(cli.read("out/suite/results.json"));
  CHECK_FALSE(holds(results["cases"].dump(), "s/suite.yaml:both"));
  CHECK(results["removed"] == Json{"s/suite.yaml:both"});
}

TEST_CASE("other selections, other paths and the list of quarantine count no case as gone") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  take_out(cli);
  CHECK(cli.suite({"--only", "both", "--out", "elsewhere"}).code == 0);
  // Cases that are not selected are not looked at, even if they were selected before.
  CHECK(json_of(cli, {"suite", "s", "--only", "both", "--collect-only"})["removed"].empty());
  CHECK(cli.parallax({"suite", "s/suite.yaml", "--collect-only"}).err.find("gone") ==
        std::string::npos);
  cli.write("known.yaml",
            "quarantine: [{case: 's/suite.yaml:lit', because: it moves to another folder}]\n");
  const auto known = json_of(cli, {"suite", "s", "--quarantine", "known.yaml"});
  CHECK(known["removed"] == 0);
  CHECK(known["quarantined"] == 1);
}

TEST_CASE("a narrower suite in between hides no case that is gone") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens", "--history", "h.jsonl"}).code == 0);
  take_out(cli);
  CHECK(cli.suite({"--only", "both", "--history", "h.jsonl"}).code == 0);
  CHECK(cli.suite({"--history", "h.jsonl"}).code == 4);
}

TEST_CASE("the history remembers cases where the results do not") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens", "--history", "h.jsonl"}).code == 0);
  take_out(cli);
  fs::remove_all(cli.folder() / "out");
  const auto found = cli.suite({"--history", "h.jsonl"});
  CHECK(found.code == 4);
  CHECK(holds(found.out, "GONE  s/suite.yaml:lit"));
  fs::remove_all(cli.folder() / "out");
  CHECK(cli.suite({"--history", "h.jsonl"}).code == 0);
}

TEST_CASE("merged shards tell what the last merge had") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  const auto merge = [&](int code) {
    for (const auto* shard : {"1", "2"}) {
      fs::remove_all(cli.folder() / shard);
      (void)cli.suite({"--shard", std::string(shard) + "/2", "--out", shard});
    }
    return json_of(cli, {"suite", "--merge", "1", "2", "--out", "all", "--junit", "all.xml"}, code);
  };
  CHECK(merge(0)["removed"] == 0);
  take_out(cli);
  const auto found = merge(4);
  CHECK(found["removed"] == 1);
  CHECK(found["cases"].size() == 2);
  CHECK(parse_xml(cli.read("all.xml")).all("testcase").size() == 2);
  CHECK(merge(0)["removed"] == 0);
}

TEST_CASE("a golden file of no case stands in every report") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  fs::copy(cli.folder() / "s/expected/both.txt", cli.folder() / "s/expected/old.txt");
  const auto found = json_of(cli, {"suite", "s", "--markdown", "r.md"});
  CHECK(found["unused_goldens"] == Json::array({"s/expected/old.txt"}));
  CHECK(holds(cli.read("r.md"), "is a golden file of no case"));
  CHECK(json_of(cli, {"suite", "s", "--collect-only"})["unused_goldens"].size() == 1);
}

std::size_t longest_line(const std::string& text) {
  std::size_t out = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) out = std::max(out, line.size());
  return out;
}

TEST_CASE("what is wrong stands with its case on standard output, in 80 columns") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  cli.replace("s/suite.yaml", "{traces: 1}",
              "{holds: 'HoldsAt(On(),time) | !HoldsAt(On(),time) & HoldsAt(On(),time) | "
              "HoldsAt(On(),time)'}");
  const auto found = cli.suite({"--color=never"});
  CHECK(found.code == 1);
  CHECK(found.out.starts_with("FAIL  s/suite.yaml:lit ("));
  CHECK(holds(found.out, "\n       "));
  CHECK_MESSAGE(longest_line(found.out) <= 80, found.out);
  CHECK(holds(found.err, "ok    s/suite.yaml:both"));
  // --quiet drops passes alone.
  const auto quiet = cli.suite({"--quiet"});
  CHECK(quiet.err.empty());
  CHECK(quiet.out.starts_with("FAIL  s/suite.yaml:lit ("));
}

TEST_CASE("marks are coloured where that is asked for, and nothing else is") {
  const SuiteFixture cli;
  const std::string red = "\x1b[1;31mFAIL \x1b[0m s/suite.yaml:both";
  const std::string green = "\x1b[1;32mok   \x1b[0m s/suite.yaml:lit";
  const auto always = cli.suite({"--color=always", "--no-cache"});
  CHECK(always.out.starts_with(red));
  CHECK(holds(always.err, green));
  for (const auto* when : {"auto", "never"}) {  // no terminal is there
    const auto plain = cli.suite({std::string("--color=") + when, "--no-cache"});
    CHECK_FALSE(holds(plain.out + plain.err, "\x1b"));
  }
  // A file's name may hold the program's own colours.
  const std::string name = "s/\x1b[1;31mred.yaml";
  cli.write(name, "cases: [{id: a, model: lamp.e, expect: {traces: 3}}]\n");
  const auto hostile = cli.suite({"--color=always", "--only", "red", "--no-cache"});
  CHECK(hostile.out.starts_with("\x1b[1;31mFAIL \x1b[0m s/\\u001b[1;31mred.yaml:a"));
}

/// `env SETTING parallax ...` on a terminal of 80 columns (util-linux' `script`).
std::string on_terminal(const SuiteFixture& cli, const std::string& setting) {
  ProcessOptions options;
  options.folder = cli.folder().string();
  const auto command = setting + " " + CliFixture::program() + " suite s --no-cache --only both";
  return run_process({"/usr/bin/env", "script", "-qec", "env " + command, "/dev/null"}, options)
      .out;
}

TEST_CASE("a terminal gets colours unless NO_COLOR is set") {
  const SuiteFixture cli;
  if (run_process({"/usr/bin/env", "script", "--version"}).code != 0) {
    MESSAGE("SKIPPED: there is no `script`");
    return;
  }
  CHECK(holds(on_terminal(cli, "-u NO_COLOR"), "\x1b[1;31mFAIL \x1b[0m"));
  const auto plain = on_terminal(cli, "NO_COLOR=1");
  CHECK(holds(plain, "FAIL  s/suite.yaml:both"));
  CHECK_FALSE(holds(plain, "\x1b["));
}

}  // namespace
}  // namespace parallax::test
