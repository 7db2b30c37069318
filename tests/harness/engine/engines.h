#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "harness/engine/engine_module.h"
#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// All that this build can step a world with; tests hold for each of them.
inline std::vector<EngineKind> engines() {
  for (const EngineKind engine : {EngineKind::kMujoco, EngineKind::kBullet}) {
    if (has_engine(engine)) continue;
    MESSAGE("without " << engine_title(engine) << ": " << why_no_engine(engine));
  }
  return engines_here();
}

/// Those of them that have joint coordinates and a cone of friction.
inline std::vector<EngineKind> engines_with_trees() {
  std::vector<EngineKind> some;
  for (const EngineKind engine : engines_here()) {
    if (needs_tree(engine)) some.push_back(engine);
  }
  return some;
}

inline WorldSpec stepped_by(EngineKind engine, WorldSpec spec) {
  spec.engine = engine;
  return spec;
}

}  // namespace parallax::harness
