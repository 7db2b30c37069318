#pragma once

#include <cstdint>

#include "harness/geometry_proof/trace_proof.h"
#include "harness/region/state_mapping.h"
#include "harness/world/world_spec.h"

namespace parallax::bench {

/// A robot, things that may stand in its way, a region of starts, and one action.
struct ProofWorld {
  harness::WorldSpec spec;
  harness::StartCuboid region;
  harness::ProofAction action;
};

/// A random drive: two to seven boxes, turned in any way, near the way of a robot with an arm; in
/// every other world one of them is drawn as well. Three or six variables. The same number gives
/// the same world.
ProofWorld random_drive(std::uint64_t number);

}  // namespace parallax::bench
