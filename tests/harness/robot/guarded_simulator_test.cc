#include "harness/robot/guarded_simulator.h"

#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tests/harness/world/fetch_world.h"

// A post strikes the carried box out of a grip that holds it several times over. The repetitions
// are given the post or its absence, as a solver that makes up a loss would be alone with it.

namespace parallax::harness {
namespace {

constexpr double kLimit_s = 60.0;

WorldSpec world_with_post() {
  WorldSpec spec = fetch_world();
  BodySpec post;
  post.name = "post";
  post.material = "steel";
  post.p_WB = {1.0, 0.0, 0.1075};
  post.shapes = {BodyShape{{0.02, 0.05, 0.215}}};
  spec.bodies.push_back(post);
  return spec;
}

std::vector<RepetitionWorld> without_post(const WorldSpec& spec) {
  WorldSpec half = spec;
  half.solver.timestep_s /= 2.0;
  return {{"half the step", half}, {"a quarter of the step", fetch_world()}, {"none", spec}};
}

/// Picks the box up and drives past the place of the post.
Outcome carry(Simulator& simulator) {
  REQUIRE(simulator.reset({{"robot.x", 1.5}, {"box.x", 1.7}}, 1).status == SimStatus::kOk);
  const auto picked = simulator.act("picking-up", {{"object", std::string("box")}}, kLimit_s);
  REQUIRE(picked.status == SimStatus::kOk);
  return simulator.act("going", {{"target.x", 0.1}}, kLimit_s);
}

TEST_CASE("a load that leaves a sure grip is noticed, with its margin") {
  OdeSimulator simulator(world_with_post());
  CHECK(carry(simulator).status == SimStatus::kOk);
  CHECK_FALSE(flag(simulator.observe(), "box.held"));
  const auto& losses = simulator.grips().losses();
  REQUIRE(losses.size() == 1);
  // 2 x 0.6 x 20 N over 0.3 kg that weigh 2.9 N and are driven.
  CHECK(losses[0].margin > 6.0);
  CHECK(losses[0].margin < 8.2);
}

TEST_CASE("no grip is lost on a free way, nor by letting go") {
  OdeSimulator simulator(fetch_world());
  CHECK(carry(simulator).status == SimStatus::kOk);
  CHECK(simulator.grips().losses().empty());
  CHECK(simulator.act("placing", {{"target.x", 0.1}}, kLimit_s).status == SimStatus::kOk);
  CHECK(simulator.grips().losses().empty());
  const auto box = *simulator.world().layout().find_body("box");
  CHECK(simulator.grips().state(0, box) == GripState::kLetGo);
}

TEST_CASE("a loss that every repetition shows stands") {
  GuardedSimulator simulator(world_with_post());
  CHECK(carry(simulator).status == SimStatus::kOk);
  CHECK_FALSE(flag(simulator.observe(), "box.held"));
  REQUIRE(simulator.repetitions().size() >= 2);
  CHECK(simulator.repetitions()[0].with == "half the step");
  CHECK(simulator.repetitions()[1].with == "a quarter of the step");
  for (const auto& one : simulator.repetitions()) CHECK(one.answer == SolverAnswer::kLosesIt);
}

TEST_CASE("a loss that a repetition does not show makes the simulation a lost one") {
  GuardedSimulator simulator(world_with_post(), without_post);
  const auto outcome = carry(simulator);
  CHECK(outcome.status == SimStatus::kLost);
  CHECK(outcome.reason.starts_with(kOfTheSolver));
  CHECK(outcome.reason.find("`box`") != std::string::npos);
  CHECK(outcome.reason.find("with a quarter of the step it stays") != std::string::npos);
  CHECK(outcome.reason.find("with half the step it leaves as well") != std::string::npos);
  CHECK(simulator.repetitions().size() == 2);  // the first that keeps it is enough
  // Nothing goes on, until the next reset.
  CHECK(simulator.act("going", {{"target.x", 0.2}}, kLimit_s).reason == outcome.reason);
  CHECK(carry(simulator).reason == outcome.reason);  // the same bytes each time
}

TEST_CASE("what Coulomb's law does not hold by twice is lost without repetitions") {
  WorldSpec spec = world_with_post();
  for (auto& body : spec.bodies) {
    if (body.name == "box") body.mass_kg = 1.25;  // 1.9 times at rest
  }
  GuardedSimulator simulator(spec, without_post);
  CHECK(carry(simulator).status == SimStatus::kOk);
  CHECK_FALSE(flag(simulator.observe(), "box.held"));
  CHECK(simulator.repetitions().empty());
}

}  // namespace
}  // namespace parallax::harness
