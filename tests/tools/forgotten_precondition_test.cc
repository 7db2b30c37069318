// Forgotten preconditions whose initial states are merged into one trace: found by default, blamed
// on the initial state, and repaired by that condition (scenarios/ward).

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

std::string ward(const std::string& name) {
  return std::string(PARALLAX_SOURCE_DIR) + "/scenarios/ward/" + name + ".yaml";
}

struct Forgotten {
  std::string scenario, event;
  std::vector<std::string> conditions;  // on the initial state, of which one is proposed
  std::int64_t states = 4;
  /// The condition is the first proposal. Not of a fluent that is seen at the start alone.
  bool is_repaired = true;
};

const std::vector<Forgotten>& forgotten() {
  static const std::vector<Forgotten> all = {
      {"trolley", "Go(bed)", {"TrolleyAt(onWay)"}, 3},
      {"linen", "Detect()", {"LinenAt(before)", "LinenAt(beside)"}},
      {"reach", "PickUp()", {"CanAt(back)", "CanAt(front)"}},
      {"weight", "PickUp()", {"Full()"}, 4, false},
      {"vase", "Put(table)", {"VaseAt(onTable)", "VaseAt(onSill)"}},
  };
  return all;
}

bool names_one_of(const std::string& text, const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const auto& name) { return text.find(name) != std::string::npos; });
}

TEST_CASE("each forgotten precondition is found by default, blamed and repaired first") {
  for (const auto& each : forgotten()) {
    CAPTURE(each.scenario);
    const CliFixture cli;
    const auto report = json_of(cli, {"run", ward(each.scenario), "--out", "out"}, 1);
    CHECK(report.at("simulations") <= each.states);
    const auto& states = report.at("traces").at(0).at("initial_states");
    CHECK(states.at("all") == each.states);
    const auto told = json_of(cli, {"explain", "out"}, 1);
    CHECK(told.at("cause") == "state");
    const auto text = cli.parallax({"explain", "out"});
    const auto first = text.out.substr(0, text.out.find('\n'));
    CAPTURE(first);
    CHECK(first.starts_with("It fails where `"));
    CHECK(first.find(each.conditions.front()) != std::string::npos);
    const auto repaired = json_of(cli, {"repair", "out"}, 1);
    const std::string proposal = repaired.at("proposals").at(0).at("words");
    CAPTURE(proposal);
    if (!each.is_repaired) continue;
    CHECK(proposal.find(each.event.substr(0, each.event.find('('))) != std::string::npos);
    CHECK(names_one_of(proposal, each.conditions));
  }
}

TEST_CASE("from the first initial state alone none of them need show") {
  const CliFixture cli;
  namespace fs = std::filesystem;
  fs::create_directories(cli.folder() / "s");
  for (const auto* name : {"ward", "robots"}) {
    fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios" / name, cli.folder() / "s" / name,
             fs::copy_options::recursive);
  }
  cli.write("s/.parallax-root", "");
  cli.write("s/ward/first.yaml", "include: reach.yaml\ninitial: first\n");
  const auto ran = cli.parallax({"run", "s/ward/first.yaml", "--out", "out"});
  CAPTURE(ran.out + ran.err);
  CHECK(ran.code == 0);
  CHECK(ran.out.find("in 1 of 4 initial states") != std::string::npos);
}

TEST_CASE("the right model is clean in every initial state") {
  const CliFixture cli;
  const auto report = json_of(cli, {"run", ward("bring"), "--out", "out"}, 0);
  CHECK(report.at("verdict") == "no-discrepancy");
  const auto& states = report.at("traces").at(0).at("initial_states");
  CHECK(states.at("all") == 2);
  CHECK(states.at("tried") == 2);
}

}  // namespace
}  // namespace parallax::test
