#include "runtime/explain/why.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <set>

#include "runtime/enumerate/model_enumerator.h"
#include "runtime/explain/clause_text.h"
#include "tests/runtime/explain/plain_model.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

using compiler::AtomKind;
using runtime::Literal;
using runtime::WhyKind;
using runtime::WhyStep;

std::vector<std::vector<bool>> valuations(const compiler::CompiledModel& model, std::size_t limit) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::vector<std::vector<bool>> found;
  while (found.size() < limit && enumerator.next()) {
    auto& values = found.emplace_back();
    for (std::int32_t v = 1; v <= model.variable_count(); ++v) {
      values.push_back(session.value(Literal::positive(v)));
    }
  }
  return found;
}

/// The literal of an atom as the valuation has it.
Literal fact(const compiler::CompiledModel& model, const std::vector<bool>& values, AtomKind kind,
             const std::string& name, int time) {
  const auto atom = compiler::AtomIndex(model).find(kind, name, time);
  REQUIRE(atom);
  return values[static_cast<std::size_t>(atom->var()) - 1] ? *atom : ~*atom;
}

const char* word(WhyKind kind) {
  static constexpr const char* kWords[] = {"stated",     "effect", "inertia", "axiom",
                                           "completion", "forced", "chosen",  "undecided"};
  return kWords[static_cast<int>(kind)];
}

/// "stated HoldsAt(F(),0); inertia HoldsAt(F(),2); ..."
std::string told(const PlainModel& model, const std::vector<WhyStep>& steps) {
  const runtime::ClauseText text(model.compiled);
  std::string out;
  for (const auto& step : steps) {
    if (!out.empty()) out += "; ";
    out += std::string(word(step.kind)) + ' ' + text.literal(step.fact);
  }
  return out;
}

constexpr const char* kCup = R"(range time 0 4
fluent Holding()
fluent Filled()
fluent Broken()
event Grasp()
event Pour()
event Drop()
[time] Initiates(Grasp(),Holding(),time).
[time] HoldsAt(Holding(),time) & !HoldsAt(Broken(),time) -> Initiates(Pour(),Filled(),time).
[time] Terminates(Drop(),Filled(),time).
[time] Initiates(Drop(),Broken(),time).
!HoldsAt(Holding(),0).
!HoldsAt(Filled(),0).
!HoldsAt(Broken(),0).
Happens(Grasp(),0).
Happens(Pour(),1).
completion Happens
)";

TEST_CASE("a fact is told from its causes: event, conditions, inertia") {
  const PlainModel model(kCup);
  REQUIRE_FALSE(model.sink.has_errors());
  const auto values = valuations(model.compiled, 2);
  REQUIRE(values.size() == 1);
  const auto asked = fact(model.compiled, values[0], AtomKind::kHoldsAt, "Filled()", 4);
  CHECK(asked.is_positive());
  const auto steps = runtime::explain_fact(model.compiled, 4, values[0], asked);
  CHECK(told(model, steps) ==
        "stated !HoldsAt(Broken(),0); stated Happens(Grasp(),0); effect HoldsAt(Holding(),1); "
        "inertia !HoldsAt(Broken(),1); stated Happens(Pour(),1); effect HoldsAt(Filled(),2); "
        "inertia HoldsAt(Filled(),4)");
  CHECK(steps.back().since == 2);
  REQUIRE(steps.back().absent.size() == 2);
  CHECK(runtime::ClauseText(model.compiled).literal(steps.back().absent[0]) ==
        "!Happens(Drop(),3)");
}

TEST_CASE("a fact that does not hold has a history as well") {
  const PlainModel model(std::string(kCup) + "Happens(Drop(),2).\n");
  REQUIRE_FALSE(model.sink.has_errors());
  const auto values = valuations(model.compiled, 2);
  REQUIRE(values.size() == 1);
  const auto asked = fact(model.compiled, values[0], AtomKind::kHoldsAt, "Filled()", 4);
  CHECK(told(model, runtime::explain_fact(model.compiled, 4, values[0], asked)) ==
        "stated Happens(Drop(),2); effect !HoldsAt(Filled(),3); inertia !HoldsAt(Filled(),4)");
  const auto event = fact(model.compiled, values[0], AtomKind::kHappens, "Drop()", 3);
  CHECK(told(model, runtime::explain_fact(model.compiled, 4, values[0], event)) ==
        "completion !Happens(Drop(),3)");
}

TEST_CASE("behind the value of a released fluent stands its release") {
  const PlainModel model(
      "range time 0 2\nfluent F()\nevent E()\n[time] Releases(E(),F(),time).\nHoldsAt(F(),0).\n"
      "Happens(E(),0).\ncompletion Happens\n");
  REQUIRE_FALSE(model.sink.has_errors());
  const auto values = valuations(model.compiled, 1);
  const auto asked = fact(model.compiled, values[0], AtomKind::kHoldsAt, "F()", 1);
  CHECK(told(model, runtime::explain_fact(model.compiled, 2, values[0], asked)) ==
        "stated Happens(E(),0); effect ReleasedAt(F(),1); chosen !HoldsAt(F(),1)");
}

TEST_CASE("what the model leaves open is a choice, what comes later can take it away") {
  const std::string text =
      "range time 0 1\nfluent F()\nfluent G()\nevent E()\n[time] Terminates(E(),F(),time).\n";
  const PlainModel open(text + "HoldsAt(G(),1).\n");
  auto values = valuations(open.compiled, 10);
  REQUIRE(!values.empty());
  auto asked = fact(open.compiled, values[0], AtomKind::kHoldsAt, "F()", 0);
  CHECK(told(open, runtime::explain_fact(open.compiled, 1, values[0], asked)) ==
        "chosen !HoldsAt(F(),0)");
  asked = fact(open.compiled, values[0], AtomKind::kHoldsAt, "G()", 0);
  CHECK(told(open, runtime::explain_fact(open.compiled, 1, values[0], asked)) ==
        "forced HoldsAt(G(),0)");
}

/// Is the fact implied by the step's axiom and the facts that the step names? A separate solver is
/// asked, which has the definitions, the axiom, and the trace's releases.
bool follows(const compiler::CompiledModel& model, const std::vector<bool>& values,
             const WhyStep& step) {
  const auto solver = runtime::make_cadical_solver();
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    if (model.clause_is_definition[i] || model.clause_origins[i] == *step.origin) {
      solver->add_clause(model.clauses[i]);
    }
  }
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.kind != AtomKind::kReleasedAt) return;
    const auto literal = atom.literal();
    solver->assume(values[static_cast<std::size_t>(atom.variable) - 1] ? literal : ~literal);
  });
  for (const auto premise : step.premises) solver->assume(premise);
  for (const auto premise : step.absent) solver->assume(premise);
  solver->assume(~step.fact);
  return solver->solve() == runtime::SolveStatus::kUnsatisfiable;
}

TEST_CASE("each step of random models follows from its axiom and from facts told before") {
  int chains = 0, steps_seen = 0, inertia = 0, effects = 0;
  for (std::uint64_t seed = 1; seed <= 120; ++seed) {
    const PlainModel model(random_model(seed, kSolverSize).print());
    if (model.sink.has_errors()) continue;
    const auto& compiled = model.compiled;
    for (const auto& values : valuations(compiled, 2)) {
      compiled.for_each_atom([&](const compiler::AtomRef& atom) {
        const bool observable = atom.kind == AtomKind::kHoldsAt || atom.kind == AtomKind::kHappens;
        if (!observable || *atom.time == 0) return;
        const bool is_true = values[static_cast<std::size_t>(atom.variable) - 1];
        const auto asked = is_true ? atom.literal() : ~atom.literal();
        const auto steps = runtime::explain_fact(compiled, compiled.horizon, values, asked);
        ++chains;
        REQUIRE(!steps.empty());
        CHECK(steps.back().fact == asked);
        std::set<std::int32_t> told;
        for (const auto& step : steps) {
          ++steps_seen;
          inertia += step.kind == WhyKind::kInertia ? 1 : 0;
          effects += step.kind == WhyKind::kEffect ? 1 : 0;
          CHECK(values[static_cast<std::size_t>(step.fact.var()) - 1] == step.fact.is_positive());
          for (const auto premise : step.premises) CHECK(told.count(premise.dimacs()) == 1);
          CHECK(told.insert(step.fact.dimacs()).second);
          CAPTURE(seed);
          // Over several timepoints inertia needs more instances than those between two.
          if (step.origin) CHECK(follows(compiled, values, step));
        }
      });
    }
  }
  CHECK(chains > 500);
  CHECK(inertia > 100);
  CHECK(effects > 20);
  CHECK(steps_seen > chains);
}

/// A world in which nothing ends: events can only add facts.
struct GrowingWorld {
  std::string head;
  std::vector<std::string> occurrences;

  explicit GrowingWorld(std::mt19937& random) {
    head = "range time 0 5\n";
    for (int i = 0; i < 5; ++i) {
      const auto n = std::to_string(i);
      head += "fluent F" + n + "()\nevent E" + n + "()\n!HoldsAt(F" + n + "(),0).\n";
    }
    const auto any = [&] { return std::to_string(random() % 5); };
    for (int i = 0; i < 7; ++i) {
      const auto condition = random() % 3 == 0 ? "" : "HoldsAt(F" + any() + "(),time) -> ";
      head += "[time] " + condition + "Initiates(E" + any() + "(),F" + any() + "(),time).\n";
    }
    head += "[time] Initiates(E0(),F0(),time).\ncompletion Happens\n";
    std::set<std::string> lines;
    for (int i = 0; i < 9; ++i) {
      lines.insert("Happens(E" + any() + "()," + any() + ")");
    }
    occurrences.assign(lines.begin(), lines.end());
  }
  std::string without(const std::set<std::string>& left_out) const {
    auto text = head;
    for (const auto& line : occurrences) {
      if (left_out.count(line) == 0) text += line + ".\n";
    }
    return text;
  }
};

/// Is it so in the one trace of the model?
bool is_true(const std::string& text, const std::string& fluent, int time) {
  const PlainModel model(text);
  REQUIRE_FALSE(model.sink.has_errors());
  const auto values = valuations(model.compiled, 2);
  REQUIRE(values.size() == 1);
  return fact(model.compiled, values[0], AtomKind::kHoldsAt, fluent, time).is_positive();
}

/// The occurrences that a chain names.
std::set<std::string> named(const PlainModel& model, const std::vector<WhyStep>& steps) {
  const runtime::ClauseText text(model.compiled);
  std::set<std::string> events;
  for (const auto& step : steps) {
    if (step.kind == WhyKind::kStated && step.fact.is_positive()) {
      events.insert(text.literal(step.fact));
    }
  }
  return events;
}

TEST_CASE("without the causes named a fact is no more, and with them alone it is") {
  std::mt19937 random(23);
  int asked = 0;
  for (int i = 0; i < 40; ++i) {
    const GrowingWorld world(random);
    const PlainModel model(world.without({}));
    REQUIRE_FALSE(model.sink.has_errors());
    const auto values = valuations(model.compiled, 2);
    REQUIRE(values.size() == 1);
    for (const int time : {3, 5}) {
      const auto fluent = "F" + std::to_string(random() % 5) + "()";
      const auto literal = fact(model.compiled, values[0], AtomKind::kHoldsAt, fluent, time);
      if (!literal.is_positive()) continue;
      ++asked;
      const std::set<std::string> all(world.occurrences.begin(), world.occurrences.end());
      const auto chain = named(model, runtime::explain_fact(model.compiled, 5, values[0], literal));
      std::set<std::string> rest;
      std::set_difference(all.begin(), all.end(), chain.begin(), chain.end(),
                          std::inserter(rest, rest.end()));
      CHECK(is_true(world.without(rest), fluent, time));
      runtime::WhyOptions options;
      options.alternatives = true;
      const auto every =
          named(model, runtime::explain_fact(model.compiled, 5, values[0], literal, options));
      CHECK(!every.empty());
      CHECK_FALSE(is_true(world.without(every), fluent, time));
    }
  }
  CHECK(asked > 15);
}

}  // namespace
}  // namespace parallax::test
