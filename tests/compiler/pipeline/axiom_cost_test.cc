#include <limits>

#include "compiler/cnf/encoder.h"
#include "compiler/ground/expansion_size.h"
#include "compiler/ground/grounder.h"
#include "compiler/pipeline/compile_report.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::AxiomCost;

struct Costs {
  CheckedText checked;
  compiler::CompiledModel compiled;
  std::vector<AxiomCost> costs;

  explicit Costs(const std::string& text) : checked(text) {
    REQUIRE_MESSAGE(checked.model, checked.text());
    auto ground = compiler::ground_model(*checked.model, {}, checked.sink);
    REQUIRE_MESSAGE(ground, checked.text());
    compiled = compiler::encode(*ground);
    costs = compiler::axiom_costs(*ground, compiled);
  }
  const AxiomCost* at_line(std::size_t line, const std::string& what) const {
    for (const auto& cost : costs) {
      const auto begin = checked.files[cost.source.file].position(cost.source.begin);
      if (begin.line == line && cost.what == what) return &cost;
    }
    return nullptr;
  }
};

}  // namespace

TEST_CASE("an axiom's cost is its full expansion, what was looked at, and its clauses") {
  const Costs model(
      "sort n: integer\nfluent F(n)\nevent E(n)\n"
      "[n,time] Initiates(E(n),F(n),time).\n"
      "[n1,n2,time] HoldsAt(F(n1),time) & HoldsAt(F(n2),time) -> n1=n2.\n"
      "range n 1 5\nrange time 0 3\n");
  const auto* effect = model.at_line(4, "effect axiom");
  REQUIRE(effect != nullptr);
  CHECK(effect->product == 5 * 4);
  CHECK(effect->instances > 0);
  CHECK(effect->clauses == 5 * 3);  // DEC9 at each of three steps
  CHECK(effect->literals == 2 * 5 * 3);
  const auto* axiom = model.at_line(5, "axiom");
  REQUIRE(axiom != nullptr);
  CHECK(axiom->product == 3 * 5 * 5 * 4);  // two atoms and a comparison
  CHECK(axiom->clauses == 10 * 4);         // ten pairs at each of four timepoints
}

TEST_CASE("the clauses of all costs are the clauses of the model") {
  const Costs model(
      "sort n: integer\nfluent F(n)\nevent E(n)\n[n,time] Initiates(E(n),F(n),time).\n"
      "[n,time] Terminates(E(n),F(n),time).\n[n] !HoldsAt(F(n),0).\nHappens(E(2),1).\n"
      "completion Happens\nrange n 1 3\nrange time 0 4\n");
  std::size_t clauses = 0;
  for (const auto& cost : model.costs) clauses += cost.clauses;
  CHECK(clauses == model.compiled.clauses.size());
}

TEST_CASE("a product beyond 64 bits stays at the greatest number") {
  CheckedText checked(
      "sort n: integer\npredicate P(n,n,n,n,n)\n"
      "[n1,n2,n3,n4,n5] P(n1,n2,n3,n4,n5).\nrange n 1 100000\nrange time 0 0\n");
  REQUIRE(checked.model);
  compiler::GroundTermStore terms;
  const auto universe = compiler::Universe::make(*checked.model, {}, terms, checked.sink);
  REQUIRE(universe);
  CHECK(compiler::expansion_size(*checked.model, *universe, checked.model->axioms[0].formula) ==
        std::numeric_limits<std::uint64_t>::max());
}

}  // namespace parallax::test
