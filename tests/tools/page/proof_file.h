#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {

/// A certificate about a run of the two regions (`edge.yaml`, `scenario.yaml`) in `run`, over the
/// two variables that it draws: a quarter safe, a quarter refuted, the rest open.
inline nlohmann::json edge_proof(const CliFixture& cli, const std::string& run) {
  using Json = nlohmann::json;
  const auto journal = cli.read(run + "/journal.ndjson");
  const auto header = Json::parse(journal.substr(0, journal.find('\n')));
  const auto box = [](const char* verdict, Json x, Json y) {
    return Json{{"verdict", verdict}, {"bounds", {x, y}}};
  };
  const Json test = {{"controller", "drive"},
                     {"function", "Drive::is_blocked"},
                     {"source", "harness/robot/mobile_drive.cc"},
                     {"refusal", "path-blocked"},
                     {"asks", "is the way free?"},
                     {"assumed", {"`box` stays within 0.002 m"}},
                     {"examined", 5},
                     {"unconfirmed", 0},
                     {"safe", 0.25},
                     {"refuted", 0.25},
                     {"open", 0.5},
                     {"boxes",
                      {box("safe", {1.0, 1.5}, {0.0, 0.5}), box("refuted", {1.0, 1.5}, {0.5, 1.0}),
                       box("open", {1.5, 2.0}, {0.0, 1.0})}}};
  const Json assumptions = {
      {"drift", 0.002},  {"drift-rad", 0.005},  {"sliding", 0.01}, {"sliding-rad", 0.05},
      {"goal", 10},      {"goal-rad", 10},      {"parked", 0.03},  {"held", 0.03},
      {"held-rad", 0.2}, {"held-height", 0.03}, {"lean", 0.2},     {"sliders", Json::object()}};
  return {{"kind", "parallax geometry proof"},
          {"version", 1},
          {"status", "ok"},
          {"scenario", "edge"},
          {"scenario_hash", header["scenario_hash"]},
          {"trace", 1},
          {"variables", {"box.x", "robot.x"}},
          {"region", {{1.0, 2.0}, {0.0, 1.0}}},
          {"assumptions", assumptions},
          {"actions",
           {{{"number", 0}, {"event", "Go(r2)"}, {"controller", "go"}, {"tests", {test}}},
            {{"number", 1},
             {"event", "PickUp()"},
             {"controller", "pick"},
             {"tests", Json::array()},
             {"left_to_simulation", "contacts decide"}}}}};
}

}  // namespace parallax::test
