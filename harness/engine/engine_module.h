#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/engine/link_tree.h"
#include "harness/engine/physics_world.h"

namespace parallax::harness {

// Every engine but ODE brings libraries with it, which a program that simulates with ODE, or not at
// all, need not have. So each of them is a module that is loaded where a world asks for it.

/// The input from which a module makes a world; it keeps copies.
struct EngineInput {
  const WorldSpec& spec;
  const WorldLayout& layout;
  const LinkTree& tree;
};

/// The only function of a module. Null where `version` is not its own.
using MakeEngineWorld = PhysicsWorld*(const char* version, const EngineInput& input);

/// Can this program step worlds with the engine: was it built with it, and is its module there?
bool has_engine(EngineKind engine);

/// Why it cannot, in words for a person; empty if it can.
std::string why_no_engine(EngineKind engine);

/// The engines that this program has, ODE first.
std::vector<EngineKind> engines_here();

/// The engine's name as its makers write it: "MuJoCo".
const char* engine_title(EngineKind engine);

/// Debian's package of it.
const char* engine_package(EngineKind engine);

/// Does the engine have joint coordinates, so that joints must make trees?
inline bool needs_tree(EngineKind engine) { return engine != EngineKind::kOde; }

/// The reason why such an engine cannot step a world that is otherwise right.
std::optional<TreeProblem> tree_problem(const WorldSpec& spec);

/// Needs has_engine(spec.engine), and no tree_problem(). Not for ODE, which is no module.
std::unique_ptr<PhysicsWorld> make_module_world(const WorldSpec& spec);

}  // namespace parallax::harness
