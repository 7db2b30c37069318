#include "harness/world/controller_table.h"

#include <algorithm>
#include <array>
#include <limits>

#include "harness/world/controller.h"

namespace parallax::harness {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr std::string_view kUnusedPose = "accepted and unused: this robot works along one line";

constexpr std::array kGoing = {
    ArgumentSpec{"target.x", "m", true, 0.0, false, "where robot.x is to be"},
    ArgumentSpec{"target.y", "m", false, kNone, false, kUnusedPose},
    ArgumentSpec{"target.z", "m", false, kNone, false, kUnusedPose},
    ArgumentSpec{"target.yaw", "rad", false, kNone, false, kUnusedPose},
    ArgumentSpec{"max_speed_m_s", "m/s", false, 0.6, true, "cruising speed of the base"},
    ArgumentSpec{"acceleration_m_s2", "m/s^2", false, 0.8, true, "of the base"},
    ArgumentSpec{"goal_tolerance_m", "m", false, 0.005, true,
                 "the base brakes when so near, and fails when it ends farther away"},
    ArgumentSpec{"settle_s", "s", false, 0.2, true, "rest at the goal"},
};

constexpr std::array kPickingUp = {
    ArgumentSpec{"object", "body", true, 0.0, false, "the free body to pick up"},
    ArgumentSpec{"grip_force_n", "n", false, kNone, true,
                 "squeezing force; unless given, the robot's"},
    ArgumentSpec{"tool_tolerance_m", "m", false, 0.012, true,
                 "the reach axis brakes when so near to the object"},
    ArgumentSpec{"grasp_height_m", "m", false, 0.0, false,
                 "middle of the pads above the object's origin"},
    ArgumentSpec{"max_speed_m_s", "m/s", false, 0.25, true, "of reach and lift"},
    ArgumentSpec{"lift_speed_m_s", "m/s", false, 0.15, true, "of the lift when loaded"},
    ArgumentSpec{"close_speed_m_s", "m/s", false, 0.05, true, "of the driven pad"},
    ArgumentSpec{"hold_s", "s", false, 0.2, true, "squeezing before the lift"},
    ArgumentSpec{"settle_s", "s", false, 0.25, true, "rest after the lift"},
};

constexpr std::array kPlacing = {
    ArgumentSpec{"target.x", "m", true, 0.0, false, "where the tool is to let go"},
    ArgumentSpec{"target.y", "m", false, kNone, false, kUnusedPose},
    ArgumentSpec{"target.z", "m", false, kNone, false, kUnusedPose},
    ArgumentSpec{"target.yaw", "rad", false, kNone, false, kUnusedPose},
    ArgumentSpec{"object", "body", false, 0.0, false,
                 "the body that must be held; unless given, whichever is"},
    ArgumentSpec{"tool_tolerance_m", "m", false, 0.012, true,
                 "the reach axis brakes when so near to the target"},
    ArgumentSpec{"max_speed_m_s", "m/s", false, 0.25, true, "of reach and of the empty lift"},
    ArgumentSpec{"lower_speed_m_s", "m/s", false, 0.15, true, "of the loaded lift"},
    ArgumentSpec{"open_speed_m_s", "m/s", false, 0.10, true, "of the driven pad"},
    ArgumentSpec{"settle_s", "s", false, 0.25, true, "rest after the gripper has left"},
};

struct Entry {
  ControllerSpec spec;
  ControllerFactory factory;
};

constexpr std::array kTable = {
    Entry{{"going", kGoing, "drives the base along x"}, &make_going},
    Entry{{"picking-up", kPickingUp, "grasps a body between the pads and lifts it"},
          &make_picking_up},
    Entry{{"placing", kPlacing, "sets down what is held"}, &make_placing},
};

constexpr auto kSpecs = [] {
  std::array<ControllerSpec, kTable.size()> specs{};
  for (std::size_t i = 0; i < specs.size(); ++i) specs[i] = kTable[i].spec;
  return specs;
}();

}  // namespace

std::span<const ControllerSpec> controllers() { return kSpecs; }

const ControllerSpec* find_controller(std::string_view name) {
  const auto found = std::find_if(kSpecs.begin(), kSpecs.end(),
                                  [&](const ControllerSpec& spec) { return spec.name == name; });
  return found == kSpecs.end() ? nullptr : &*found;
}

ControllerFactory find_factory(std::string_view name) {
  const auto found = std::find_if(kTable.begin(), kTable.end(),
                                  [&](const Entry& entry) { return entry.spec.name == name; });
  return found == kTable.end() ? nullptr : found->factory;
}

}  // namespace parallax::harness
