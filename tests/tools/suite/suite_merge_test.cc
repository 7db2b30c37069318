// The shards of a suite put together, as real processes.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/tools/cli_json.h"
#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kCases = 24;

/// Four shards in o1 to o4, and the whole in `whole`. Every fifth case fails.
class Shards : public SuiteFixture {
 public:
  Shards() {
    std::string text = "cases:\n";
    for (int i = 0; i < kCases; ++i) {
      text += "  - {id: c" + std::to_string(i) +
              ", model: lamp.e, expect: {traces: " + (i % 5 == 0 ? "3" : "2") + "}}\n";
    }
    write("s/suite.yaml", text);
    for (int i = 1; i <= 4; ++i) run(i);
    (void)suite({"--out", "whole", "--no-cache", "--junit", "whole.xml"});
  }
  void run(int shard, const std::string& seed = "1") const {
    const auto i = std::to_string(shard);
    (void)suite({"--out", "o" + i, "--shard", i + "/4", "--no-cache", "--seed", seed});
  }
  ProcessResult merge(std::vector<std::string> folders,
                      const std::vector<std::string>& more = {}) const {
    folders.insert(folders.begin(), {"suite", "--out", "merged", "--merge"});
    folders.insert(folders.end(), more.begin(), more.end());
    return parallax(folders);
  }
  Json results(const std::string& out) const { return Json::parse(read(out + "/results.json")); }
};

TEST_CASE("four shards together are the suite as one process runs it") {
  const Shards cli;
  const auto result = cli.merge({"o1", "o2", "o3", "o4"}, {"--junit", "merged.xml"});
  CAPTURE(result.err);
  CHECK(result.code == 1);
  CHECK(result.out.ends_with("\n19 passed, 5 failed\n"));
  CHECK(without_times(cli.read("merged.xml")) == without_times(cli.read("whole.xml")));
  // The order of the folders does not matter, and a second merge replaces the first.
  CHECK(cli.merge({"o4", "o2", "o1", "o3"}, {"--junit", "again.xml"}).code == 1);
  CHECK(without_times(cli.read("again.xml")) == without_times(cli.read("whole.xml")));
}

TEST_CASE("the cases of a missing shard are the ones that have not finished") {
  const Shards cli;
  std::set<std::string> of_third;
  const auto third = cli.results("o3");
  for (const auto& [name, one] : third["cases"].items()) {
    if (one["outcome"] != "skipped") of_third.insert(name);
  }
  REQUIRE_FALSE(of_third.empty());
  const auto result = cli.merge({"o1", "o2", "o4"}, {"--json"});
  CHECK(result.code == 1);
  CHECK(holds(result.err, "shard 3/4 is missing: run it with --shard 3/4 and merge again"));
  std::set<std::string> unfinished;
  const auto document = Json::parse(result.out);
  for (const auto& one : document["cases"]) {
    if (one["outcome"] != "not finished") continue;
    unfinished.insert(one["case"].get<std::string>());
    CHECK(one["problems"][0] == "not finished: shard 3/4 is missing");
  }
  CHECK(unfinished == of_third);
}

TEST_CASE("a shard that was ended is completed by its rerun") {
  const Shards cli;
  // As it stands on disk when the suite is killed after its first cases.
  auto json = cli.results("o2");
  std::set<std::string> open;
  for (auto& [name, one] : json["cases"].items()) {
    if (one["outcome"] == "skipped" || open.size() == 2) continue;
    one["outcome"] = "not finished";
    open.insert(name);
  }
  REQUIRE(open.size() == 2);
  cli.write("o2/results.json", json.dump());
  const auto partial = Json::parse(cli.merge({"o1", "o2", "o3", "o4"}, {"--json"}).out);
  CHECK(partial["not_run"] == 2);
  for (const auto& one : partial["cases"]) {
    CHECK((one["outcome"] == "not finished") == open.contains(one["case"].get<std::string>()));
  }
  const auto rerun =
      cli.suite({"--out", "o2", "--shard", "2/4", "--no-cache", "--resume", "--json"});
  CHECK(Json::parse(rerun.out)["reused"].get<int>() > 0);
  CHECK(cli.merge({"o1", "o2", "o3", "o4"}).out.ends_with("\n19 passed, 5 failed\n"));
}

/// Two shards in o1 and o2, of eight cases that pass.
class TwoShards : public SuiteFixture {
 public:
  TwoShards() {
    std::string text = "cases:\n";
    for (int i = 0; i < 8; ++i) {
      text += "  - {id: c" + std::to_string(i) + ", model: lamp.e, expect: {traces: 2}}\n";
    }
    write("s/suite.yaml", text);
    run("1");
    run("2");
  }
  void run(const std::string& i) const {
    (void)suite({"--out", "o" + i, "--shard", i + "/2", "--no-cache"});
  }
  ProcessResult merge(std::vector<std::string> folders, const std::string& junit) const {
    folders.insert(folders.begin(),
                   {"suite", "--json", "--out", "merged", "--junit", junit, "--merge"});
    return parallax(folders);
  }
};

TEST_CASE("a shard that left nothing, or half of it, is one that has not finished") {
  const TwoShards cli;
  const auto second = cli.read("o2/results.json");
  cli.write("o2/results.json", "");
  SUBCASE("absent") { fs::remove_all(cli.folder() / "o2"); }
  SUBCASE("an empty folder") { fs::remove(cli.folder() / "o2/results.json"); }
  SUBCASE("an empty file") {}
  SUBCASE("cut") { cli.write("o2/results.json", second.substr(0, second.size() / 2)); }
  SUBCASE("cut to a whole document") { cli.write("o2/results.json", "{}"); }
  const auto result = cli.merge({"o1", "o2"}, "merged.xml");
  const auto unnamed = cli.merge({"o1"}, "unnamed.xml");
  CHECK(holds(result.err, "o2/results.json has no results that can be read"));
  CHECK(holds(result.err, "shard 2/2 is missing"));
  CHECK(result.code == 4);
  CHECK(unnamed.code == 4);
  CHECK(result.out == unnamed.out);
  CHECK(without_times(cli.read("merged.xml")) == without_times(cli.read("unnamed.xml")));
  CHECK(holds(cli.read("merged.xml"), "not finished: shard 2/2 is missing"));
}

TEST_CASE("shards of different revisions are refused, wherever they differ") {
  const TwoShards cli;
  const auto load_extra = [&] {
    cli.write("s/lamp.e", std::string(kLamp) + "load extra.e\n");
    cli.run("1");
  };
  cli.write("s/extra.e", "event Blink()\n");
  std::string what = "is not the same";
  SUBCASE("the model") { cli.write("s/lamp.e", std::string(kLamp) + "event Blink()\n"); }
  SUBCASE("what is expected") {
    cli.replace("s/suite.yaml", "c1, model: lamp.e, expect: {traces: 2",
                "c1, model: lamp.e, expect: {traces: 4");
  }
  SUBCASE("a horizon") { cli.replace("s/suite.yaml", "c2, model", "c2, horizon: 1, model"); }
  SUBCASE("a text that the model loads") {
    load_extra();
    cli.write("s/extra.e", "event Blink()\nevent Wink()\n");
    what = "s/extra.e is not the same";
  }
  SUBCASE("a text that hides another one") {
    cli.write("extra.e", "event Blink()\n");
    load_extra();
    fs::remove(cli.folder() / "s/extra.e");
    what = "s/extra.e is not the same";
  }
  cli.run("2");
  const auto result = cli.merge({"o1", "o2"}, "merged.xml");
  CHECK(result.code == 2);
  CHECK_MESSAGE(holds(result.err, "this and o1 are of different revisions"), result.err);
  CHECK_MESSAGE(holds(result.err, what), result.err);
}

TEST_CASE("shards that do not belong together are refused, with both of them named") {
  const Shards cli;
  const auto refused = [&](const std::vector<std::string>& folders, const std::string& why) {
    const auto result = cli.merge(folders);
    CHECK(result.code == 2);
    CHECK_MESSAGE(holds(result.err, why), result.err);
    CHECK_FALSE(fs::exists(cli.folder() / "merged"));
  };
  refused({"o1", "o1"}, "this and o1 both are shard 1/4");
  refused({"o1", "whole"}, "this and o1 are of different suites: 4 shards and 1");
  refused({"absent", "nowhere"}, "absent/results.json");
  cli.run(2, "7");
  refused({"o1", "o2"}, "this and o1 are of different suites: seed 1 and 7");
  cli.run(2);
  const auto manifest = cli.read("s/suite.yaml");
  cli.write("s/suite.yaml", manifest + "  - {id: new, model: lamp.e, expect: {traces: 2}}\n");
  cli.run(2);
  refused({"o1", "o2"}, "only one has the case s/suite.yaml:new");
  cli.write("s/suite.yaml", manifest);
  cli.run(2);
  auto json = cli.results("o2");
  const auto version = json["suite"]["tool_version"].get<std::string>();
  json["suite"]["tool_version"] = "0.0.9";
  cli.write("o2/results.json", json.dump());
  refused({"o1", "o2"}, "version " + version + " and 0.0.9");
  // A case that its own shard has not, and one that another shard has.
  json["suite"]["tool_version"] = cli.results("o1")["suite"]["tool_version"];
  auto gap = json;
  for (auto& one : gap["cases"]) {
    if (one["outcome"] == "passed") one["outcome"] = "skipped";
  }
  cli.write("o2/results.json", gap.dump());
  refused({"o1", "o2"}, "but the results say it was not");
  for (auto& one : json["cases"]) one["outcome"] = "passed";
  cli.write("o2/results.json", json.dump());
  refused({"o1", "o2"}, "but the results say it was run there");
  CHECK(cli.parallax({"suite", "s", "--merge", "o1"}).code == 2);
  CHECK(cli.parallax({"suite", "--merge", "o1", "--out", "o1"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
