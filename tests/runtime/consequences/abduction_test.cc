#include "runtime/consequences/abduction.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <map>
#include <set>

#include "runtime/enumerate/model_enumerator.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using Occurrences = std::set<std::string>;

std::string occurrence(std::string_view name, compiler::Timepoint t) {
  return std::string(name) + '@' + std::to_string(t);
}

struct AbductionTask {
  std::vector<compiler::Literal> abducibles;
  std::map<std::int32_t, std::string> names;  // by variable
  std::optional<compiler::Literal> observed;
  std::string fluent;  // observed at the horizon
};

AbductionTask task_of(const compiler::CompiledModel& model) {
  AbductionTask task;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const auto time = atom.time.value_or(0);
    if (atom.kind == compiler::AtomKind::kHappens) {
      task.abducibles.push_back(atom.literal());
      task.names[atom.literal().var()] = occurrence(atom.name, time);
    } else if (atom.kind == compiler::AtomKind::kHoldsAt && time == model.horizon &&
               !task.observed) {
      task.observed = atom.literal();
      task.fluent = atom.name;
    }
  });
  return task;
}

/// All explanations, by the definition, from the list of all traces. None: there are too many.
std::optional<std::set<Occurrences>> listed_explanations(const compiler::CompiledModel& model,
                                                         const AbductionTask& task) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::map<Occurrences, bool> entails;  // by the events that happened
  std::size_t traces = 0;
  while (const auto trace = enumerator.next()) {
    if (++traces > 400) return std::nullopt;
    Occurrences happened;
    for (std::size_t t = 0; t + 1 < trace->points.size(); ++t) {
      for (const auto name : trace->happens(t)) {
        happened.insert(occurrence(name, static_cast<compiler::Timepoint>(t)));
      }
    }
    const auto last = trace->holds(trace->points.size() - 1);
    const bool seen = std::find(last.begin(), last.end(), task.fluent) != last.end();
    const auto [entry, is_new] = entails.emplace(std::move(happened), seen);
    if (!is_new) entry->second = entry->second && seen;
  }
  std::set<Occurrences> minimal;
  for (const auto& [set, is_entailing] : entails) {
    const bool larger = std::any_of(entails.begin(), entails.end(), [&](const auto& other) {
      return other.second && other.first.size() < set.size() &&
             std::includes(set.begin(), set.end(), other.first.begin(), other.first.end());
    });
    if (is_entailing && !larger) minimal.insert(set);
  }
  return minimal;
}

TEST_CASE("explanations are the smallest sets of events that entail what was observed") {
  std::size_t compared = 0, explained = 0, several = 0;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    TextModel model(random_model(seed, kBruteForceSize).print());
    if (model.ground == nullptr || model.sink.has_errors()) continue;
    const auto task = task_of(model.compiled);
    if (!task.observed || task.abducibles.empty()) continue;
    const auto wanted = listed_explanations(model.compiled, task);
    if (!wanted) continue;
    runtime::SolverSession find(model.compiled, runtime::make_cadical_solver());
    runtime::SolverSession refute(model.compiled, runtime::make_cadical_solver());
    runtime::Explanations explanations(find, refute, model.compiled.horizon, task.abducibles,
                                       *task.observed);
    std::set<Occurrences> found;
    std::size_t last_size = 0;
    while (const auto set = explanations.next()) {
      CHECK(set->size() >= last_size);
      last_size = set->size();
      Occurrences named;
      for (const auto atom : *set) named.insert(task.names.at(atom.var()));
      CHECK(found.insert(named).second);
    }
    CAPTURE(seed);
    CHECK(explanations.exhausted());
    CHECK(found == *wanted);
    ++compared;
    explained += wanted->empty() ? 0 : 1;
    several += wanted->size() > 1 ? 1 : 0;
  }
  CHECK(compared > 150);
  CHECK(explained > 40);
  CHECK(several > 2);
}

TEST_CASE("more events than the first bound of sizes holds") {
  // A counter of twelve bits that is full when each was set once.
  std::string text =
      "range time 0 1\nsort bit: integer\nrange bit 1 12\nfluent Set(bit)\n"
      "fluent Full()\nevent Put(bit)\n"
      "[bit,time] Initiates(Put(bit),Set(bit),time).\n"
      "[bit] !HoldsAt(Set(bit),0).\n!HoldsAt(Full(),0).\nnoninertial Full\n"
      "[time] HoldsAt(Full(),time) <-> ([bit] HoldsAt(Set(bit),time)).\n";
  TextModel model(text);
  REQUIRE_MESSAGE(model.ground != nullptr, model.codes());
  auto task = task_of(model.compiled);
  const auto full = compiler::AtomIndex(model.compiled)
                        .find(compiler::AtomKind::kHoldsAt, "Full()", model.compiled.horizon);
  REQUIRE(full);
  runtime::SolverSession find(model.compiled, runtime::make_cadical_solver());
  runtime::SolverSession refute(model.compiled, runtime::make_cadical_solver());
  runtime::Explanations explanations(find, refute, model.compiled.horizon, task.abducibles, *full);
  const auto set = explanations.next();
  REQUIRE(set);
  CHECK(set->size() == 12);
  CHECK_FALSE(explanations.next());
  CHECK(explanations.exhausted());
}

}  // namespace
}  // namespace parallax::test
