#include <doctest/doctest.h>

#include <set>

#include "runtime/session/solver_session.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

/// The source lines of the core's origins.
std::set<std::uint32_t> core_lines(const TextModel& model) {
  const auto core = runtime::find_unsat_core(model.compiled, model.compiled.horizon,
                                             runtime::make_cadical_solver());
  std::set<std::uint32_t> lines;
  if (core.status != runtime::SolveStatus::kUnsatisfiable) return lines;
  CHECK(core.is_minimal);
  for (const auto index : core.origins) {
    const auto& source = model.compiled.origins[index].source;
    lines.insert(model.files[source.file].position(source.begin).line);
  }
  return lines;
}

TEST_CASE("a satisfiable model has no core") {
  const TextModel model("range time 0 1\nfluent F()\nHoldsAt(F(),0).\n");
  REQUIRE(model.codes() == "");
  CHECK(core_lines(model).empty());
}

TEST_CASE("the core names the axioms that clash and no others") {
  const TextModel model(
      "range time 0 2\nfluent F()\nfluent G()\nevent E()\n"
      "HoldsAt(G(),0).\n"                  // line 5, innocent
      "HoldsAt(F(),0).\n"                  // line 6
      "[time] Initiates(E(),G(),time).\n"  // line 7, innocent
      "!HoldsAt(F(),2).\n");               // line 8
  REQUIRE(model.codes() == "");
  // Inertia of F, declared in line 2, takes part as well.
  CHECK(core_lines(model) == std::set<std::uint32_t>{2, 6, 8});
}

TEST_CASE("the core is minimal: without any one member the rest is satisfiable") {
  const TextModel model(
      "range time 0 1\nfluent F()\nfluent G()\nevent E()\n"
      "HoldsAt(F(),0) | HoldsAt(G(),0).\n!HoldsAt(F(),0).\n!HoldsAt(G(),0).\n"
      "HoldsAt(F(),0) -> HoldsAt(G(),0).\n");
  REQUIRE(model.codes() == "");
  CHECK(core_lines(model) == std::set<std::uint32_t>{5, 6, 7});
}

}  // namespace
}  // namespace parallax::test
