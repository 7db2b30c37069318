#pragma once

// Worlds and what moves in them: the built-in engine, or any program that speaks the protocol of
// docs/reference/protocol.md.
//
//     parallax::OdeSimulator simulator(scenario.world);
//     simulator.reset({{"box.x", 1.1}}, 1);
//     const auto outcome = simulator.act("go_to", {{"target.x", 0.5}}, 30.0);
//     const auto state = simulator.observe();
//
//     const auto make_simulator =              // of a whole scenario, in processes of their own
//         parallax::simulator_factory(*loaded, {"parallax", "worker"}, context.stop());

#include "harness/campaign/worker_pool.h"
#include "harness/config/scenario.h"
#include "harness/robot/ode_simulator.h"
#include "harness/simulator/process_simulator.h"
#include "harness/simulator/simulator.h"
#include "tools/app/scenario_model.h"
#include "tools/app/simulator_factory.h"

namespace parallax {

using harness::OdeSimulator;
using harness::ProcessOptions;
using harness::ProcessSimulator;
using harness::Scenario;
using harness::Simulator;
using harness::SimulatorFactory;
using harness::SimulatorInfo;
using harness::State;

using tools::simulator_factory;

}  // namespace parallax
