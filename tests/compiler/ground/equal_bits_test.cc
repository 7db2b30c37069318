#include "compiler/ground/equal_bits.h"

#include <set>

#include "compiler/cnf/encoder.h"
#include "compiler/ground/grounder.h"
#include "runtime/enumerate/model_enumerator.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

compiler::CompiledModel encoded(const std::string& text, bool invariants) {
  CheckedText checked(text);
  REQUIRE_MESSAGE(checked.model, checked.text());
  compiler::GroundOptions options;
  options.invariants = invariants;
  auto ground = compiler::ground_model(*checked.model, options, checked.sink);
  REQUIRE_MESSAGE(ground, checked.text());
  return compiler::encode(*ground);
}

/// The clauses of two literals that invariants say of timepoint 0: "-released In(Cup,1) Held(Cup)".
std::set<std::string> said_of(const std::string& text) {
  const auto model = encoded(text, true);
  std::set<std::string> found;
  for (const auto& section : model.sections) {
    for (auto i = section.begin; i < section.begin + section.clauses; ++i) {
      if (model.origins[model.clause_origins[i]].kind != compiler::OriginKind::kInvariant) continue;
      std::set<std::string> literals;
      for (const auto literal : model.clauses[i]) {
        const auto atom = model.atom(literal.var());
        const bool released = atom.kind == compiler::AtomKind::kReleasedAt;
        literals.insert((literal.is_positive() ? "" : "-") + std::string(released ? "~" : "") +
                        atom.name);
      }
      std::string clause;
      for (const auto& literal : literals) clause += (clause.empty() ? "" : " ") + literal;
      found.insert(clause);
    }
  }
  return found;
}

std::vector<std::string> all_models_of(const std::string& text, bool invariants) {
  const auto model = encoded(text, invariants);
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session, runtime::Distinct::kAll);
  std::vector<std::string> traces;
  while (const auto trace = enumerator.next()) traces.push_back(runtime::to_text(*trace));
  return traces;
}

const std::string kThing =
    "fluent Held()\nfluent Near()\nfluent Put()\nevent Take()\nevent Drop()\nevent Walk()\n"
    "[time] Initiates(Take(),Held(),time).\n[time] Terminates(Drop(),Held(),time).\n"
    "[time] Initiates(Walk(),Near(),time).\n"
    "range time 0 3\n!HoldsAt(Near(),0).\n";
const std::string kPlace =
    "[time] Releases(Take(),Put(),time).\n"
    "[time] HoldsAt(Near(),time) -> Initiates(Drop(),Put(),time).\n"
    "[time] !HoldsAt(Near(),time) -> Terminates(Drop(),Put(),time).\n";

}  // namespace

TEST_CASE("what is released while another fluent holds is said to be") {
  CHECK(said_of(kThing + kPlace + "!HoldsAt(Held(),0).\n") ==
        std::set<std::string>{"-Held() ~Put()", "-~Put() Held()"});
}

TEST_CASE("atoms that are always opposite are said to be") {
  const auto opposite = said_of(
      "fluent Open()\nfluent Shut()\nevent Push()\nevent Pull()\n"
      "[time] Initiates(Pull(),Open(),time).\n[time] Terminates(Push(),Open(),time).\n"
      "[time] Initiates(Push(),Shut(),time).\n[time] Terminates(Pull(),Shut(),time).\n"
      "range time 0 3\nHoldsAt(Shut(),0).\n!HoldsAt(Open(),0).\n");
  CHECK(opposite == std::set<std::string>{"-Open() -Shut()", "Open() Shut()"});
}

TEST_CASE("equality needs every reason for it") {
  SUBCASE("the start has to be stated") { CHECK(said_of(kThing + kPlace).empty()); }
  SUBCASE("and to be the same") {
    CHECK(said_of(kThing + kPlace + "HoldsAt(Held(),0).\n").empty());
  }
  SUBCASE("a further event that ends only one of them") {
    CHECK(said_of(kThing + kPlace +
                  "!HoldsAt(Held(),0).\nevent Slip()\n"
                  "[time] Terminates(Slip(),Held(),time).\n")
              .empty());
  }
  SUBCASE("a condition under which one of them stays") {
    CHECK(said_of(kThing + "!HoldsAt(Held(),0).\n[time] Releases(Take(),Put(),time).\n"
                           "[time] HoldsAt(Near(),time) -> Initiates(Drop(),Put(),time).\n")
              .empty());
  }
  SUBCASE("what holds because it is released as well") {
    CHECK(said_of(kThing + kPlace +
                  "!HoldsAt(Held(),0).\nevent Juggle()\n"
                  "[time] Releases(Juggle(),Held(),time).\n")
              .empty());
  }
}

TEST_CASE("saying what is equal changes no model") {
  const std::string models[] = {kThing + kPlace + "!HoldsAt(Held(),0).\n",
                                kThing + kPlace + "HoldsAt(Held(),0).\n", kThing + kPlace};
  for (const auto& model : models) {
    const auto with = all_models_of(model, true);
    CHECK(with == all_models_of(model, false));
    CHECK(with.size() > 10);
  }
}

}  // namespace parallax::test
