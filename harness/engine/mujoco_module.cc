#include "harness/engine/mujoco_module.h"

#include <variant>

#include "compiler/base/contract.h"
#include "compiler/base/loaded_module.h"

namespace parallax::harness {

#ifdef PARALLAX_HAS_MUJOCO

namespace {

MakeMujocoWorld* loaded_maker() {
  static auto* const kMaker = reinterpret_cast<MakeMujocoWorld*>(
      base::symbol_of_module(kMujocoModule, PARALLAX_MODULES, kMujocoMaker));
  return kMaker;
}

PhysicsWorld* made(const EngineInput& input) {
  MakeMujocoWorld* const maker = loaded_maker();
  return maker == nullptr ? nullptr : maker(PARALLAX_ENGINE_VERSION, input);
}

}  // namespace

bool has_mujoco() { return loaded_maker() != nullptr; }

std::string why_no_mujoco() {
  return has_mujoco() ? ""
                      : "its module, parallax_mujoco.so, cannot be loaded; install libmujoco-dev";
}

#else

namespace {
PhysicsWorld* made(const EngineInput& /*input*/) { return nullptr; }
}  // namespace

bool has_mujoco() { return false; }

std::string why_no_mujoco() {
  return "built without MuJoCo; install libmujoco-dev and build again";
}

#endif

std::optional<TreeProblem> mujoco_problem(const WorldSpec& spec) {
  auto tree = grow_tree(lay_out(spec));
  if (auto* problem = std::get_if<TreeProblem>(&tree)) return std::move(*problem);
  return std::nullopt;
}

std::unique_ptr<PhysicsWorld> make_mujoco_world(const WorldSpec& spec) {
  const WorldLayout layout = lay_out(spec);
  const auto tree = grow_tree(layout);
  PARALLAX_REQUIRE(std::holds_alternative<LinkTree>(tree), "a world whose joints make a tree");
  std::unique_ptr<PhysicsWorld> world(made({spec, layout, std::get<LinkTree>(tree)}));
  PARALLAX_REQUIRE(world != nullptr, "an engine that is there, of this version");
  return world;
}

}  // namespace parallax::harness
