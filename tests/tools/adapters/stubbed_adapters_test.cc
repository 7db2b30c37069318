// The adapters for Webots and for Gazebo with ROS 2, over stubs of the libraries they need.

#include <nlohmann/json.hpp>

#include "tests/tools/adapters/python_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

struct StubbedRun {
  ProcessResult result;
  Json document;
};

/// One adapter and the stub that it finds in the place of the real modules.
struct Stubbed {
  std::string stub;
  std::string program;
  std::string body;

  std::vector<std::string> command(const std::string& environment) const {
    const std::string tests = PARALLAX_ADAPTER_TESTS;
    std::vector<std::string> words = {"env", "PYTHONPATH=" + tests + "/" + stub, "PACE=0"};
    if (!environment.empty()) words.push_back(environment);
    words.insert(words.end(),
                 {"python3", "-B", std::string(PARALLAX_PYTHON_ADAPTER) + "/examples/" + program});
    return words;
  }

  StubbedRun check(const CliFixture& cli, std::vector<std::string> words,
                   const std::string& environment = "") const {
    words.insert(words.begin(), {"adapter-check", "--json", "--request-limit", "20"});
    words.emplace_back("--");
    const auto started = command(environment);
    words.insert(words.end(), started.begin(), started.end());
    StubbedRun run{cli.parallax(words), {}};
    if (Json::accept(run.result.out)) run.document = Json::parse(run.result.out);
    return run;
  }

  /// `parallax COMMAND` of a model that says one action brings `body` beyond a border [m].
  StubbedRun simulate(const CliFixture& cli, const std::string& command_word,
                      const std::string& border, const std::string& action,
                      const std::string& environment = "") const {
    cli.write("one.e",
              "sort region\nregion near, far\nfluent In(region)\nevent Go(region)\n"
              "[time] {region} HoldsAt(In(region),time).\n"
              "[region1,region2,time] HoldsAt(In(region1),time) & HoldsAt(In(region2),time) -> "
              "region1=region2.\n"
              "[region,time] Initiates(Go(region),In(region),time).\n"
              "[region1,region2,time] region1!=region2 -> "
              "Terminates(Go(region1),In(region2),time).\n"
              "HoldsAt(In(near),0).\nHappens(Go(far),0).\n!Happens(Go(near),0).\n");
    std::string started;
    for (const auto& word : command(environment)) {
      started += (started.empty() ? "" : ", ") + word;
    }
    cli.write("one.yaml",
              "model: one.e\nhorizon: 1\nconstraints: [\"HoldsAt(In(far),time)\"]\n"
              "simulator: {command: [" +
                  started +
                  "]}\n"
                  "regions: {cells: {near: {x: [0.2, " +
                  border + "], start: {x: [0.2, 0.9]}}, far: {x: [" + border +
                  ", 4]}}}\n"
                  "mapping: {In(region): {inside: region, body: " +
                  body +
                  "}}\n"
                  "actions: {Go(region): " +
                  action + "}\n");
    std::vector<std::string> words = {command_word, "one.yaml", "--json", "--jobs", "2"};
    if (command_word == "rates") words.insert(words.end(), {"--runs", "6"});
    StubbedRun run{cli.parallax(words), {}};
    if (Json::accept(run.result.out)) run.document = Json::parse(run.result.out);
    return run;
  }
};

const Stubbed kWebots = {"webots_stub", "webots/pusher.py", "box"};
const Stubbed kGazebo = {"ros2_stub", "gazebo/robot.py", "robot"};

TEST_CASE("adapters for Webots and Gazebo keep the protocol over stubs") {
  if (skipped_without_python()) return;
  const CliFixture cli;
  for (const auto& one : {kWebots, kGazebo}) {
    CAPTURE(one.program);
    const auto checked = one.check(cli, {});
    CAPTURE(checked.result.out);
    CAPTURE(checked.result.err);
    CHECK(checked.result.code == 0);
    for (const auto& finding : checked.document.at("findings")) {
      CHECK(finding.at("severity") != "fault");
    }
    CHECK(checked.document.at("measured").at("largest_start_deviation").get<double>() < 1e-12);
    CHECK(checked.document.at("claims").at("recordings").get<std::string>().starts_with("yes"));
  }
}

TEST_CASE("what happens in Webots is judged, and Webots that ends is a loss") {
  if (skipped_without_python()) return;
  const CliFixture cli;
  const auto clean = kWebots.simulate(cli, "rates", "1", "{controller: push, target.x: 1.5}");
  CAPTURE(clean.result.err);
  REQUIRE(clean.result.code == 0);
  CHECK(clean.document.at("traces").at(0).at("any").at("count") == 0);
  // A box that cannot be brought there has failed, with the reason of the action.
  const auto failed = kWebots.simulate(cli, "run", "2.2", "{controller: push, target.x: 2.4}");
  CAPTURE(failed.result.out);
  CHECK(failed.result.code == 1);
  CHECK(failed.result.out.find("manipulation-goal-not-reached") != std::string::npos);
  const auto ended = kWebots.check(cli, {}, "STUB_STEPS=40");
  CHECK(ended.result.code == 1);
  CHECK(ended.result.out.find("Webots has ended the controller") != std::string::npos);
}

TEST_CASE("what happens in Gazebo is judged, and what does not answer is a loss") {
  if (skipped_without_python()) return;
  const CliFixture cli;
  const std::string drive = "{controller: drive, target.y: 0.2, target.x: ";
  const auto clean = kGazebo.simulate(cli, "rates", "1", drive + "1.5}");
  CAPTURE(clean.result.err);
  REQUIRE(clean.result.code == 0);
  CHECK(clean.document.at("traces").at(0).at("any").at("count") == 0);
  const auto failed = kGazebo.simulate(cli, "run", "3.2", drive + "3.5}");
  CAPTURE(failed.result.out);
  CHECK(failed.result.code == 1);
  CHECK(failed.result.out.find("navigation-pose-unreachable") != std::string::npos);
  const auto rejected = kGazebo.simulate(cli, "run", "1", drive + "1.5}", "STUB_REJECTS=1");
  CHECK(rejected.result.code == 1);
  CHECK(rejected.result.out.find("rejected") != std::string::npos);
  for (const auto* fault : {"STUB_SILENT=step_simulation", "STUB_ABSENT=/gzserver/get_entity_state",
                            "STUB_ABSENT=/navigate_to_pose"}) {
    CAPTURE(fault);
    const auto lost = kGazebo.check(cli, {}, fault);
    CHECK(lost.result.code == 1);
    const std::string place(fault);
    CHECK(lost.result.out.find(place.substr(place.find_first_of("/=") + 1)) != std::string::npos);
  }
}

}  // namespace
}  // namespace parallax::test
