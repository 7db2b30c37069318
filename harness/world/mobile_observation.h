#pragma once

#include <vector>

#include "harness/world/grasp_monitor.h"
#include "harness/world/mobile_robot.h"
#include "harness/world/perception.h"
#include "harness/world/simulator.h"

namespace parallax::harness {

/// What a world with a mobile robot observes besides the poses of free bodies: robot.x, .y, .yaw,
/// .lift, .looking_at; ARM.x, .y, .z, .opening, .parked, .open; for each free body BODY.bottom,
/// BODY.held_by.ARM, BODY.perceived, BODY.seen.known and BODY.seen.x, .y, .z, .bottom (where it is
/// believed to be; 0 when unknown); JOINT.q of sliders that are no fingers, and CHILD.x, .y, .z,
/// .yaw of what they carry.
std::vector<Parameter> mobile_parameters(const WorldSpec& spec, const WorldLayout& layout);

void observe_mobile(const OdeWorld& world, const MobileRobot& robot, const Perception& perception,
                    const GraspMonitor& grasp, State& out);

}  // namespace parallax::harness
