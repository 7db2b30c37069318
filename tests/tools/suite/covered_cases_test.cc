// Suites: that a pass is taken over only where nothing changed, and that no case is left out.

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// scenarios/two_models in this folder.
void put_scenarios(const CliFixture& cli, const std::string& folder) {
  fs::create_directories((cli.folder() / folder).parent_path());
  fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios" / "two_models", cli.folder() / folder,
           fs::copy_options::recursive);
}

TEST_CASE("a module that only children load is part of the program") {
  const auto build = fs::path(PARALLAX_BINARY_DIR);
  if (!fs::exists(build / "modules")) {
    MESSAGE("this build has no modules");
    return;
  }
  const SuiteFixture cli;
  const auto bin = cli.folder() / "bin";
  fs::create_directories(bin);
  fs::copy_file(CliFixture::program(), bin / "parallax");
  fs::copy(build / "modules", bin / "modules");
  cli.write("s/suite.yaml", "cases:\n  - {id: both, model: lamp.e, expect: {traces: 2}}\n");
  const auto suite = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = {(bin / "parallax").string(), "suite", "s", "--json"};
    command.insert(command.end(), more.begin(), more.end());
    ProcessOptions options;
    options.folder = cli.folder().string();
    return run_process(command, options);
  };
  CHECK(suite({}).code == 0);
  CHECK(Json::parse(suite({}).out)["reused"] == 1);
  const auto module = fs::directory_iterator(bin / "modules")->path();
  std::ofstream(module, std::ios::app) << "another build";
  CHECK(Json::parse(suite({}).out)["reused"] == 0);
  CHECK(Json::parse(suite({}).out)["reused"] == 1);
  // Results of another program are not gone on with either.
  std::ofstream(module, std::ios::app) << "and one more";
  const auto resumed = suite({"--resume"});
  CHECK_MESSAGE(resumed.code == 2, resumed.out);
  CHECK_MESSAGE(holds(resumed.out + resumed.err, "another build"), resumed.out, resumed.err);
}

TEST_CASE("two scenarios have two run folders") {
  const CliFixture cli;
  put_scenarios(cli, "col/x");
  put_scenarios(cli, "col/x_y");
  for (const std::string folder : {"col/x", "col/x_y"}) {
    for (const auto* name : {"sticks.yaml", "unparks.yaml"})
      fs::remove(cli.folder() / folder / name);
  }
  fs::rename(cli.folder() / "col/x/agree.yaml", cli.folder() / "col/x/y_z.yaml");
  fs::rename(cli.folder() / "col/x_y/agree.yaml", cli.folder() / "col/x_y/z.yaml");
  const auto result = cli.parallax({"suite", "col", "--out", "out", "--jobs", "2"});
  CHECK_MESSAGE(result.code == 0, result.out, result.err);
  std::size_t runs = 0;
  for (const auto& entry : fs::directory_iterator(cli.folder() / "out")) {
    runs += fs::exists(entry.path() / "journal.ndjson") ? 1 : 0;
  }
  CHECK(runs == 2);
}

TEST_CASE("a case that is gone is told, however the folder is written") {
  for (const std::string path : {"s/", "./s", "s"}) {
    CAPTURE(path);
    const SuiteFixture cli;
    cli.write("s/suite.yaml",
              "cases:\n  - {id: both, model: lamp.e, expect: {traces: 2}}\n"
              "  - {id: gone, model: lamp.e, expect: {traces: 2}}\n");
    CHECK(cli.parallax({"suite", "s"}).code == 0);
    cli.write("s/suite.yaml", "cases:\n  - {id: both, model: lamp.e, expect: {traces: 2}}\n");
    const auto found = cli.parallax({"suite", path});
    CHECK_MESSAGE(found.code == 4, found.out, found.err);
    CHECK(holds(found.out, "s/suite.yaml:gone"));
  }
}

TEST_CASE("shards tell a merge what is gone, and are judged alike") {
  const SuiteFixture cli;
  cli.write("s/suite.yaml",
            "cases:\n  - {id: a, model: lamp.e, expect: {traces: 2}}\n"
            "  - {id: b, model: lamp.e, expect: {traces: 2}}\n"
            "  - {id: gone, model: lamp.e, expect: {traces: 2}}\n");
  const auto shards = [&](const std::vector<std::string>& of_second = {}) {
    for (const std::string i : {"1", "2"}) {
      std::vector<std::string> words = {"--out", "o" + i, "--shard", i + "/2"};
      if (i == "2") words.insert(words.end(), of_second.begin(), of_second.end());
      (void)cli.suite(words);
    }
  };
  shards();
  CHECK(cli.parallax({"suite", "--merge", "o1", "o2", "--out", "m1"}).code == 0);
  cli.write("s/suite.yaml",
            "cases:\n  - {id: a, model: lamp.e, expect: {traces: 2}}\n"
            "  - {id: b, model: lamp.e, expect: {traces: 2}}\n");
  shards();
  const auto merged = cli.parallax({"suite", "--merge", "o1", "o2", "--out", "m2"});
  CHECK_MESSAGE(merged.code == 4, merged.out, merged.err);
  CHECK(holds(merged.out, "s/suite.yaml:gone"));
  cli.write("ledger.yaml", "discrepancies: []\n");
  shards({"--ledger", "ledger.yaml"});
  const auto mixed = cli.parallax({"suite", "--merge", "o1", "o2", "--out", "m3"});
  CHECK_MESSAGE(mixed.code == 2, mixed.out, mixed.err);
  CHECK(holds(mixed.err, "one with --ledger and one without"));
}

TEST_CASE("a manifest whose key is misspelt is refused, not skipped") {
  const SuiteFixture cli;
  cli.write("s/suite.yaml", "case:\n  - {id: both, model: lamp.e, expect: {traces: 2}}\n");
  cli.write("s/other.yaml", "cases:\n  - {id: both, model: lamp.e, expect: {traces: 2}}\n");
  const auto result = cli.parallax({"suite", "s"});
  CHECK_MESSAGE(result.code == 3, result.out, result.err);
  CHECK_MESSAGE(holds(result.err, "cases"), result.err);
}

}  // namespace
}  // namespace parallax::test
