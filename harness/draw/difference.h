#pragma once

#include <string>
#include <vector>

#include "harness/draw/scene_frame.h"
#include "harness/region/state_mapping.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// A fluent on which model and observation part.
struct ShownDifference {
  std::string fluent;
  bool predicted = false, observed = false;
};

/// Shows in the picture what the fluents are about, as far as the mapping ties them to bodies: the
/// body as observed, the region in which the model says that it is, with the way from one to the
/// other, the base at its goal, and what the model says is held in the hand. `before` is the world
/// as it stood when the action began.
void add_differences(const StateMapping& mapping, const WorldSpec& spec,
                     const std::vector<ShownDifference>& differences, const Scene& before,
                     Picture& picture);

}  // namespace parallax::harness
