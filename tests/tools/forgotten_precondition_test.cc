// Forgotten preconditions whose initial states are merged into one trace: found by default, blamed
// on the initial state, and repaired by that condition (scenarios/ward).

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
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
};

const std::vector<Forgotten>& forgotten() {
  static const std::vector<Forgotten> all = {
      {"trolley", "Go(bed)", {"TrolleyAt(onWay)"}, 3},
      {"linen", "Detect()", {"LinenAt(before)", "LinenAt(beside)"}},
      {"reach", "PickUp()", {"CanAt(back)", "CanAt(front)"}},
      {"weight", "PickUp()", {"Full()"}},
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
    CHECK(proposal.find(each.event.substr(0, each.event.find('('))) != std::string::npos);
    CHECK(names_one_of(proposal, each.conditions));
  }
}

/// Adds a further simulation of `explain` to the run as a second discrepancy, as runs have that
/// were ended while several simulations ran: one from another initial state. Gives its number.
std::string add_second_discrepancy(const CliFixture& cli, std::int64_t first_state) {
  std::istringstream further(cli.read("out/further/journal.ndjson"));
  auto journal = cli.read("out/journal.ndjson");
  std::map<std::int64_t, std::string> starts;
  for (std::string line; std::getline(further, line);) {
    const auto json = Json::parse(line);
    if (!json.contains("start_state")) continue;
    const std::int64_t state = json.at("start_state");
    if (!json.contains("sample")) starts[state] = line;
    if (!json.contains("sample") || state == first_state || !starts.contains(state)) continue;
    if (line.find("object-not-held: `can` is not held") == std::string::npos) continue;
    if (journal.find(starts[state]) == std::string::npos) journal += starts[state] + '\n';
    cli.write("out/journal.ndjson", journal + line + '\n');
    auto report = Json::parse(cli.read("out/report.json"));
    auto second = report.at("discrepancies").at(0);
    second["sample"] = json.at("sample");
    second["start_state"] = state;
    report.at("discrepancies").push_back(second);
    cli.write("out/report.json", report.dump());
    return "1." + std::to_string(json.at("sample").get<std::int64_t>());
  }
  return {};
}

TEST_CASE("confirm and threshold tell the initial state, and keep those of several apart") {
  const CliFixture cli;
  const auto report = json_of(cli, {"run", ward("weight"), "--out", "out"}, 1);
  const std::int64_t state = report.at("discrepancies").at(0).at("start_state");
  json_of(cli, {"explain", "out"}, 1);
  const auto second = add_second_discrepancy(cli, state);
  REQUIRE_FALSE(second.empty());
  const std::vector<std::string> few = {"--repeats", "2", "--runs", "9"};
  const auto confirm = [&](const std::string& sample) {
    std::vector<std::string> asked = {"confirm", "out", "--sample", sample};
    asked.insert(asked.end(), few.begin(), few.end());
    return json_of(cli, asked, 1);
  };
  const auto first_id =
      "1." + std::to_string(report.at("discrepancies").at(0).at("sample").get<int>());
  const auto one = confirm(first_id);
  CHECK(one.at("initial_state").at("number") == state);
  CHECK(one.at("initial_state").at("all") == 4);
  CHECK(one.at("initial_state").at("holds").get<std::string>().find("Full()") == 0);
  const auto other = confirm(second);
  CHECK(other.at("initial_state").at("number") != state);
  CHECK(other.at("again").at("bit_equal") == true);
  CHECK(other.at("other_seeds").at("runs") == 2);
  // Nothing of the one is taken for the other, or made again.
  const auto journal = cli.read("out/same_start/journal.ndjson");
  CHECK(confirm(first_id) == one);
  CHECK(confirm(second) == other);
  CHECK(cli.read("out/same_start/journal.ndjson") == journal);

  const auto line = cli.parallax(
      {"threshold", "out", "--parameter", "can.x", "--points", "2", "--sample", second});
  CAPTURE(line.out + line.err);
  CHECK(line.code == 0);
  CHECK(line.out.find("All starts lie in the initial state of this simulation") !=
        std::string::npos);
  CHECK(cli.parallax({"report", "out"}).code == 0);
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
