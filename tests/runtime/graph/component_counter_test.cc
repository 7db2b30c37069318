#include "runtime/graph/component_counter.h"

#include <doctest/doctest.h>

#include <random>

#include "runtime/graph/component_traces.h"
#include "runtime/graph/model_traces.h"
#include "runtime/graph/trace_count.h"
#include "tests/support/clause_problem.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using compiler::Literal;
using runtime::ComponentCounter;

ComponentCounter made(const ClauseProblem& problem) {
  ComponentCounter counter(problem.variables, problem.projected);
  for (const auto& clause : problem.clauses) counter.add_clause(clause);
  return counter;
}

mpz_class count(const TextModel& model) {
  const runtime::ComponentTraces traces(model.compiled, runtime::Distinct::kObservable, nullptr);
  REQUIRE(traces.total().has_value());
  return *traces.total();
}

mpz_class power(unsigned long base, unsigned long exponent) {
  mpz_class out;
  mpz_ui_pow_ui(out.get_mpz_t(), base, exponent);
  return out;
}

/// Two switches that are pressed or not at every timepoint; `constraints` is the text of further
/// conditions.
std::string switches(int steps, const std::string& constraints) {
  return "sort s\ns A, B\nfluent On(s)\nevent Press(s)\n"
         "[s,time] !HoldsAt(On(s),time) -> Initiates(Press(s),On(s),time).\n"
         "[s,time] HoldsAt(On(s),time) -> Terminates(Press(s),On(s),time).\n"
         "[s] !HoldsAt(On(s),0).\n" +
         constraints + "range time 0 " + std::to_string(steps) + "\n";
}

}  // namespace

TEST_CASE("the counter counts what trying all valuations finds, and finds each by its number") {
  std::mt19937_64 random(3);
  std::size_t valuations = 0, reordered = 0;
  for (int i = 0; i < 2000; ++i) {
    auto problem = random_clauses(random);
    auto counter = made(problem);
    if (i % 2 == 0 && counter.reorder()) ++reordered;
    for (int again = 0; again < 2; ++again) {
      const auto wanted = by_brute_force(problem);
      const auto counted = counter.count(problem.assumptions, {}, nullptr);
      REQUIRE(counted.has_value());
      CHECK(*counted == wanted.size());
      valuations += wanted.size();
      // The second time under no assumptions: the results remembered from the first are still true.
      problem.assumptions.clear();
    }
    std::size_t before = 0;
    for (const auto& valuation : by_brute_force(problem)) {
      const auto values = counter.nth(static_cast<long>(before++), {}, nullptr);
      REQUIRE(values.has_value());
      auto narrowed = problem;
      narrowed.assumptions = *values;
      CHECK(by_brute_force(narrowed) == std::set<Valuation>{valuation});
    }
  }
  CHECK(valuations > 8000);
  CHECK(reordered > 300);
}

TEST_CASE("far-reaching clauses are counted exactly, far beyond 64 bits") {
  // A is pressed at the first timepoint or at the last one: three quarters of 4^200.
  CHECK(count(TextModel(switches(200, "Happens(Press(A),0) | Happens(Press(A),199).\n"))) ==
        3 * power(4, 199));
  // B ends as A began to be after the first step: half of 4^100.
  CHECK(count(TextModel(switches(100, "HoldsAt(On(A),1) <-> HoldsAt(On(B),100).\n"))) ==
        power(4, 100) / 2);
  // Each press of A is followed by one of B eight steps later: of four ways to press A and then B
  // three are left, 32 times; presses in the other steps are free.
  CHECK(count(TextModel(switches(
            40, "[time] time<32 & Happens(Press(A),time) -> Happens(Press(B),time+8).\n"))) ==
        power(3, 32) * power(2, 8) * power(2, 8));
}

TEST_CASE("a clause that ties every step to one far ahead takes another order of variables") {
  const TextModel model(
      switches(60, "[time] time<30 & Happens(Press(A),time) -> Happens(Press(B),time+30).\n"));
  CHECK(count(model) == power(3, 30) * power(2, 30) * power(2, 30));
}

TEST_CASE("beyond its limits the counter says nothing, and it can be stopped") {
  const TextModel model(switches(40, "Happens(Press(A),0) | Happens(Press(A),39).\n"));
  std::vector<Literal> atoms;
  model.compiled.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.kind == compiler::AtomKind::kHappens) atoms.push_back(atom.literal());
  });
  ComponentCounter counter(model.compiled.variable_count(), atoms);
  for (std::size_t c = 0; c < model.compiled.clauses.size(); ++c) {
    counter.add_clause(model.compiled.clauses[c]);
  }
  CHECK_FALSE(counter.count({}, {.steps = 10}, nullptr).has_value());
  CHECK_FALSE(counter.count({}, {.cached = 3}, nullptr).has_value());
  CHECK_FALSE(counter.count({}, {.held = 5}, nullptr).has_value());
  const std::atomic<bool> stop = true;
  CHECK_FALSE(counter.count({}, {}, &stop).has_value());
  const auto counted = counter.count({}, {}, nullptr);
  REQUIRE(counted.has_value());
  CHECK(*counted == 3 * power(4, 39));
}

TEST_CASE("traces of a model whose clauses look far are drawn and gone to by their numbers") {
  const TextModel model(switches(70, "HoldsAt(On(A),1) <-> HoldsAt(On(B),70).\n"));
  runtime::ModelTraces traces(model.compiled, {});
  traces.seek(power(4, 70) / 2 - 2);
  std::string line;
  CHECK(traces.print_next(runtime::jsonl_format(), line));
  CAPTURE(line.substr(0, 200));
  CHECK(line.starts_with("{\"trace\":" + mpz_class(power(4, 70) / 2 - 1).get_str() + ","));
  CHECK_FALSE(traces.exhausted());
  const auto last = traces.next();
  REQUIRE(last.has_value());
  // B was on after 69 presses and is to stay on.
  CHECK(last->points[69].happens.size() == 1);
  CHECK(last->symbols->name(last->points[69].happens.front()) == "Press(A)");
  CHECK_FALSE(traces.next().has_value());
  CHECK(traces.exhausted());
  const auto sample = runtime::sample_traces(model.compiled, {}, 20, 5);
  CHECK(sample.complete);
  CHECK(sample.population == power(4, 70) / 2);
  for (const auto& trace : sample.traces) {
    CHECK(trace.points[1].holds.size() <= 2);
    const auto on = [&](std::size_t t, const std::string& what) {
      for (const auto fluent : trace.points[t].holds) {
        if (trace.symbols->name(fluent) == what) return true;
      }
      return false;
    };
    CHECK(on(1, "On(A)") == on(70, "On(B)"));
  }
}

}  // namespace parallax::test
