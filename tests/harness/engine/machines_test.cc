// The machines of docs/physics.md in every engine: what they are off at one step, and at a quarter.

#include "tools/bench/engines/machines.h"

#include <doctest/doctest.h>

#include "tests/harness/engine/engines.h"

namespace parallax::harness {
namespace {

TEST_CASE("machines move as mechanics says in every engine, the closer the shorter the step") {
  constexpr double kRounding = 1e-9;
  REQUIRE(tools::machines().size() == 5);
  for (const EngineKind engine : engines()) {
    for (const auto& machine : tools::machines()) {
      CAPTURE(to_string(engine));
      CAPTURE(machine.name);
      const double error = machine.error(engine, 0.002), at_a_quarter = machine.error(engine, 5e-4);
      CHECK(error < machine.bound);
      // Of first order it is a quarter.
      CHECK((at_a_quarter < 0.5 * error || at_a_quarter < kRounding));
    }
  }
}

}  // namespace
}  // namespace parallax::harness
