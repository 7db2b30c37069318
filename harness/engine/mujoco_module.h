#pragma once

#include <memory>
#include <optional>
#include <string>

#include "harness/engine/link_tree.h"
#include "harness/engine/physics_world.h"

namespace parallax::harness {

// MuJoCo brings four more libraries with it, which a program that simulates with ODE, or not at
// all, need not have. So the engine is a module that is loaded where a world asks for it.

inline constexpr const char* kMujocoModule = "parallax_mujoco.so";
inline constexpr const char* kMujocoMaker = "parallax_make_mujoco_world";

/// The input from which the module makes a world; it keeps copies.
struct EngineInput {
  const WorldSpec& spec;
  const WorldLayout& layout;
  const LinkTree& tree;
};

/// The module's only function. Null where `version` is not its own.
using MakeMujocoWorld = PhysicsWorld*(const char* version, const EngineInput& input);

/// Was this program built with MuJoCo, and is its module there?
bool has_mujoco();

/// Why it is not, in words for a person; empty if it is.
std::string why_no_mujoco();

/// The reason why MuJoCo cannot step a world that is otherwise right.
std::optional<TreeProblem> mujoco_problem(const WorldSpec& spec);

/// Needs has_mujoco(), and no mujoco_problem().
std::unique_ptr<PhysicsWorld> make_mujoco_world(const WorldSpec& spec);

}  // namespace parallax::harness
