#pragma once

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "harness/engine/mujoco_module.h"
#include "harness/engine/physics_world.h"

namespace parallax::harness {

/// All that this build can step a world with; tests hold for each of them.
inline std::vector<EngineKind> engines() {
  std::vector<EngineKind> all{EngineKind::kOde};
  if (has_mujoco()) {
    all.push_back(EngineKind::kMujoco);
  } else {
    MESSAGE("without MuJoCo: " << why_no_mujoco());
  }
  return all;
}

inline WorldSpec stepped_by(EngineKind engine, WorldSpec spec) {
  spec.engine = engine;
  return spec;
}

}  // namespace parallax::harness
