#include "harness/robot/guarded_simulator.h"

#include <fmt/format.h>

#include <utility>

#include "compiler/base/words.h"
#include "harness/engine/engine_module.h"
#include "harness/engine/world_check.h"

namespace parallax::harness {
namespace {

/// The world with its step divided. The stiffness and damping of contacts change with it, as they
/// do when the scenario is given this step.
WorldSpec with_step_divided(WorldSpec spec, double by) {
  spec.solver.timestep_s /= by;
  return spec;
}

std::optional<WorldSpec> with_other_engine(WorldSpec spec) {
  spec.engine = spec.engine == EngineKind::kOde ? EngineKind::kMujoco : EngineKind::kOde;
  if (!has_engine(spec.engine)) return std::nullopt;
  if (!check_world(spec).empty()) return std::nullopt;
  return spec;
}

}  // namespace

std::string solver_loss_words(const std::string& body, double margin,
                              const std::vector<SolverRepetition>& repetitions) {
  std::vector<std::string> keep, lose;
  for (const auto& one : repetitions) {
    if (one.answer == SolverAnswer::kKeepsIt) keep.push_back(one.with);
    if (one.answer == SolverAnswer::kLosesIt) lose.push_back(one.with);
  }
  if (keep.empty()) return {};
  auto words = fmt::format(
      "{}: `{}` left a grip that by Coulomb's law holds {:.1f} times what it has to; with {} it "
      "stays",
      kOfTheSolver, body, margin, base::listed(keep));
  if (!lose.empty()) words += fmt::format(", with {} it leaves as well", base::listed(lose));
  return words;
}

std::vector<RepetitionWorld> repetition_worlds(const WorldSpec& spec) {
  std::vector<RepetitionWorld> worlds = {
      {"half the step", with_step_divided(spec, 2.0)},
      {"a quarter of the step", with_step_divided(spec, 4.0)},
  };
  if (auto other = with_other_engine(spec)) {
    const std::string name(to_string(other->engine));
    worlds.push_back({name, *std::move(other)});
  }
  return worlds;
}

GuardedSimulator::GuardedSimulator(const WorldSpec& spec, FindWorlds find)
    : spec_(spec), find_(find), usual_(spec) {}
GuardedSimulator::~GuardedSimulator() = default;

SimulatorInfo GuardedSimulator::info() { return usual_.info(); }

Outcome GuardedSimulator::reset(const State& initial, std::uint64_t seed) {
  initial_ = initial;
  seed_ = seed;
  acts_.clear();
  lost_.clear();
  repetitions_.clear();
  return usual_.reset(initial, seed);
}

SolverAnswer GuardedSimulator::ask(Variant& variant, const GripLoss& loss) {
  if (!variant.simulator) variant.simulator = std::make_unique<OdeSimulator>(variant.world.spec);
  auto& simulator = *variant.simulator;
  if (simulator.reset(initial_, seed_).status != SimStatus::kOk) return SolverAnswer::kNone;
  for (const Act& act : acts_) {
    const auto status = simulator.act(act.action, act.arguments, act.sim_time_limit_s).status;
    if (status == SimStatus::kLost || status == SimStatus::kUnsupported) return SolverAnswer::kNone;
  }
  switch (simulator.grips().state(loss.gripper, loss.body)) {
    case GripState::kNever:
      return SolverAnswer::kNone;  // it came to no grip there
    case GripState::kLost:
      return SolverAnswer::kLosesIt;
    case GripState::kInGrip:
    case GripState::kLetGo:
      break;
  }
  return SolverAnswer::kKeepsIt;
}

Outcome GuardedSimulator::act(std::string_view action, const State& arguments,
                              double sim_time_limit_s) {
  if (!lost_.empty()) return {SimStatus::kLost, lost_, 0.0, {}};
  auto outcome = usual_.act(action, arguments, sim_time_limit_s);
  if (outcome.status == SimStatus::kLost || outcome.status == SimStatus::kUnsupported) {
    return outcome;
  }
  acts_.push_back({std::string(action), arguments, sim_time_limit_s});
  for (const GripLoss& loss : usual_.grips().losses()) {
    if (loss.margin <= kSureMargin) continue;
    if (!variants_) {
      auto& variants = variants_.emplace();
      for (auto& world : find_(spec_)) variants.push_back({std::move(world), nullptr});
    }
    repetitions_.clear();
    for (Variant& variant : *variants_) {
      repetitions_.push_back({variant.world.with, ask(variant, loss)});
      if (repetitions_.back().answer == SolverAnswer::kKeepsIt) break;
    }
    const std::string& body = usual_.world().layout().bodies[loss.body].name;
    lost_ = solver_loss_words(body, loss.margin, repetitions_);
    if (lost_.empty()) continue;
    outcome.status = SimStatus::kLost;
    outcome.reason = lost_;
    outcome.margins.clear();
    outcome.object.clear();
    return outcome;
  }
  return outcome;
}

}  // namespace parallax::harness
