#include "runtime/consequences/backbone.h"

#include <doctest/doctest.h>

#include "runtime/enumerate/model_enumerator.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using runtime::Extent;

struct AskedAtom {
  compiler::AtomKind kind;
  std::string name;
  compiler::Timepoint time;
  compiler::Literal literal;
};

std::vector<AskedAtom> observable_atoms(const compiler::CompiledModel& model) {
  std::vector<AskedAtom> atoms;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.kind == compiler::AtomKind::kHoldsAt || atom.kind == compiler::AtomKind::kHappens) {
      atoms.push_back({atom.kind, std::string(atom.name), atom.time.value_or(0), atom.literal()});
    }
  });
  return atoms;
}

/// Extents from the list of all traces, without the search that is tested. None: there are too
/// many.
std::optional<std::vector<Extent>> listed_extents(const compiler::CompiledModel& model,
                                                  const std::vector<AskedAtom>& atoms) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::vector<std::size_t> count(atoms.size());
  std::size_t traces = 0;
  while (const auto trace = enumerator.next()) {
    if (++traces > 500) return std::nullopt;
    for (std::size_t i = 0; i < atoms.size(); ++i) {
      const auto t = static_cast<std::size_t>(atoms[i].time);
      const auto names =
          atoms[i].kind == compiler::AtomKind::kHappens ? trace->happens(t) : trace->holds(t);
      for (const auto name : names) count[i] += name == atoms[i].name ? 1 : 0;
    }
  }
  std::vector<Extent> extents;
  for (const auto n : count) {
    extents.push_back(traces == 0   ? Extent::kAbsent
                      : n == 0      ? Extent::kNone
                      : n == traces ? Extent::kAll
                                    : Extent::kSome);
  }
  return extents;
}

/// The same extents as reported by a search that only asks which atoms hold in all traces.
std::vector<Extent> without_some(std::vector<Extent> extents) {
  for (auto& extent : extents) {
    if (extent == Extent::kNone || extent == Extent::kSome) extent = Extent::kNotAll;
  }
  return extents;
}

TEST_CASE("what all traces have in common is what the list of them has in common") {
  std::size_t compared = 0, with_some = 0, with_all = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    TextModel model(random_model(seed, seed % 4 == 0 ? kSolverSize : kBruteForceSize).print());
    if (model.ground == nullptr || model.sink.has_errors()) continue;
    const auto atoms = observable_atoms(model.compiled);
    const auto wanted = listed_extents(model.compiled, atoms);
    if (!wanted) continue;
    std::vector<compiler::Literal> literals;
    for (const auto& atom : atoms) literals.push_back(atom.literal);
    runtime::SolverSession session(model.compiled, runtime::make_cadical_solver());
    const auto found = runtime::find_consequences(session, literals);
    CAPTURE(seed);
    REQUIRE(found.complete);
    CHECK(found.extents == *wanted);
    runtime::SolverSession other(model.compiled, runtime::make_cadical_solver(),
                                 runtime::Loading::kWitness);
    const auto only_all = runtime::find_consequences(other, literals, runtime::Asked::kAll);
    CHECK(only_all.extents == without_some(*wanted));
    ++compared;
    with_some += std::count(wanted->begin(), wanted->end(), Extent::kSome) > 0 ? 1 : 0;
    with_all += std::count(wanted->begin(), wanted->end(), Extent::kAll) > 0 ? 1 : 0;
  }
  CHECK(compared > 150);
  CHECK(with_some > 50);
  CHECK(with_all > 50);
}

TEST_CASE("a model without traces says so") {
  TextModel model("range time 0 1\nfluent F()\nHoldsAt(F(),0).\n!HoldsAt(F(),1).\n");
  REQUIRE(model.ground != nullptr);
  runtime::SolverSession session(model.compiled, runtime::make_cadical_solver());
  const auto found = runtime::find_consequences(session, {});
  CHECK(found.any == false);
  CHECK(found.complete);
}

}  // namespace
}  // namespace parallax::test
