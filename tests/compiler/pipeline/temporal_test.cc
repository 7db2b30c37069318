// Temporal formulas as properties and as state constraints, compared on every trace of a small
// model with the test's own evaluator.

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "compiler/pipeline/compile.h"
#include "compiler/reference/temporal_truth.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "tests/support/checked_traces.h"
#include "tests/support/random_temporal.h"

namespace parallax::test {
namespace {

using compiler::Valuation;

constexpr int kHorizon = 3;

struct Compiled {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::optional<compiler::Compilation> result;

  /// `formula` empty: the model alone.
  Compiled(const std::string& model, int horizon, const std::string& formula = {},
           bool property = false) {
    compiler::CompileInput input;
    input.text = files.add("model.e", model);
    input.horizon = horizon;
    if (!formula.empty()) {
      const auto file = files.add("--property", formula);
      const base::SourceRange range{file, 0, static_cast<std::uint32_t>(formula.size())};
      input.constraints = {{range, range, property}};
      input.hits_at_start = true;
    }
    auto compiled = compiler::compile_model(input, files, sink);
    if (compiled) result = *std::move(compiled);
  }
};

/// The beginnings, up to a timepoint, of the traces up to the horizon.
std::vector<Valuation> all_traces(const std::string& model, int length) {
  const Compiled compiled(model, kHorizon);
  REQUIRE(compiled.result);
  std::vector<Valuation> out;
  std::set<std::string> seen;
  runtime::SolverSession session(compiled.result->model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  while (const auto trace = enumerator.next()) {
    auto valuation = tools::valuation_of(*trace);
    for (auto* part : {&valuation.holds, &valuation.happens, &valuation.released}) {
      part->resize(static_cast<std::size_t>(length) + 1);
    }
    valuation.happens.back().clear();
    if (seen.insert(signature(valuation)).second) out.push_back(std::move(valuation));
  }
  return out;
}

bool is_prefix(const Valuation& shorter, const Valuation& longer) {
  const auto n = shorter.holds.size();
  return n <= longer.holds.size() &&
         std::equal(shorter.holds.begin(), shorter.holds.end(), longer.holds.begin()) &&
         std::equal(shorter.happens.begin(), shorter.happens.end() - 1, longer.happens.begin());
}

/// Does the trace fulfil the formula as docs/reference/model_language.md says?
bool fulfils(const TemporalFormula& formula, const Valuation& trace) {
  const int last = static_cast<int>(trace.holds.size()) - 1;
  return formula.value(trace, formula.looks_on() ? 0 : last).value_or(false);
}

/// Is a property false of the complete trace?
bool violates(const TemporalFormula& formula, const Valuation& trace) {
  const int last = static_cast<int>(trace.holds.size()) - 1;
  for (int t = 0; t <= (formula.looks_on() ? 0 : last); ++t) {
    if (!formula.value(trace, t).value_or(true)) return true;
  }
  return false;
}

/// A formula that is temporal at all.
TemporalFormula temporal_formula(FuzzRandom& random) {
  for (;;) {
    auto formula = random_temporal(random, 1 + static_cast<int>(random.below(4)));
    if (formula.looks_on() || formula.looks_back()) return formula;
  }
}

bool nests_later(const TemporalFormula& formula) {
  static const std::vector<std::string> kLater = {"always", "eventually", "next", "weak_next",
                                                  "until"};
  const bool later = std::find(kLater.begin(), kLater.end(), formula.op) != kLater.end();
  return std::any_of(formula.parts.begin(), formula.parts.end(),
                     [&](const auto& part) { return later ? part.looks_on() : nests_later(part); });
}

/// Operators about later timepoints within each other.
TemporalFormula nested_formula(FuzzRandom& random) {
  for (;;) {
    auto formula = random_temporal(random, 2 + static_cast<int>(random.below(3)));
    if (nests_later(formula)) return formula;
  }
}

TEST_CASE("a property is violated where some trace is, and the trace that is given violates it") {
  FuzzRandom random(22);
  int violated = 0, held = 0, early = 0;
  for (int round = 0; round < 25; ++round) {
    const auto model = random_temporal_model(random);
    CAPTURE(model);
    const auto traces = all_traces(model, kHorizon);
    if (traces.empty()) continue;
    for (int i = 0; i < 12; ++i) {
      const auto formula = temporal_formula(random);
      const auto text = formula.print();
      CAPTURE(text);
      const Compiled compiled(model, kHorizon, text, true);
      REQUIRE(compiled.result);
      runtime::SolverSession session(compiled.result->model, runtime::make_cadical_solver());
      runtime::PlanEnumerator enumerator(session, {.order = runtime::TraceOrder::kAny});
      const auto found = enumerator.next();
      const bool expected = std::any_of(traces.begin(), traces.end(), [&](const Valuation& trace) {
        return violates(formula, trace);
      });
      REQUIRE(found.has_value() == expected);
      if (!found) {
        CHECK(enumerator.exploration() != runtime::Exploration::kStopped);
        ++held;
        continue;
      }
      ++violated;
      const auto valuation = tools::valuation_of(*found);
      CHECK(violates(formula, valuation));
      if (found->length() < kHorizon) ++early;
      // However it goes on.
      int extensions = 0;
      for (const auto& trace : traces) {
        if (!is_prefix(valuation, trace)) continue;
        ++extensions;
        CHECK(violates(formula, trace));
      }
      CHECK(extensions > 0);
    }
  }
  CHECK(violated > 50);
  CHECK(held > 30);
  CHECK(early > 20);
}

/// Has some valuation of the clauses up to this length no trace that begins like it?
bool has_dead_end(const std::string& model, int length) {
  const Compiled compiled(model, kHorizon);
  REQUIRE(compiled.result);
  const auto& clauses = compiled.result->model;
  std::set<std::string> live;
  for (const auto& trace : all_traces(model, length)) live.insert(signature(trace));
  runtime::SolverSession session(clauses, runtime::make_cadical_solver());
  while (session.solve(length, {}) == runtime::SolveStatus::kSatisfiable) {
    const auto prefix =
        runtime::decode_trace(clauses, runtime::symbols_of(clauses), length,
                              [&](compiler::Literal literal) { return session.value(literal); });
    if (!live.contains(signature(tools::valuation_of(prefix)))) return true;
    std::vector<compiler::Literal> other;
    clauses.for_each_atom([&](const compiler::AtomRef& atom) {
      if (atom.needed_horizon(kHorizon) > length && length < kHorizon) return;
      other.push_back(session.value(atom.literal()) ? ~atom.literal() : atom.literal());
    });
    session.add_clause(other);
  }
  return false;
}

TEST_CASE("state properties and goals are answered for traces that reach the horizon") {
  FuzzRandom random(41);
  int violated = 0, held = 0, dead = 0, goals = 0, told = 0;
  for (int round = 0; round < 500; ++round) {
    const auto model = random_temporal_model(random);
    CAPTURE(model);
    const auto traces = all_traces(model, kHorizon);
    auto formula = random_temporal(random, 1);
    while (formula.looks_on() || formula.looks_back()) formula = random_temporal(random, 1);
    const auto text = formula.print();
    if (text.find("Happens") != std::string::npos) continue;
    CAPTURE(text);
    std::optional<int> breaks, meets;
    for (int n = kHorizon; n >= 0; --n) {
      for (const auto& trace : traces) {
        if (!formula.value(trace, n).value_or(true)) breaks = n;
        if (formula.value(trace, n).value_or(false)) meets = n;
      }
    }
    const auto length = [&](const std::string& asked, bool property) {
      const Compiled compiled(model, kHorizon, asked, property);
      REQUIRE(compiled.result);
      runtime::SolverSession session(compiled.result->model, runtime::make_cadical_solver());
      runtime::PlanEnumerator enumerator(session);
      const auto found = enumerator.next();
      const auto dead_end = enumerator.dead_end();
      if (dead_end) {
        ++told;
        CHECK(has_dead_end(model, *dead_end));
      }
      return found ? std::optional<int>(found->length()) : std::nullopt;
    };
    CHECK(length(text, true) == breaks);
    CHECK(length("always (" + text + ")", true) == breaks);
    CHECK(length(text, false) == meets);
    CHECK(length("eventually (" + text + ")", false) == meets);
    ++(breaks ? violated : held);
    if (meets) ++goals;
    if (has_dead_end(model, 0)) ++dead;
  }
  CHECK(violated > 20);
  CHECK(held > 20);
  CHECK(goals > 20);
  CHECK(dead > 20);
  CHECK(told > 5);
}

TEST_CASE("a property that only looks back breaks at the first timepoint at which it can") {
  FuzzRandom random(7);
  for (int round = 0; round < 60; ++round) {
    const auto model = random_temporal_model(random);
    auto formula = random_temporal(random, 3);
    if (formula.looks_on() || !formula.looks_back()) continue;
    const auto text = formula.print();
    if (text.find("Happens") != std::string::npos) continue;  // known one timepoint later
    CAPTURE(model);
    CAPTURE(text);
    std::optional<int> first;
    const auto traces = all_traces(model, kHorizon);
    for (int n = 0; n <= kHorizon && !first; ++n) {
      for (const auto& trace : traces) {
        if (!formula.value(trace, n).value_or(true)) first = n;
      }
    }
    const Compiled compiled(model, kHorizon, text, true);
    REQUIRE(compiled.result);
    runtime::SolverSession session(compiled.result->model, runtime::make_cadical_solver());
    const auto found = runtime::PlanEnumerator(session).next();
    REQUIRE(found.has_value() == first.has_value());
    if (found) CHECK(found->length() == *first);
  }
}

TEST_CASE("traces end where a temporal constraint holds for the first time") {
  FuzzRandom random(5);
  int listed = 0;
  for (int round = 0; round < 16; ++round) {
    const auto model = random_temporal_model(random);
    CAPTURE(model);
    std::vector<std::vector<Valuation>> by_length;
    for (int n = 0; n <= kHorizon; ++n) by_length.push_back(all_traces(model, n));
    for (int i = 0; i < 16; ++i) {
      const auto formula = i < 6 ? temporal_formula(random) : nested_formula(random);
      const auto text = formula.print();
      CAPTURE(text);
      const Compiled compiled(model, kHorizon, text);
      if (compiled.sink.has_errors()) {
        // It says nothing at any timepoint.
        for (const auto& traces : by_length) {
          for (const auto& trace : traces) CHECK(!fulfils(formula, trace));
        }
        continue;
      }
      std::set<std::string> expected;
      std::vector<Valuation> ended;
      for (const auto& traces : by_length) {
        std::vector<Valuation> here;
        for (const auto& trace : traces) {
          const bool before = std::any_of(ended.begin(), ended.end(), [&](const auto& shorter) {
            return is_prefix(shorter, trace);
          });
          if (before || !fulfils(formula, trace)) continue;
          expected.insert(signature(trace));
          here.push_back(trace);
        }
        ended.insert(ended.end(), here.begin(), here.end());
      }
      std::set<std::string> got;
      runtime::SolverSession session(compiled.result->model, runtime::make_cadical_solver());
      runtime::PlanEnumerator enumerator(session, {.split_initial = true});
      while (const auto trace = enumerator.next()) {
        got.insert(signature(tools::valuation_of(*trace)));
      }
      CHECK(got == expected);
      listed += static_cast<int>(got.size());
    }
  }
  CHECK(listed > 500);
}

TEST_CASE("the reference evaluator works temporal formulas out as the test does") {
  FuzzRandom random(3);
  int compared = 0;
  for (int round = 0; round < 20; ++round) {
    const auto model = random_temporal_model(random);
    const int length = static_cast<int>(random.below(kHorizon + 1));
    auto traces = all_traces(model, length);
    traces.resize(std::min<std::size_t>(traces.size(), 20));
    for (int i = 0; i < 20; ++i) {
      const auto formula = temporal_formula(random);
      const auto text = formula.print();
      CAPTURE(text);
      const Compiled compiled(model, kHorizon, text, true);
      REQUIRE(compiled.result);
      const auto& checked = compiled.result->constraints.front().formula;
      compiler::TemporalTruth truth(*compiled.result->typed);
      for (const auto& trace : traces) {
        const auto values = truth.values(checked.formula, checked.time, trace);
        for (int t = 0; t <= length; ++t) {
          CHECK(values[static_cast<std::size_t>(t)] == formula.value(trace, t));
          ++compared;
        }
        const auto broken = std::find(values.begin(), values.end(), std::optional(false));
        if (broken == values.end()) continue;
        const auto why =
            truth.why_false(checked.formula, broken - values.begin(), checked.time, trace);
        CHECK(why.at >= 0);
        CHECK(why.at <= length);
        CHECK(!why.text.empty());
      }
    }
  }
  CHECK(compared > 5000);
}

TEST_CASE("the encoding grows with the horizon, not with its square") {
  const std::string model = "fluent F()\nfluent G()\nevent E()\n[time] Initiates(E(),F(),time).\n";
  const auto clauses = [&](int horizon, const std::string& property) {
    const Compiled compiled(model, horizon, property, true);
    REQUIRE(compiled.result);
    return static_cast<double>(compiled.result->model.clauses.size());
  };
  for (const std::string property :
       {"always (HoldsAt(F(),time) -> eventually HoldsAt(G(),time))",
        "always (HoldsAt(F(),time) -> next (HoldsAt(F(),time) until HoldsAt(G(),time)))",
        "always (HoldsAt(G(),time) -> HoldsAt(F(),time) since Happens(E(),time-1))"}) {
    CAPTURE(property);
    const auto small = clauses(50, property), large = clauses(200, property);
    CHECK(large < 4.5 * small);
  }
}

TEST_CASE("constraints that nest operators grow with the horizon") {
  const std::string model =
      "sort thing\nthing A, B, C\nfluent F(thing)\nfluent G(thing)\nevent E()\n"
      "[time] Initiates(E(),F(A),time).\n";
  const auto clauses = [&](int horizon, const std::string& goal) {
    const Compiled compiled(model, horizon, goal);
    REQUIRE(compiled.result);
    return static_cast<double>(compiled.result->model.clauses.size());
  };
  for (const std::string goal :
       {"always (HoldsAt(F(A),time) -> eventually HoldsAt(G(A),time))",
        "eventually (HoldsAt(F(A),time) & next (HoldsAt(F(B),time) until HoldsAt(G(A),time)))",
        "[thing] always (HoldsAt(F(thing),time) -> next eventually HoldsAt(G(thing),time))",
        "always (once HoldsAt(F(A),time) -> HoldsAt(F(B),time) until always HoldsAt(G(A),time))"}) {
    CAPTURE(goal);
    const auto small = clauses(100, goal), middle = clauses(200, goal), large = clauses(400, goal);
    CAPTURE(small);
    CAPTURE(middle);
    CAPTURE(large);
    CHECK(large - middle < 2.02 * (middle - small));
  }
}

}  // namespace
}  // namespace parallax::test
