// `parallax suite` on manifests, as a real process.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {
namespace {

TEST_CASE("a golden file is written on demand, held against, and its difference is shown") {
  const SuiteFixture cli;
  const auto missing = cli.suite({});
  CHECK(missing.code == 1);
  CHECK(holds(missing.out, "there is no golden file s/expected/both.txt"));
  CHECK(missing.out.ends_with("\n1 passed, 1 failed\n"));

  CHECK(cli.suite({"--update-goldens"}).code == 0);
  CHECK(cli.read("s/expected/both.txt") == cli.parallax({"traces", "s/lamp.e"}).out);
  const auto passed = cli.suite({"--no-cache"});
  CHECK(passed.code == 0);
  CHECK(passed.out == "2 passed, 0 failed\n");

  cli.replace("s/expected/both.txt", "> Press()", "> Pull()");
  const auto failed = cli.suite({"--no-cache"});
  CHECK(failed.code == 1);
  CHECK(holds(failed.out, "FAIL  s/suite.yaml:both"));
  CHECK(holds(failed.out, "-       > Pull()"));
  CHECK(holds(failed.out, "+       > Press()"));
  CHECK(failed.out.ends_with("\n1 passed, 1 failed\n"));
}

TEST_CASE("a wrong number of traces fails, and no golden file is made of it") {
  const SuiteFixture cli;
  cli.replace("s/suite.yaml", "traces: 2", "traces: 3");
  const auto result = cli.suite({"--update-goldens"});
  CHECK(result.code == 1);
  CHECK(holds(result.out, "2 traces, expected 3 traces"));
  CHECK_FALSE(fs::exists(cli.folder() / "s/expected/both.txt"));
}

TEST_CASE("golden files are not rewritten under CI without force") {
  const SuiteFixture cli;
  const auto refused = cli.suite_under_ci({"--update-goldens"});
  CHECK(refused.code == 2);
  CHECK(holds(refused.err, "E7007"));
  CHECK_FALSE(fs::exists(cli.folder() / "s/expected/both.txt"));
  CHECK(cli.suite_under_ci({"--update-goldens", "--force"}).code == 0);
  CHECK(fs::exists(cli.folder() / "s/expected/both.txt"));
}

TEST_CASE("there are more traces than `complete: false` asks for, or the case fails") {
  const SuiteFixture cli;
  cli.replace("s/suite.yaml", "{traces: 2, golden: expected/both.txt}",
              "{traces: 1, complete: false}");
  CHECK(cli.suite({}).code == 0);
  cli.replace("s/suite.yaml", "traces: 1, complete", "traces: 2, complete");
  const auto result = cli.suite({});
  CHECK(result.code == 1);
  CHECK(holds(result.out, "2 traces, expected 2 traces and more"));
}

TEST_CASE("a horizon replaces that of the model") {
  const SuiteFixture cli;
  cli.replace("s/suite.yaml", "{traces: 2, golden: expected/both.txt}", "{traces: 8}");
  cli.replace("s/suite.yaml", "id: both", "id: both\n    horizon: 3");
  CHECK(cli.suite({}).code == 0);  // pressed or not at 0, 1, 2
}

TEST_CASE("a model that is refused is an error of its case, not of the suite") {
  const SuiteFixture cli;
  cli.write("s/lamp.e", std::string(kLamp) + "HoldsAt(Off(),0).\n");
  const auto result = cli.suite({"--junit", "report.xml"});
  CHECK(result.code == 1);
  CHECK(result.out.ends_with("\n0 passed, 0 failed, 2 without an answer\n"));
  CHECK(holds(result.out, "the input was refused"));
  CHECK(holds(result.out, "`Off`"));
  CHECK(holds(cli.read("report.xml"), R"(errors="2")"));
}

TEST_CASE("a suite removes nothing but earlier runs and replaces nothing but earlier reports") {
  const SuiteFixture cli;
  const auto kept = [&](const std::vector<std::string>& arguments, const std::string& file,
                        int code) {
    CAPTURE(arguments.back());
    const auto before = cli.read(file);
    CHECK(cli.parallax(arguments).code == code);
    CHECK(cli.read(file) == before);
  };
  // The run folder of wrong_model.yaml would be the file itself.
  kept({"suite", "wrong_model.yaml", "--out", "."}, "wrong_model.yaml", 1);
  fs::create_directories(cli.folder() / "o/wrong_model.yaml");
  cli.write("o/wrong_model.yaml/letter", "mine");
  kept({"suite", "wrong_model.yaml", "--out", "o"}, "o/wrong_model.yaml/letter", 1);
  for (const auto* file : {"s/suite.yaml", "s/lamp.e", "edge.yaml"}) {
    kept({"suite", "s", "--only", "lit", "--junit", file}, file, 2);
  }
  cli.write("empty", "");
  CHECK(cli.parallax({"suite", "s", "--only", "lit", "--junit", "empty"}).code == 0);
  CHECK(cli.parallax({"suite", "s", "--only", "lit", "--junit", "empty"}).code == 0);
}

TEST_CASE("golden files are written below the manifest's folder only, and told by their path") {
  const SuiteFixture cli;
  const auto told = cli.suite({"--update-goldens"});
  CHECK(told.code == 0);
  CHECK(holds(told.err, "golden file written: s/expected/both.txt"));
  cli.replace("s/suite.yaml", "expected/both.txt", "../both.txt");
  const auto outside = cli.suite({"--update-goldens"});
  CHECK(outside.code == 3);
  CHECK(holds(outside.err, "E1016"));
  const auto permitted = cli.suite({"--update-goldens", "--allow-outside"});
  CHECK(permitted.code == 1);
  CHECK(holds(permitted.out, "does not lie below the manifest's folder"));
  CHECK_FALSE(fs::exists(cli.folder() / "both.txt"));
  // A folder of goldens that is a link leads out as well.
  cli.replace("s/suite.yaml", "../both.txt", "elsewhere/both.txt");
  fs::create_directory(cli.folder() / "victim");
  fs::create_symlink("../victim", cli.folder() / "s/elsewhere");
  CHECK(cli.suite({"--update-goldens"}).code == 3);
  CHECK(fs::is_empty(cli.folder() / "victim"));
}

TEST_CASE("a golden file takes the place of nothing but a list of traces") {
  const SuiteFixture cli;
  const auto refuses = [&](const std::string& name, const std::string& why) {
    CAPTURE(name);
    const auto manifest = cli.read("s/suite.yaml");
    cli.replace("s/suite.yaml", "expected/both.txt", name);
    const bool there = fs::exists(cli.folder() / "s" / name);
    const auto before = there ? cli.read("s/" + name) : "";
    const auto result = cli.suite({"--update-goldens"});
    CHECK(result.code == 1);
    // Sentences are broken at 80 columns.
    const auto told = std::regex_replace(result.out, std::regex("\n +"), " ");
    CHECK_MESSAGE(holds(told, "s/" + name + " " + why + ", so it is not written"), told);
    CHECK(fs::exists(cli.folder() / "s" / name) == there);
    if (there) CHECK(cli.read("s/" + name) == before);
    cli.write("s/suite.yaml", manifest);
  };
  cli.write("s/notes.txt", "4 traces of mice\n");
  const std::string no_list = "is there already and holds no list of traces";
  refuses("lamp.e", no_list);
  refuses("suite.yaml", no_list);
  refuses("notes.txt", no_list);
  refuses(".profile", "is hidden, or lies in a hidden folder");
  refuses(".git/config", "is hidden, or lies in a hidden folder");
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  cli.replace("s/expected/both.txt", "trace 1", "trace one");
  CHECK(cli.suite({"--update-goldens"}).code == 0);
  CHECK(cli.suite({}).code == 0);
}

TEST_CASE("files of a manifest are files, whatever they are called") {
  const SuiteFixture cli;
  const auto lamp = cli.read("s/lamp.e");
  cli.write("s/mine.txt", "mine");
  cli.write("s/--certify=mine.txt", lamp);
  cli.write("s/suite.yaml",
            "cases:\n"
            "  - {id: flag, model: '--certify=mine.txt', expect: {traces: 2, golden: g.txt}}\n");
  ProcessOptions inside;
  inside.folder = (cli.folder() / "s").string();
  const auto result = cli.parallax({"suite", ".", "--update-goldens"}, inside);
  CAPTURE(result.err);
  CHECK(result.code == 0);
  CHECK(cli.read("s/mine.txt") == "mine");
}

TEST_CASE("--out and --junit replace only what a suite has written") {
  const SuiteFixture cli;
  fs::create_directory(cli.folder() / "o");
  cli.write("o/results.json", "{\"mine\": 1}");
  const auto refused = cli.parallax({"suite", "s", "--only", "lit", "--out", "o"});
  CHECK(refused.code == 2);
  CHECK(holds(refused.err, "o/results.json: error[E0007]: this file is there already"));
  CHECK(cli.read("o/results.json") == "{\"mine\": 1}");
  const std::string picture = "<?xml version=\"1.0\"?>\n<svg/>\n";
  cli.write("picture.svg", picture);
  CHECK(cli.parallax({"suite", "s", "--only", "lit", "--junit", "picture.svg"}).code == 2);
  CHECK(cli.read("picture.svg") == picture);
}

TEST_CASE("a limit that ends a case is an error of that case") {
  const SuiteFixture cli;
  // A million and more traces, which cannot be listed in a hundredth of a second.
  cli.replace("s/suite.yaml", "id: both", "id: both\n    horizon: 25\n    limits: {time_s: 0.01}");
  const auto result = cli.suite({});
  CHECK(result.code == 1);
  CHECK(holds(result.out, "inconclusive: a limit ended it first"));
  CHECK(result.out.ends_with("\n1 passed, 0 failed, 1 without an answer\n"));
}

TEST_CASE("a broken manifest is refused before anything runs") {
  const SuiteFixture cli;
  cli.replace("s/suite.yaml", "id: lit", "id: both");
  const auto result = cli.suite({});
  CHECK(result.code == 3);
  CHECK(holds(result.err, "suite.yaml:5:9"));
  CHECK(result.out.empty());
}

TEST_CASE("only what failed last time is run again") {
  const SuiteFixture cli;
  const auto none = cli.suite({"--rerun-failed"});
  CHECK(none.code == 2);
  CHECK(holds(none.err, "E7008"));
  CHECK(cli.suite({}).code == 1);
  const auto again = cli.suite({"--rerun-failed"});
  CHECK(again.out.ends_with("\n0 passed, 1 failed\n"));
  CHECK(holds(again.out, "s/suite.yaml:both"));
  CHECK_FALSE(holds(again.out + again.err, "s/suite.yaml:lit"));
  CHECK(cli.suite({"--rerun-failed", "--update-goldens"}).out == "1 passed, 0 failed\n");
  const auto nothing = cli.suite({"--rerun-failed"});
  CHECK(nothing.code == 0);
  CHECK(nothing.out == "0 passed, 0 failed\n");
}

TEST_CASE("the shards together run every case once") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  std::int64_t passed = 0;
  for (const auto* shard : {"1/3", "2/3", "3/3"}) {
    const auto result = cli.suite({"--shard", shard, "--json"});
    CHECK(result.code == 0);
    const auto document = nlohmann::json::parse(result.out);
    CHECK(document["cases"].size() == 2);
    CHECK(document["passed"].get<int>() + document["skipped"].get<int>() == 2);
    passed += document["passed"].get<std::int64_t>();
  }
  CHECK(passed == 2);
  CHECK(cli.suite({"--shard", "4/3"}).code == 2);
}

TEST_CASE("--only picks cases by their names") {
  const SuiteFixture cli;
  CHECK(cli.suite({"--only", "suite.yaml:lit"}).out == "1 passed, 0 failed\n");
  const auto none = cli.suite({"--only", "nothing"});
  CHECK(none.code == 2);
  CHECK(holds(none.err, "no case is to be found here"));
}

TEST_CASE("scenarios and model expectations are cases side by side") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  const auto document = json_of(cli, {"suite", "s", "wrong_model.yaml"});
  CHECK(document["passed"] == 3);
  CHECK(document["cases"][0]["case"] == "wrong_model.yaml");
}

}  // namespace
}  // namespace parallax::test
