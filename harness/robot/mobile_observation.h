#pragma once

#include "harness/robot/grasp_monitor.h"
#include "harness/robot/mobile_robot.h"
#include "harness/robot/perception.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// Adds to `out` what `observables` lists of a world with a mobile robot, but for the poses of free
/// bodies.
void observe_mobile(const OdeWorld& world, const MobileRobot& robot, const Perception& perception,
                    const GraspMonitor& grasp, State& out);

}  // namespace parallax::harness
