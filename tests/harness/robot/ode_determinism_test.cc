#include <doctest/doctest.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "harness/robot/ode_simulator.h"
#include "tests/harness/engine/engines.h"
#include "tests/harness/world/fetch_world.h"

namespace parallax::harness {
namespace {

struct Start {
  double robot_x_m, box_x_m, box_yaw_rad;
};

const std::vector<Start> kStarts = {{0.1, 1.9, 0.0}, {0.5, 1.5, 0.05}, {0.9, 1.1, -0.05}};

/// The observation after fetching the box; its digest covers every step on the way.
State fetch(Simulator& simulator, const Start& start, std::uint64_t seed) {
  const State initial = {
      {"robot.x", start.robot_x_m}, {"box.x", start.box_x_m}, {"box.yaw", start.box_yaw_rad}};
  REQUIRE(simulator.reset(initial, seed).status == SimStatus::kOk);
  simulator.act("going", {{"target.x", 1.5}}, 60.0);
  simulator.act("picking-up", {{"object", std::string("box")}}, 60.0);
  simulator.act("going", {{"target.x", 0.5}}, 60.0);
  simulator.act("placing", {{"target.x", 0.5}}, 60.0);
  return simulator.observe();
}

State fetch_in_fresh_world(EngineKind engine, const Start& start) {
  OdeSimulator simulator(stepped_by(engine, fetch_world()));
  return fetch(simulator, start, 3);
}

TEST_CASE("a reset world runs bit for bit like a fresh one, whatever happened before") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    std::vector<State> expected;
    for (const Start& start : kStarts) expected.push_back(fetch_in_fresh_world(engine, start));
    CHECK(text(expected[0], "digest") != text(expected[1], "digest"));

    OdeSimulator used(stepped_by(engine, fetch_world()));
    for (const std::size_t index : {0U, 1U, 2U, 2U, 1U, 0U}) {
      CHECK(fetch(used, kStarts[index], 3) == expected[index]);
    }
    // Left in the middle of things: driving, with the tool down, with the box in the air.
    for (const double limit_s : {0.002, 0.7, 2.3, 3.1, 4.5}) {
      CAPTURE(limit_s);
      used.reset({{"robot.x", 1.5}, {"box.x", 1.6}}, 9);
      used.act("going", {{"target.x", 1.4}}, 0.3);
      used.act("picking-up", {{"object", std::string("box")}}, limit_s);
      CHECK(fetch(used, kStarts[1], 3) == expected[1]);
    }
    // After an invalid start, and after one that slept for long.
    CHECK(used.reset({{"robot.x", 50.0}}, 1).status == SimStatus::kInvalidStart);
    CHECK(fetch(used, kStarts[2], 3) == expected[2]);
  }
}

TEST_CASE("observing does not disturb a run") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    OdeSimulator simulator(stepped_by(engine, fetch_world()));
    simulator.watch([](void*, double, const OdeSimulator& at) { at.state(); }, nullptr);
    CHECK(fetch(simulator, kStarts[0], 3) == fetch_in_fresh_world(engine, kStarts[0]));
  }
}

TEST_CASE("two simulators in one process do not disturb each other") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    const State expected_a = fetch_in_fresh_world(engine, kStarts[0]);
    const State expected_b = fetch_in_fresh_world(engine, kStarts[2]);
    OdeSimulator a(stepped_by(engine, fetch_world())), b(stepped_by(engine, fetch_world()));
    {  // taking turns
      const auto begin = [](Simulator& simulator, const Start& start) {
        REQUIRE(simulator
                    .reset({{"robot.x", start.robot_x_m},
                            {"box.x", start.box_x_m},
                            {"box.yaw", start.box_yaw_rad}},
                           3)
                    .status == SimStatus::kOk);
      };
      begin(a, kStarts[0]);
      begin(b, kStarts[2]);
      const std::vector<std::pair<std::string, State>> actions = {
          {"going", {{"target.x", 1.5}}},
          {"picking-up", {{"object", std::string("box")}}},
          {"going", {{"target.x", 0.5}}},
          {"placing", {{"target.x", 0.5}}}};
      for (const auto& [name, arguments] : actions) {
        a.act(name, arguments, 60.0);
        b.act(name, arguments, 60.0);
      }
      CHECK(a.observe() == expected_a);
      CHECK(b.observe() == expected_b);
    }
    {  // on two threads
      for (int round = 0; round < 5; ++round) {
        State seen_a, seen_b;
        std::thread other([&] { seen_b = fetch(b, kStarts[2], 3); });
        seen_a = fetch(a, kStarts[0], 3);
        other.join();
        CHECK(seen_a == expected_a);
        CHECK(seen_b == expected_b);
      }
    }
  }
}

TEST_CASE("the order in which a world lists its parts does not matter") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    WorldSpec turned = stepped_by(engine, fetch_world());
    std::reverse(turned.bodies.begin(), turned.bodies.end());
    std::reverse(turned.joints.begin(), turned.joints.end());
    OdeSimulator simulator(turned);
    CHECK(fetch(simulator, kStarts[0], 3) == fetch_in_fresh_world(engine, kStarts[0]));
  }
}

TEST_CASE("the smallest change of a start changes the digest") {
  for (const EngineKind engine : engines()) {
    CAPTURE(to_string(engine));
    OdeSimulator simulator(stepped_by(engine, fetch_world()));
    REQUIRE(simulator.reset({{"box.x", 1.5}}, 1).status == SimStatus::kOk);
    const std::string one = text(simulator.observe(), "digest");
    REQUIRE(simulator.reset({{"box.x", std::nextafter(1.5, 2.0)}}, 1).status == SimStatus::kOk);
    CHECK(text(simulator.observe(), "digest") != one);
  }
}

}  // namespace
}  // namespace parallax::harness
