#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "harness/robot/ode_simulator.h"
#include "tests/harness/config/scenario_world.h"
#include "tests/harness/world/hand_made.h"

namespace parallax::harness {

inline const WorldSpec& chain_warehouse() {
  static const WorldSpec world = world_of("arms/warehouse_arms.yaml");
  return world;
}

/// A robot that is asked for actions, and watched while it does them.
class Robot {
 public:
  explicit Robot(const WorldSpec& spec, const State& initial = {}) : simulator_(spec) {
    const Outcome start = simulator_.reset(initial, 1);
    CAPTURE(start.reason);
    REQUIRE(start.status == SimStatus::kOk);
    simulator_.watch(
        [](void* context, double, const OdeSimulator& simulator) {
          auto& robot = *static_cast<Robot*>(context);
          if (robot.watcher_) robot.watcher_(simulator);
        },
        this);
  }

  Outcome act(std::string_view action, const State& arguments) {
    Outcome outcome = simulator_.act(action, arguments, 60.0);
    CAPTURE(outcome.reason);
    REQUIRE(outcome.status != SimStatus::kUnsupported);
    REQUIRE(outcome.status != SimStatus::kLost);
    return outcome;
  }
  /// Looks at a spot and finds a part there.
  void find(const std::string& spot, const std::string& part) {
    REQUIRE(act("look", {{"place", spot}}).status == SimStatus::kOk);
    REQUIRE(act("detect", {{"kind", part}}).status == SimStatus::kOk);
  }
  Outcome pick(const std::string& part) {
    return act("pick-up", {{"arm", std::string("left")}, {"object", part}, {"standoff_m", 0.15}});
  }
  Outcome wait(double time_s) {
    return act("open-gripper", {{"arm", std::string("left")}, {"settle_s", time_s}});
  }
  void watch(std::function<void(const OdeSimulator&)> watcher) { watcher_ = std::move(watcher); }

  const PhysicsWorld& world() const { return simulator_.world(); }
  Eigen::Vector3d position(std::string_view body) const {
    return world().position(*world().layout().find_body(body));
  }
  Eigen::Matrix3d rotation(std::string_view body) const {
    return world().rotation(*world().layout().find_body(body));
  }
  double number(const std::string& name) const {
    return std::get<double>(simulator_.state().at(name));
  }
  Value observed(const std::string& name) const { return simulator_.state().at(name); }
  bool flag(const std::string& name) const { return std::get<bool>(simulator_.state().at(name)); }
  double leans_rad(std::string_view body) const {
    return std::acos(std::min(1.0, rotation(body)(2, 2)));
  }

 private:
  OdeSimulator simulator_;
  std::function<void(const OdeSimulator&)> watcher_;
};

}  // namespace parallax::harness
