// The formula that says "these are all traces", for models that are written down clause by clause:
// its models are counted by trying every valuation.

#include <doctest/doctest.h>

#include <sstream>

#include "runtime/certify/certificate.h"

namespace parallax::runtime {
namespace {

using compiler::AtomKind;
using compiler::Literal;

Literal literal(int dimacs) {
  const auto positive = Literal::positive(dimacs < 0 ? -dimacs : dimacs);
  return dimacs < 0 ? ~positive : positive;
}

void add(CompiledModel& model, const std::vector<int>& clause, Timepoint t) {
  std::vector<Literal> literals;
  for (const auto dimacs : clause) literals.push_back(literal(dimacs));
  model.clauses.add(literals);
  model.clause_timepoints.push_back(t);
  model.clause_origins.push_back(0);
  model.clause_is_definition.push_back(false);
}

/// A fluent that an event brings about: variables F0, E0, F1, and E0 -> F1.
CompiledModel button() {
  CompiledModel model;
  model.horizon = 1;
  model.slots = {{AtomKind::kHoldsAt, "F()"}, {AtomKind::kHappens, "E()"}};
  model.state_slots = 1;
  model.fluents = {{"F()", 0}};
  model.release_slots = {std::nullopt};
  model.events = {{"E()", 1}};
  model.origins.push_back({{}, compiler::OriginKind::kEffectAxiom});
  add(model, {-2, 3}, 1);
  return model;
}

using Valuation = std::vector<bool>;  // by variable, from 1

Trace trace_of(const CompiledModel& model, const Valuation& values, Timepoint length) {
  return decode_trace(model, symbols_of(model), length, [&](Literal asked) {
    return values[static_cast<std::size_t>(asked.var())] == asked.is_positive();
  });
}

std::vector<Valuation> models_of(const CompletenessClaim& claim) {
  std::vector<std::vector<Literal>> clauses;
  claim.for_each_clause(
      [&](std::span<const Literal> clause) { clauses.emplace_back(clause.begin(), clause.end()); });
  const auto variables = static_cast<std::size_t>(claim.variables());
  std::vector<Valuation> found;
  for (std::uint64_t bits = 0; bits < (std::uint64_t{1} << variables); ++bits) {
    Valuation values(variables + 1);
    for (std::size_t v = 1; v <= variables; ++v) values[v] = (bits >> (v - 1) & 1U) != 0;
    const auto holds = [&](const std::vector<Literal>& clause) {
      return std::any_of(clause.begin(), clause.end(), [&](Literal one) {
        return values[static_cast<std::size_t>(one.var())] == one.is_positive();
      });
    };
    if (std::all_of(clauses.begin(), clauses.end(), holds)) found.push_back(std::move(values));
  }
  return found;
}

TEST_CASE("each trace that is listed takes one model away, and the whole list all of them") {
  const auto model = button();
  const CompletenessClaim none(model);
  const auto all = models_of(none);
  REQUIRE(all.size() == 6);  // eight valuations, and two in which the event has no effect
  REQUIRE(none.variables() == 3);
  CompletenessClaim claim(model);
  for (std::size_t i = 0; i < all.size(); ++i) {
    claim.add(trace_of(model, all[i], 1));
    const auto left = models_of(claim);
    REQUIRE(left.size() == all.size() - 1 - i);
    CHECK(std::equal(left.begin(), left.end(), all.begin() + static_cast<std::ptrdiff_t>(i) + 1));
  }
  CHECK(claim.traces() == 6);
}

TEST_CASE("a trace that is listed twice leaves as much as once") {
  const auto model = button();
  CompletenessClaim claim(model);
  const auto one = trace_of(model, {false, true, false, false}, 1);
  claim.add(one);
  claim.add(one);
  CHECK(models_of(claim).size() == 5);
}

/// The same with the state constraint "F", from timepoint 1 on: hits are variables 1 and 2, then
/// F0, E0, F1, E1, F2.
CompiledModel button_until_pressed() {
  CompiledModel model;
  model.horizon = 2;
  model.slots = {{AtomKind::kHoldsAt, "F()"}, {AtomKind::kHappens, "E()"}};
  model.state_slots = 1;
  model.fluents = {{"F()", 0}};
  model.release_slots = {std::nullopt};
  model.events = {{"E()", 1}};
  model.fixed = {{AtomKind::kHit, "", 1, {}}, {AtomKind::kHit, "", 2, {}}};
  model.has_constraints = true;
  model.origins.push_back({{}, compiler::OriginKind::kEffectAxiom});
  add(model, {-3}, 0);  // F is false at first, and true exactly where E has happened
  add(model, {-4, 5}, 1);
  add(model, {4, -5, 3}, 1);
  add(model, {-3, 5}, 1);
  add(model, {-6, 7}, 2);
  add(model, {6, -7, 5}, 2);
  add(model, {-5, 7}, 2);
  for (const auto& [hit, fluent, t] : {std::tuple(1, 5, 1), std::tuple(2, 7, 2)}) {
    add(model, {-hit, fluent}, t);
    add(model, {hit, -fluent}, t);
  }
  return model;
}

TEST_CASE("with constraints the traces of every length are claimed, each up to its first hit") {
  const auto model = button_until_pressed();
  // Pressed at once, or only then.
  const auto now = trace_of(model, {false, true, true, false, true, true, false, true}, 1);
  const auto later = trace_of(model, {false, false, true, false, false, false, true, true}, 2);
  const auto count = [&](const std::vector<Trace>& traces, bool up_to_horizon) {
    CompletenessClaim claim(model);
    if (up_to_horizon) claim.limit_to_horizon();
    for (const auto& trace : traces) claim.add(trace);
    return models_of(claim).size();
  };
  CHECK(count({}, true) > 0);
  CHECK(count({now}, true) > 0);
  CHECK(count({later}, true) > 0);
  CHECK(count({now, later}, true) == 0);
  // Also a trace that ends before can go on to the horizon, so the claim is about all of it.
  const CompletenessClaim open(model);
  CHECK(open.given().size() == static_cast<std::size_t>(model.horizon));
}

TEST_CASE("the file has the clauses of the claim, behind a line for every observable atom") {
  const auto model = button();
  CompletenessClaim claim(model);
  claim.add(trace_of(model, {false, false, true, true}, 1));
  std::ostringstream out;
  claim.write_dimacs(out);
  CHECK(out.str() ==
        "c No model: these are all traces of the model up to timepoint 1.\n"
        "c First its 1 clauses, at the end 1 for the traces that were listed.\n"
        "c map 1 HoldsAt(F(),0)\n"
        "c map 2 Happens(E(),0)\n"
        "c map 3 HoldsAt(F(),1)\n"
        "p cnf 3 2\n"
        "-2 3 0\n"
        "1 -2 -3 0\n");
}

}  // namespace
}  // namespace parallax::runtime
