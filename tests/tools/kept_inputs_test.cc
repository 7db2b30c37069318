// Runs whose project has moved on: the texts that a run keeps take the place of its files.

#include "tools/app/kept_inputs.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A run with a discrepancy, in `r`.
class KeptRun : public CliFixture {
 public:
  KeptRun() {
    const auto run = parallax({"run", "wrong_model.yaml", "--out", "r", "--max-runs", "20"});
    REQUIRE(run.code == 1);
  }
  Json inputs() const { return Json::parse(read("r/inputs.json")); }
  void keep(const Json& inputs) const { write("r/inputs.json", inputs.dump()); }
};

TEST_CASE("a run keeps every text that it read, with its hash, and nothing else") {
  const KeptRun cli;
  const auto inputs = cli.inputs();
  CHECK(inputs["scenario"] == "wrong_model.yaml");
  const auto& files = inputs["files"];
  for (const auto* name : {"wrong_model.yaml", "common.yaml", "world.yaml", "wrong_domain.e",
                           "start.e", "hasty.lisp", "robot.bind"}) {
    CAPTURE(name);
    REQUIRE(files.contains(name));
    CHECK(files[name]["text"] == cli.read(name));
  }
  CHECK_FALSE(files.contains("edge.yaml"));
  CHECK_FALSE(has(cli.read("r/inputs.json"), cli.folder().string()));
}

TEST_CASE("what is told of a run is the same when its files have changed, or are gone") {
  const KeptRun cli;
  const auto before = [&](const std::vector<std::string>& words) { return cli.parallax(words); };
  const std::vector<std::vector<std::string>> questions = {
      {"explain", "r", "--runs", "0"}, {"report", "r"}, {"replay", "r"}, {"coverage", "r"}};
  std::vector<std::string> answers;
  for (const auto& words : questions) answers.push_back(before(words).out);
  const auto page = cli.read("r/report.html");
  CHECK(has(page, "wrong_domain.e"));
  const auto ask_again = [&] {
    for (std::size_t i = 0; i < questions.size(); ++i) {
      CAPTURE(questions[i].front());
      const auto again = cli.parallax(questions[i]);
      CHECK(again.out == answers[i]);
      CHECK(again.code == (i == 0 ? 1 : 0));
    }
    CHECK(cli.read("r/report.html") == page);
  };
  // A comment, another mass, a model that is no model any more.
  cli.write("world.yaml", "# heavier\n" + cli.read("world.yaml"));
  CHECK(has(cli.parallax({"replay", "r"}).err, "the texts that the run kept count"));
  ask_again();
  cli.replace("world.yaml", "mass_kg: 0.3", "mass_kg: 3");
  cli.write("wrong_domain.e", "no model\n");
  ask_again();
  for (const auto* name : {"wrong_model.yaml", "common.yaml", "world.yaml"}) {
    fs::remove(cli.folder() / name);
  }
  ask_again();
  // Further simulations are of then, too.
  const auto explained = cli.parallax({"explain", "r", "--runs", "5"});
  CHECK_MESSAGE(explained.code == 1, explained.err);
  CHECK(cli.parallax({"draw", "r", "-o", "r.svg"}).code == 0);
  // Commands that edit files do not edit the kept texts.
  const auto repair = cli.parallax({"repair", "r", "--apply", "1"});
  CHECK(repair.code == 3);
  CHECK(cli.read("wrong_domain.e") == "no model\n");
}

TEST_CASE("kept texts that are not those of the run do not count") {
  const KeptRun cli;
  cli.write("world.yaml", "# a comment\n" + cli.read("world.yaml"));
  const auto good = cli.inputs();
  const auto refused = [&](const Json& inputs) {
    cli.keep(inputs);
    const auto result = cli.parallax({"replay", "r"});
    CHECK(result.code == 3);
    CHECK(has(result.err, "E7113"));
  };
  auto other = good;  // another text, with its own hash
  other["files"]["world.yaml"] = good["files"]["common.yaml"];
  refused(other);
  auto edited = good;
  edited["files"]["world.yaml"]["text"] =
      good["files"]["world.yaml"]["text"].get<std::string>() + "\n";
  refused(edited);
  auto missing = good;
  missing["files"].erase("start.e");
  refused(missing);
  auto foreign = good;
  foreign["scenario_hash"] = std::string(32, '0');
  refused(foreign);
  refused(Json::array());
  cli.keep(good);
  CHECK(cli.parallax({"replay", "r"}).code == 0);
}

TEST_CASE("names in kept texts lead nowhere else") {
  const KeptRun cli;
  const auto good = cli.inputs();
  const auto hash = good["scenario_hash"].get<std::string>();
  const auto unpacks = [&](const std::string& name) {
    auto inputs = good;
    inputs["files"][name] = good["files"]["start.e"];
    cli.keep(inputs);
    const auto into = cli.folder() / "into";
    fs::remove_all(into);
    return tools::unpack_inputs(cli.folder() / "r", hash, "wrong_model.yaml", into).has_value();
  };
  CHECK(unpacks("deep/er/start.e"));
  CHECK(fs::exists(cli.folder() / "into/deep/er/start.e"));
  const auto mode = fs::status(cli.folder() / "into/deep/er/start.e").permissions();
  CHECK((mode & fs::perms::owner_exec) == fs::perms::none);
  const auto victim = (cli.folder() / "victim").string();
  for (const std::string& name :
       {std::string("../victim"), std::string("deep/../../victim"), victim, std::string(".."),
        std::string("."), std::string(""), std::string("start.e/"), std::string("./victim")}) {
    CAPTURE(name);
    CHECK_FALSE(unpacks(name));
  }
  CHECK_FALSE(fs::exists(victim));
}

TEST_CASE("files that are no text, and scenarios in a marked root, are kept as they are") {
  const CliFixture cli;
  fs::create_directories(cli.folder() / "p/deep");
  cli.write("p/.parallax-root", "");
  const std::string bytes("\xff\x00\x01solid", 8);
  cli.write("p/mesh.stl", bytes);
  cli.write("p/deep/s.yaml", "include: ../common.yaml\n");
  cli.write("p/common.yaml", "name: x\n");
  const auto in_p = [&](const char* name) { return (cli.folder() / "p" / name).string(); };
  const auto packed = tools::packed_inputs(
      in_p("deep/s.yaml"), "h",
      {in_p("deep/s.yaml"), in_p("common.yaml"), in_p("mesh.stl"), "/bin/sh", in_p("absent")});
  const auto json = Json::parse(packed);
  CHECK(json["scenario"] == "deep/s.yaml");
  CHECK(json["files"].size() == 3);
  fs::create_directory(cli.folder() / "run");
  cli.write("run/inputs.json", packed);
  const auto found =
      tools::unpack_inputs(cli.folder() / "run", "h", "p/deep/s.yaml", cli.folder() / "into");
  REQUIRE(found);
  CHECK(found->scenario == cli.folder() / "into/deep/s.yaml");
  CHECK(found->named == "p");
  CHECK(cli.read("into/mesh.stl") == bytes);
}

TEST_CASE("a suite says which value of the world changed since its case passed") {
  const CliFixture cli;
  const std::vector<std::string> suite = {"suite", "wrong_model.yaml"};
  REQUIRE(cli.parallax(suite).code == 0);
  // The arm reaches the box now, as the model says.
  cli.replace("world.yaml", "range_m: [-0.6, 0.6]", "range_m: [-3, 3]");
  const auto failed = cli.parallax(suite);
  CHECK(failed.code == 1);
  CHECK_MESSAGE(has(failed.out, "since it passed last, world.yaml changed"), failed.out);
  CHECK(has(failed.out, "world.joints.reach.range_m [-0.6, 0.6] -> [-3, 3]"));
}

TEST_CASE("two runs say which values changed between them") {
  const KeptRun cli;
  cli.replace("world.yaml", "mass_kg: 0.3", "mass_kg: 0.2");
  cli.replace("common.yaml", "r2: {x: [1, 2]}", "r2: {x: [1, 1.95]}");
  REQUIRE(cli.parallax({"run", "wrong_model.yaml", "--out", "q", "--max-runs", "20"}).code == 1);
  const auto found = cli.parallax({"diff", "r", "q"});
  CHECK(found.code == 1);
  CHECK_MESSAGE(has(found.out, "bodies.box.mass_kg 0.3 -> 0.2"), found.out);
  CHECK(has(found.out, "regions.cells.r2.x [1, 2] -> [1, 1.95]"));
  CHECK_FALSE(has(found.out, "/tmp/"));
  const auto document = json_of(cli, {"diff", "r", "q"}, 1);
  CHECK(document["inputs"]["settings"].size() == 2);
  CHECK(document["inputs"]["settings"][0]["new_place"]["file"] == "common.yaml");
  REQUIRE(cli.parallax({"report", "r", "q", "-o", "two.html"}).code == 0);
  CHECK(has(cli.read("two.html"), "world.bodies.box.mass_kg 0.3 -&gt; 0.2"));
  // A file that was exchanged together with its own hash.
  auto forged = Json::parse(cli.read("q/inputs.json"));
  const auto good = forged;
  forged["files"]["world.yaml"] = cli.inputs()["files"]["world.yaml"];
  cli.write("q/inputs.json", forged.dump());
  const auto refused = cli.parallax({"diff", "r", "q"});
  CHECK_MESSAGE(has(refused.out, "not compared: q/inputs.json does not hold what the run read"),
                refused.out);
  CHECK_FALSE(has(refused.out, "regions.cells.r2.x"));
  const auto why = json_of(cli, {"diff", "r", "q"}, refused.code);
  CHECK(why["inputs"].is_null());
  CHECK(why["inputs_refused"] == "q/inputs.json does not hold what the run read");
  CHECK(has(cli.parallax({"report", "r", "q", "-o", "two.html"}).err, "q/inputs.json does not"));
  CHECK(has(cli.read("two.html"), "not compared: q/inputs.json does not hold what the run read"));
  CHECK_FALSE(has(cli.read("two.html"), "regions.cells.r2.x"));
  // So is a header's hash that is claimed for other texts.
  auto renamed = good;
  renamed["scenario_hash"] = cli.inputs()["scenario_hash"];
  cli.write("q/inputs.json", renamed.dump());
  CHECK(has(cli.parallax({"diff", "r", "q"}).out, "q/inputs.json does not hold"));
  fs::remove(cli.folder() / "q/inputs.json");
  CHECK(has(cli.parallax({"diff", "r", "q"}).out, "were not compared: q kept no texts"));
}

TEST_CASE("a run that was killed in its search has kept its texts") {
  const CliFixture cli;
  cli.write("searched.yaml", "include: scenario.yaml\nsearch: 5000\n");
  const auto journal = cli.folder() / "k/journal.ndjson";
  ProcessOptions options;
  options.signal_when = [&] {
    std::ifstream in(journal);
    const auto lines = std::count(std::istreambuf_iterator<char>(in), {}, '\n');
    return lines > 2 ? SIGKILL : 0;
  };
  REQUIRE(cli.parallax({"run", "searched.yaml", "--out", "k"}, options).code == 128 + SIGKILL);
  CHECK(fs::exists(cli.folder() / "k/inputs.json"));
}

TEST_CASE("a run that was killed can be told of when its files have changed") {
  const CliFixture cli;
  const auto journal = cli.folder() / "k/journal.ndjson";
  ProcessOptions options;
  options.signal_when = [&] {
    std::ifstream in(journal);
    const auto lines = std::count(std::istreambuf_iterator<char>(in), {}, '\n');
    return lines > 10 ? SIGKILL : 0;
  };
  const auto killed = cli.parallax({"run", "scenario.yaml", "--out", "k"}, options);
  REQUIRE(killed.code == 128 + SIGKILL);
  REQUIRE_FALSE(fs::exists(cli.folder() / "k/report.json"));
  const auto before = cli.parallax({"replay", "k"});
  REQUIRE(before.code == 0);
  cli.replace("world.yaml", "mass_kg: 0.3", "mass_kg: 3");
  const auto after = cli.parallax({"replay", "k"});
  CHECK_MESSAGE(after.code == 0, after.err);
  CHECK(after.out == before.out);
  CHECK(has(after.err, "the texts that the run kept count"));
}

}  // namespace
}  // namespace parallax::test
