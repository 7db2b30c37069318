// Suites that were ended, repeated or tampered with, as real processes.

#include <doctest/doctest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "compiler/base/folder_lock.h"
#include "compiler/base/sha256.h"
#include "tests/tools/cli_json.h"
#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

TEST_CASE("a resumed suite runs again what has changed since") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  // A golden file that was written meanwhile is one that has changed.
  CHECK(json_of(cli, {"suite", "s", "--resume", "--no-cache"})["reused"] == 1);
  CHECK(json_of(cli, {"suite", "s", "--resume", "--no-cache"})["reused"] == 2);
  cli.replace("s/lamp.e", "time 0 1", "time 0 2");
  const auto result = cli.suite({"--resume", "--no-cache"});
  CHECK(result.code == 1);
  CHECK(result.out.ends_with("\n0 passed, 2 failed\n"));
}

TEST_CASE("results of another suite are not gone on with") {
  const SuiteFixture cli;
  CHECK(cli.suite({"--resume"}).code == 2);
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& why) {
    const auto result = cli.suite(arguments);
    CHECK(result.code == 2);
    CHECK_MESSAGE(holds(result.err, why), result.err);
  };
  refused({"--resume", "--seed", "2"}, "seed 1 and 2");
  refused({"--resume", "--shard", "1/2"}, "1 shards and 2");
  refused({"--resume", "--only", "lit"}, "--only `` and `lit`");
  refused({"--resume", "--rerun-failed"}, "exclude each other");
  CHECK(cli.suite({"--resume"}).code == 0);
}

TEST_CASE("a folder of results belongs to one suite at a time") {
  const SuiteFixture cli;
  base::DiagnosticSink sink;
  const auto refused = [&](const std::vector<std::string>& arguments) {
    const auto result = cli.parallax(arguments);
    CHECK(result.code == 2);
    CHECK_MESSAGE(holds(result.err, "E7181"), result.err);
    CHECK_FALSE(holds(result.err, "--resume"));
  };
  {
    const auto held = base::FolderLock::claim(cli.folder() / "o", sink);
    REQUIRE(held.has_value());
    refused({"suite", "s", "--out", "o"});
    refused({"suite", "s", "--out", "o", "--resume"});
    refused({"suite", "s", "--out", "o", "--mutate"});
    refused({"suite", "--merge", "s", "--out", "o"});
    refused({"run", "wrong_model.yaml", "--out", "o", "--resume"});
    CHECK(fs::is_empty(cli.folder() / "o"));
  }
  CHECK(cli.suite({"--out", "o", "--update-goldens"}).code == 0);
}

TEST_CASE("a suite tells a compiled model that is older than its texts") {
  const SuiteFixture cli;
  REQUIRE(cli.parallax({"compile", "s/lamp.e", "-o", "s/lamp.dec.cnf"}).code == 0);
  cli.write("s/suite.yaml", "cases:\n  - {id: a, model: lamp.dec.cnf, expect: {traces: 2}}\n");
  CHECK_FALSE(holds(cli.suite({}).err, "W6080"));
  cli.write("s/lamp.e", std::string(kLamp) + "event Blink()\n");
  const auto result = cli.suite({});
  CHECK(result.code == 0);
  CHECK(holds(result.err, "W6080"));
  CHECK(holds(result.err, "the text `s/lamp.e` has changed"));
}

TEST_CASE("a golden file that no case names is told") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  CHECK_FALSE(holds(cli.suite({}).err, "is a golden file of no case"));
  fs::copy_file(cli.folder() / "s/expected/both.txt", cli.folder() / "s/expected/old.txt");
  fs::create_directory(cli.folder() / "s/deep");
  fs::copy_file(cli.folder() / "s/expected/both.txt", cli.folder() / "s/deep/other.txt");
  cli.write("s/notes.txt", "There are\n2 traces, I think\nof this.\n");
  const auto result = cli.suite({"--fast"});
  CHECK(result.code == 0);
  CHECK(holds(result.err, "s/expected/old.txt is a golden file of no case"));
  CHECK(holds(result.err, "s/deep/other.txt is a golden file of no case"));
  CHECK_FALSE(holds(result.err, "both.txt is"));
  CHECK_FALSE(holds(result.err, "notes.txt"));
}

TEST_CASE("what was refused for want of a permission is run again with it") {
  const SuiteFixture cli;
  cli.write("shared.e", kLamp);
  cli.write("s/lamp.e", "load ../shared.e\n");
  cli.write("s/other.e", kLamp);
  cli.write("s/suite.yaml",
            "cases:\n"
            "  - {id: refused, model: lamp.e, expect: {traces: 2}}\n"
            "  - {id: wrong, model: other.e, expect: {traces: 3}}\n");
  // Started in `s`, so that the shared file lies outside.
  const auto suite = [&](std::vector<std::string> more) {
    more.insert(more.begin(),
                {std::string(PARALLAX_BINARY_DIR) + "/parallax", "suite", "suite.yaml", "--json"});
    ProcessOptions options;
    options.folder = (cli.folder() / "s").string();
    return run_process(more, options);
  };
  const auto first = Json::parse(suite({}).out);
  CHECK(first["errors"] == 1);
  CHECK(first["failed"] == 1);
  CHECK(Json::parse(suite({"--resume"}).out)["reused"] == 2);
  // The wrong answer is one with any permission; the refusal is not.
  const auto permitted = Json::parse(suite({"--resume", "--allow-outside"}).out);
  CHECK(permitted["errors"] == 0);
  CHECK(permitted["passed"] == 1);
  CHECK(permitted["reused"] == 1);
  const auto withdrawn = suite({"--resume"});
  CHECK(withdrawn.code == 2);
  CHECK(holds(withdrawn.err, "one with --allow-outside and one without"));
}

TEST_CASE("a simulator that was not permitted is started when the suite goes on with permission") {
  const SuiteFixture cli;
  cli.write("s/case.yaml", "include: ../wrong_model.yaml\nsimulator: {command: [/bin/false]}\n");
  const std::vector<std::string> run = {"suite", "s/case.yaml", "--allow-outside"};
  const auto problem = [](const Json& document) {
    return document["cases"][0]["problems"][1].get<std::string>();
  };
  CHECK(holds(problem(json_of(cli, run, 1)), "E7114"));
  auto resumed = run;
  resumed.emplace_back("--resume");
  CHECK(json_of(cli, resumed, 1)["reused"] == 1);
  resumed.emplace_back("--allow-commands");
  CHECK(holds(problem(json_of(cli, resumed, 1)), "E7108: the simulator did not start"));
}

TEST_CASE("what passed is not run again until a file of it changes, and says so") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  CHECK(cli.suite({}).out == "2 passed, 0 failed\n");
  const auto cached = cli.suite({});
  CHECK(cached.out == "2 passed, 0 failed, 2 not run again\n");
  CHECK(holds(cached.err, "ok    s/suite.yaml:both (cached)"));
  CHECK(cli.suite({"--no-cache"}).out == "2 passed, 0 failed\n");
  CHECK(cli.suite({"--seed", "2"}).out == "2 passed, 0 failed\n");
  // The golden file belongs to one case, the model to both.
  cli.replace("s/expected/both.txt", "> Press()", "> Pull()");
  CHECK(cli.suite({}).out.ends_with("\n1 passed, 1 failed, 1 not run again\n"));
  cli.replace("s/expected/both.txt", "> Pull()", "> Press()");
  CHECK(cli.suite({}).out == "2 passed, 0 failed, 2 not run again\n");
  cli.replace("s/suite.yaml", "traces: 1}", "traces: 2}");
  CHECK(cli.suite({}).out.ends_with("\n1 passed, 1 failed, 1 not run again\n"));
  cli.replace("s/suite.yaml", "traces: 2}", "traces: 1}");
  cli.write("s/lamp.e", std::string(kLamp) + "; a remark\n");
  CHECK(cli.suite({}).out == "2 passed, 0 failed\n");
}

TEST_CASE("every file that a scenario reads is one whose change runs it again") {
  const SuiteFixture cli;
  const std::vector<std::string> run = {"suite", "wrong_model.yaml"};
  REQUIRE(cli.parallax(run).code == 0);
  const auto results = Json::parse(cli.read("out/suite/results.json"));
  const auto inputs = results["cases"]["wrong_model.yaml"]["inputs"];
  const auto loaded = json_of(cli, {"suite", "wrong_model.yaml"});
  CHECK(loaded["reused"] == 1);
  for (const auto* file : {"wrong_model.yaml", "common.yaml", "world.yaml", "wrong_domain.e",
                           "start.e", "hasty.lisp", "robot.bind"}) {
    CAPTURE(file);
    CHECK(inputs.contains(file));
    const auto text = cli.read(file);
    const bool is_yaml = fs::path(file).extension() == ".yaml";
    cli.write(file, text + (is_yaml ? "\n# a remark\n" : "\n; a remark\n"));
    CHECK(json_of(cli, run)["reused"] == 0);
    cli.write(file, text);
    CHECK(json_of(cli, run)["reused"] == 1);
  }
}

/// The entries of the cache in `out/suite`.
std::vector<fs::path> entries(const SuiteFixture& cli) {
  std::vector<fs::path> out;
  for (const auto& at : fs::recursive_directory_iterator(cli.folder() / "out/suite/cache")) {
    const bool is_pass = at.path().parent_path().parent_path().filename() == "passed";
    if (at.is_regular_file() && !is_pass) out.push_back(at.path());
  }
  return out;
}

TEST_CASE("a share of the cached passes is run all the same, and must answer the same bytes") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  REQUIRE(cli.suite({}).code == 0);
  CHECK(cli.suite({"--verify-cache", "50%"}).out == "2 passed, 0 failed, 1 not run again\n");
  CHECK(cli.suite({"--verify-cache", "100%"}).out == "2 passed, 0 failed\n");
  CHECK(cli.suite({"--verify-cache", "101%"}).code == 2);
  CHECK(cli.suite({"--verify-cache", "some"}).code == 2);
  // An answer that the program never gave, with the right hash.
  for (const auto& path : entries(cli)) {
    auto json = Json::parse(std::ifstream(path));
    json["entry"]["answer"] = std::string(64, '0');
    json["sha256"] = base::sha256_hex(json["entry"].dump());
    std::ofstream(path) << json.dump();
  }
  CHECK(cli.suite({}).out == "2 passed, 0 failed, 2 not run again\n");
  const auto caught = cli.suite({"--verify-cache", "50%"});
  CHECK(caught.code == 1);
  CHECK(caught.out.ends_with("\n1 passed, 0 failed, 1 without an answer, 1 not run again\n"));
  CHECK(holds(caught.out, "are not the same bytes"));
  // Each time the results that were checked longest ago are checked: the other one now.
  CHECK(cli.suite({"--verify-cache", "50%"}).code == 1);
  CHECK(cli.suite({"--verify-cache", "100%"}).code == 0);
}

TEST_CASE("a cache that cannot be kept is refused before anything runs") {
  const SuiteFixture cli;
  for (const auto* place : {"s/lamp.e", "s/lamp.e/cache", "/proc/cache"}) {
    const auto result = cli.suite({"--cache", place});
    CHECK(result.code == 2);
    CHECK_MESSAGE(holds(result.err, "--cache: this is no folder"), result.err);
  }
  cli.write("results.json", "{\"cases\": {\"s/suite.yaml:lit\": \"passed\"}}");
  const auto old = cli.suite({"--resume", "--out", "."});
  CHECK(old.code == 2);
  CHECK(holds(old.err, "one was made by an older version"));
}

TEST_CASE("a cache that was edited by hand is not believed") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  REQUIRE(cli.suite({}).code == 0);
  for (const auto& path : entries(cli)) {
    auto json = Json::parse(std::ifstream(path));
    json["entry"]["inputs"]["s/lamp.e"] = std::string(64, '0');
    std::ofstream(path) << json.dump();
  }
  const auto result = cli.suite({});
  CHECK(result.out == "2 passed, 0 failed\n");
  CHECK(holds(result.err, "2 cached results are not what was written; not used"));
}

TEST_CASE("a case in quarantine may fail, and its list must not outlive it") {
  const SuiteFixture cli;
  cli.write("known.yaml",
            "quarantine:\n"
            "  - {case: 's/suite.yaml:both', because: the golden file is on its way}\n"
            "  - {case: 's/suite.yaml:gone', because: nobody knows}\n");
  const auto result = cli.suite({"--quarantine", "known.yaml", "--junit", "r.xml"});
  CHECK(result.code == 0);
  CHECK(result.out.ends_with("\n1 passed, 0 failed, 1 quarantined\n"));
  CHECK(holds(result.err, "names s/suite.yaml:gone, which is no case"));
  CHECK(holds(cli.read("r.xml"), "quarantined: the golden file is on its way"));
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  const auto passes = cli.suite({"--quarantine", "known.yaml"});
  CHECK(holds(passes.err, "s/suite.yaml:both passes: take it from the quarantine list"));
  for (const auto* bad : {"quarantine: 3\n", "cases: []\n", "quarantine: [{case: x}]\n",
                          "quarantine: [{case: x, because: ' '}]\n",
                          "quarantine: [{case: x, because: y}, {case: x, because: z}]\n"}) {
    cli.write("known.yaml", bad);
    CHECK_MESSAGE(cli.suite({"--quarantine", "known.yaml"}).code == 3, bad);
  }
  CHECK(cli.suite({"--quarantine", "absent.yaml"}).code == 2);
}

TEST_CASE("a summary replaces a summary and nothing else") {
  const SuiteFixture cli;
  cli.write("notes.md", "# mine\n");
  CHECK(cli.suite({"--markdown", "notes.md"}).code == 2);
  CHECK(cli.read("notes.md") == "# mine\n");
  const auto result = cli.suite({"--markdown", "summary.md", "--annotations", "github"});
  CHECK(result.code == 1);
  CHECK(holds(cli.read("summary.md"), "### Suite: 1 passed, 1 failed"));
  CHECK(holds(result.err, "::error file=s/suite.yaml,line=2,title=failed%3A both::"));
  CHECK(cli.suite({"--markdown", "summary.md"}).code == 1);
}

TEST_CASE("a footprint names every file that was read, and replaces none of them") {
  const SuiteFixture cli;
  cli.write("s/all.e", "load lamp.e\n");
  REQUIRE(cli.parallax({"traces", "s/all.e", "--footprint", "fp.json"}).code == 0);
  const auto json = Json::parse(cli.read("fp.json"));
  CHECK(json["inputs"] == Json({"s/all.e", "s/lamp.e"}));
  CHECK(json["peak_memory_mb"].get<int>() > 0);
  const auto lamp = cli.read("s/lamp.e");
  CHECK(cli.parallax({"traces", "s/all.e", "--footprint", "s/lamp.e"}).code == 2);
  CHECK(cli.read("s/lamp.e") == lamp);
}

}  // namespace
}  // namespace parallax::test
