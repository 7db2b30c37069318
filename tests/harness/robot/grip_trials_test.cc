#include "tools/bench/engines/grip_trials.h"

#include <doctest/doctest.h>

#include <string>

// Loads that Coulomb's law holds with a margin are lifted and driven, and must stay in the hand.
// The whole table of them is a program, parallax_grip_table.

namespace parallax::tools {
namespace {

harness::SolverSpec usual_solver() {
  harness::SolverSpec solver;
  solver.max_contacts_per_pair = 4;
  return solver;
}

void check_held(const GripCell& cell, std::uint64_t seed) {
  const GripTrial trial = try_grip(cell, seed, usual_solver());
  CAPTURE(std::string(to_string(cell.form)));
  CAPTURE(cell.margin);
  CAPTURE(seed);
  CHECK_FALSE(trial.lost);
  CHECK(trial.slip_m < kGripSlip_m);
}

TEST_CASE("a load that is gripped with twice the force it needs stays in the hand") {
  for (const GripForm form : kGripForms) check_held({form, 2.0, 0.002}, 2);
}

TEST_CASE("a ring stays in the hand although the contact solver gives up some steps") {
  const GripTrial trial = try_grip({GripForm::kRing, 5.0, 0.002}, 4, usual_solver());
  CHECK(trial.solved_again > 0);
  CHECK_FALSE(trial.lost);
  CHECK(trial.slip_m < kGripSlip_m);
}

bool slips(const GripCell& cell, std::uint64_t seed) {
  const GripTrial trial = try_grip(cell, seed);
  return trial.lost || trial.slip_m > kGripSlip_m;
}

TEST_CASE("boxes gripped with little margin slip in ODE at every step alike") {
  int slipped = 0;
  constexpr int kSeeds = 6;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    CAPTURE(seed);
    const bool at_4_ms = slips({GripForm::kBox, 1.2, 0.004}, seed);
    for (const double step_s : {0.002, 0.001, 0.0005}) {
      CAPTURE(step_s);
      CHECK(slips({GripForm::kBox, 1.2, step_s}, seed) == at_4_ms);
    }
    slipped += at_4_ms ? 1 : 0;
  }
  CHECK(slipped > 0);
  CHECK(slipped < kSeeds);
}

TEST_CASE("boxes gripped with little margin stay in ODE where their sides are along the pads") {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    CAPTURE(seed);
    CHECK_FALSE(slips({GripForm::kBox, 1.2, 0.004, harness::EngineKind::kOde, true}, seed));
  }
}

}  // namespace
}  // namespace parallax::tools
