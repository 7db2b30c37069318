// Instances that are left out because an event and a fluent never meet, and exclusions by blocks.

#include "compiler/ground/meetings.h"

#include <doctest/doctest.h>

#include <limits>

#include "compiler/cnf/encoder.h"
#include "compiler/ground/at_most_one.h"
#include "compiler/ground/grounder.h"
#include "runtime/enumerate/model_enumerator.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

using compiler::CompiledModel;
using compiler::FormulaId;

/// Two robots on a row of four cells; none pass through each other.
const std::string kRow =
    "range time 0 3\nsort robot\nrobot A, B\nsort cell: integer\nrange cell 1 4\n"
    "predicate Near(cell,cell)\nfluent At(robot,cell)\nevent Move(robot,cell)\n"
    "[cell1,cell2] Near(cell1,cell2) <-> (cell2=cell1+1 | cell1=cell2+1).\n"
    "[robot,cell,time] Initiates(Move(robot,cell),At(robot,cell),time).\n"
    "[robot,cell1,cell2,time] HoldsAt(At(robot,cell1),time) & cell1!=cell2 ->\n"
    "  Terminates(Move(robot,cell2),At(robot,cell1),time).\n"
    "[robot,cell,time] Happens(Move(robot,cell),time) ->\n"
    "  ({cell1} HoldsAt(At(robot,cell1),time) & Near(cell1,cell)).\n"
    "[robot,cell1,cell2,time]\n"
    "Happens(Move(robot,cell1),time) & Happens(Move(robot,cell2),time) -> cell1=cell2.\n";
const std::string kCollisions =
    "[robot1,robot2,cell,time]\n"
    "HoldsAt(At(robot1,cell),time) & HoldsAt(At(robot2,cell),time) -> robot1=robot2.\n"
    "[robot1,robot2,cell1,cell2,time]\n"
    "Happens(Move(robot1,cell2),time) & HoldsAt(At(robot1,cell1),time) &\n"
    "Happens(Move(robot2,cell1),time) & HoldsAt(At(robot2,cell2),time) -> robot1=robot2.\n";
const std::string kRowStart =
    "[cell] HoldsAt(At(A,cell),0) <-> cell=1.\n[cell] HoldsAt(At(B,cell),0) <-> cell=3.\n";

CompiledModel grounded(const std::string& text, std::size_t keep, std::size_t clique = 3) {
  CheckedText checked(text);
  REQUIRE_MESSAGE(checked.model, checked.text());
  compiler::GroundOptions options;
  options.keep_meetings = keep;
  options.least_clique = clique;
  auto ground = compiler::ground_model(*checked.model, options, checked.sink);
  REQUIRE_MESSAGE(ground, checked.text());
  return compiler::encode(*ground);
}

constexpr auto kAll = std::numeric_limits<std::size_t>::max();

std::vector<std::string> traces_in(const CompiledModel& model) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::vector<std::string> traces;
  while (const auto trace = enumerator.next()) traces.push_back(runtime::to_text(*trace));
  return traces;
}

/// Clauses of the first copy that speak of so many literals or more.
std::size_t wide_clauses(const CompiledModel& model, std::size_t least) {
  std::size_t count = 0;
  for (const auto& section : model.sections) {
    for (auto i = section.begin; i < section.begin + section.clauses; ++i) {
      if (section.repeated && model.clauses[i].size() >= least) ++count;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("a robot that moves stands beside its goal: other instances are left out") {
  const auto text = kRow + kCollisions + kRowStart;
  const auto all = grounded(text, kAll), few = grounded(text, 0);
  CHECK(few.clauses.size() < all.clauses.size() * 2 / 3);
  // A and B change places: 3 pairs of neighbours, either way round. Else each pair of cells.
  CHECK(wide_clauses(few, 4) < wide_clauses(all, 4));
  const auto expected = traces_in(all);
  CHECK(expected.size() > 10);
  CHECK(traces_in(few) == expected);
}

TEST_CASE("without a stated start nothing is known of where a robot is not") {
  const auto text = kRow + kCollisions + "HoldsAt(At(A,1),0).\n";
  CHECK(traces_in(grounded(text, 0)) == traces_in(grounded(text, kAll)));
}

TEST_CASE("effects that axioms speak of keep their conditions") {
  const auto text = kRow + kRowStart +
                    "fluent Far(robot)\n[robot] !HoldsAt(Far(robot),0).\n"
                    "[robot,cell1,cell2,time] Terminates(Move(robot,cell1),At(robot,cell2),time) & "
                    "cell2>cell1+1 & HoldsAt(Far(robot),time) -> Happens(Move(robot,1),time).\n"
                    "[robot,cell,time] cell>2 -> Initiates(Move(robot,cell),Far(robot),time).\n";
  const auto expected = traces_in(grounded(text, kAll));
  CHECK(expected.size() > 3);
  CHECK(traces_in(grounded(text, 0)) == expected);
}

TEST_CASE("at most one of many, by blocks: true of the same assignments, in fewer clauses") {
  for (const std::size_t size : {1U, 2U, 5U, 9U, 12U}) {
    CAPTURE(size);
    compiler::FormulaStore formulas;
    std::vector<FormulaId> members;
    for (std::size_t i = 0; i < size; ++i) {
      members.push_back(formulas.atom(static_cast<std::int32_t>(i) + 1));
    }
    const auto parts = compiler::at_most_one(members, 3, formulas);
    if (size == 12) CHECK(parts.size() < 12 * 11 / 2);
    const auto all = formulas.conjunction(parts);
    for (unsigned bits = 0; bits < (1U << size); ++bits) {
      const auto value = compiler::evaluate(formulas, all, [&](std::int32_t variable) {
        return (bits >> (static_cast<unsigned>(variable) - 1U) & 1U) != 0 ? compiler::Truth::kTrue
                                                                          : compiler::Truth::kFalse;
      });
      REQUIRE((value == compiler::Truth::kTrue) == ((bits & (bits - 1U)) == 0));
    }
  }
}

TEST_CASE("events of which one happens at a time are joined, and others stay pairs") {
  const auto text =
      kRow + kRowStart +
      "event Ring()\n[cell,time] Happens(Move(A,cell),time) -> !Happens(Ring(),time).\n";
  const auto pairs = grounded(text, 0, kAll), joined = grounded(text, 0, 3);
  CHECK(joined.clauses.size() != pairs.clauses.size());
  CHECK(traces_in(joined) == traces_in(pairs));
  CHECK(traces_in(joined) == traces_in(grounded(text, kAll)));
}

}  // namespace parallax::test
