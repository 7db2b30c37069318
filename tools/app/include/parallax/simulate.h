#pragma once

// Worlds and what moves in them: the built-in engine, or any program that speaks the protocol of
// docs/simulator_protocol.md.
//
//     parallax::OdeSimulator simulator(scenario.world);
//     simulator.reset({{"box.x", 1.1}}, 1);
//     const auto outcome = simulator.act("go_to", {{"target.x", 0.5}}, 30.0);
//     const auto state = simulator.observe();

#include "harness/campaign/worker_pool.h"
#include "harness/config/scenario.h"
#include "harness/robot/ode_simulator.h"
#include "harness/simulator/process_simulator.h"
#include "harness/simulator/simulator.h"

namespace parallax {

using harness::OdeSimulator;
using harness::ProcessOptions;
using harness::ProcessSimulator;
using harness::Scenario;
using harness::Simulator;
using harness::SimulatorFactory;
using harness::SimulatorInfo;
using harness::State;

}  // namespace parallax
