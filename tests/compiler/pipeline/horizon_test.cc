// A longer horizon keeps the consequences of a shorter one, except for the formulas that lint warns
// about.

#include <doctest/doctest.h>

#include <algorithm>
#include <optional>
#include <string>

#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/model_enumerator.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

struct AtHorizon {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::optional<compiler::Compilation> result;

  AtHorizon(const std::string& model, std::int64_t horizon) {
    compiler::CompileInput input;
    input.text = files.add("model.e", model);
    input.horizon = horizon;
    input.lint = true;
    auto compiled = compiler::compile_model(input, files, sink);
    if (compiled) result = *std::move(compiled);
  }
  bool warns() const {
    const auto all = sink.sorted();
    return std::any_of(all.begin(), all.end(),
                       [](const auto& one) { return base::info(one.code).id == "W2162"; });
  }
  const compiler::CompiledModel& model() const { return result->model; }
};

/// Is the beginning of the trace one of the model, whose horizon is shorter?
bool begins(const compiler::CompiledModel& model, runtime::SolverSession& session,
            const runtime::Trace& trace) {
  // An atom without a variable is false in every trace.
  std::size_t left = 0;
  for (std::size_t t = 0; t <= static_cast<std::size_t>(model.horizon); ++t) {
    left += trace.holds(t).size();
    if (t < static_cast<std::size_t>(model.horizon)) left += trace.happens(t).size();
  }
  std::vector<compiler::Literal> said;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (!atom.time) return;
    const auto t = static_cast<std::size_t>(*atom.time);
    std::vector<std::string_view> names;
    if (atom.kind == compiler::AtomKind::kHoldsAt) {
      names = trace.holds(t);
    } else if (atom.kind == compiler::AtomKind::kHappens) {
      names = trace.happens(t);
    } else {
      return;
    }
    const bool is_true = std::find(names.begin(), names.end(), atom.name) != names.end();
    left -= is_true ? 1 : 0;
    said.push_back(is_true ? atom.literal() : ~atom.literal());
  });
  return left == 0 && session.solve(model.horizon, said) == runtime::SolveStatus::kSatisfiable;
}

TEST_CASE("a trace, cut off, is a trace of the shorter horizon") {
  int compared = 0, warned = 0, lost = 0;
  for (std::uint64_t seed = 1; seed <= 600; ++seed) {
    const RandomAdditions additions{.aggregates = seed % 2 == 0};
    const auto text = random_model(seed, kBruteForceSize, additions).print();
    CAPTURE(text);
    const AtHorizon shorter(text, 2), longer(text, 3);
    if (!shorter.result || !longer.result) continue;
    const bool warns = shorter.warns() || longer.warns();
    runtime::SolverSession session(shorter.model(), runtime::make_cadical_solver());
    runtime::SolverSession further(longer.model(), runtime::make_cadical_solver());
    runtime::ModelEnumerator traces(further);
    bool kept = true;
    for (int i = 0; i < 40 && kept; ++i) {
      const auto trace = traces.next();
      if (!trace) break;
      kept = begins(shorter.model(), session, *trace);
      if (!warns) ++compared;
    }
    warned += warns ? 1 : 0;
    lost += kept ? 0 : 1;
    if (!warns) CHECK(kept);
  }
  CHECK(compared > 500);
  CHECK(warned > 20);
  CHECK(lost > 5);
}

}  // namespace
}  // namespace parallax::test
