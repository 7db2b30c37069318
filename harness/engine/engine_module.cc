#include "harness/engine/engine_module.h"

#include <fmt/format.h>

#include <variant>

#include "compiler/base/contract.h"
#include "compiler/base/loaded_module.h"

namespace parallax::harness {
namespace {

#ifdef PARALLAX_HAS_MUJOCO
constexpr bool kBuiltWithMujoco = true;
#else
constexpr bool kBuiltWithMujoco = false;
#endif
#ifdef PARALLAX_HAS_BULLET
constexpr bool kBuiltWithBullet = true;
#else
constexpr bool kBuiltWithBullet = false;
#endif

struct EngineModule {
  const char* title;
  const char* package;  // of Debian
  const char* file;     // null: part of the program
  const char* maker;    // the module's function, a MakeEngineWorld
  bool built;
};

constexpr EngineModule kOdeModule{"ODE", "libode-dev", nullptr, nullptr, true};
constexpr EngineModule kMujocoModule{"MuJoCo", "libmujoco-dev", "parallax_mujoco.so",
                                     "parallax_make_mujoco_world", kBuiltWithMujoco};
constexpr EngineModule kBulletModule{"Bullet", "libbullet-dev", "parallax_bullet.so",
                                     "parallax_make_bullet_world", kBuiltWithBullet};

constexpr const EngineModule& module_of(EngineKind engine) {
  switch (engine) {
    case EngineKind::kOde:
      break;
    case EngineKind::kMujoco:
      return kMujocoModule;
    case EngineKind::kBullet:
      return kBulletModule;
  }
  return kOdeModule;
}

/// Loads the module once; null if it is not there.
template <EngineKind kEngine>
MakeEngineWorld* maker_of() {
  constexpr const EngineModule& kModule = module_of(kEngine);
  if constexpr (!kModule.built || kModule.file == nullptr) return nullptr;
  static auto* const kMaker = reinterpret_cast<MakeEngineWorld*>(
      base::symbol_of_module(kModule.file, PARALLAX_MODULES, kModule.maker));
  return kMaker;
}

MakeEngineWorld* loaded_maker(EngineKind engine) {
  switch (engine) {
    case EngineKind::kOde:
      break;
    case EngineKind::kMujoco:
      return maker_of<EngineKind::kMujoco>();
    case EngineKind::kBullet:
      return maker_of<EngineKind::kBullet>();
  }
  return nullptr;
}

}  // namespace

bool has_engine(EngineKind engine) {
  return engine == EngineKind::kOde || loaded_maker(engine) != nullptr;
}

std::string why_no_engine(EngineKind engine) {
  if (has_engine(engine)) return {};
  const EngineModule& one = module_of(engine);
  if (!one.built) {
    return fmt::format("built without {}; install {} and build again", one.title, one.package);
  }
  return fmt::format("its module, {}, cannot be loaded; install {}", one.file, one.package);
}

std::vector<EngineKind> engines_here() {
  std::vector<EngineKind> all;
  for (const EngineKind engine : {EngineKind::kOde, EngineKind::kMujoco, EngineKind::kBullet}) {
    if (has_engine(engine)) all.push_back(engine);
  }
  return all;
}

const char* engine_title(EngineKind engine) { return module_of(engine).title; }
const char* engine_package(EngineKind engine) { return module_of(engine).package; }

std::optional<TreeProblem> tree_problem(const WorldSpec& spec) {
  auto tree = grow_tree(lay_out(spec));
  if (auto* problem = std::get_if<TreeProblem>(&tree)) return std::move(*problem);
  return std::nullopt;
}

std::unique_ptr<PhysicsWorld> make_module_world(const WorldSpec& spec) {
  const WorldLayout layout = lay_out(spec);
  const auto tree = grow_tree(layout);
  PARALLAX_REQUIRE(std::holds_alternative<LinkTree>(tree), "a world whose joints make a tree");
  MakeEngineWorld* const maker = loaded_maker(spec.engine);
  PARALLAX_REQUIRE(maker != nullptr, "an engine that is there");
  std::unique_ptr<PhysicsWorld> world(
      maker(PARALLAX_ENGINE_VERSION, {spec, layout, std::get<LinkTree>(tree)}));
  PARALLAX_REQUIRE(world != nullptr, "a module of this version");
  return world;
}

}  // namespace parallax::harness
