#pragma once

#include "harness/simulator/simulator.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// A lane along x with a box on the floor, and beside it a robot that drives along the lane. Its
/// arm reaches over the lane: reach along x, lift along z, and two pads that squeeze along y.
/// At the default placement the tool is 0.24 m above the lane, at robot.x.
WorldSpec fetch_world();

double number(const State& state, std::string_view name);
bool flag(const State& state, std::string_view name);
std::string text(const State& state, std::string_view name);

}  // namespace parallax::harness
