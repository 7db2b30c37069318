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

}  // namespace
}  // namespace parallax::tools
