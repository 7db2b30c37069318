#include <doctest/doctest.h>

#include <tuple>

#include "compiler/pipeline/compile.h"
#include "runtime/enumerate/model_enumerator.h"
#include "tools/bench/families/household.h"

namespace parallax::tools {
namespace {

std::optional<compiler::Compilation> compiled(const Household& made) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  compiler::CompileInput input;
  input.text = files.add("household.e", made.model);
  input.plan = compiler::PlanInput{{files.add("household.lisp", made.plan)},
                                   files.add("household.bind", made.binding)};
  auto compilation = compiler::compile_model(input, files, sink);
  CHECK(sink.sorted().empty());
  if (!compilation) return std::nullopt;
  return *std::move(compilation);
}

}  // namespace

TEST_CASE("a household is read without a word, and its plan has one trace to its end") {
  for (const auto& [items, rooms, steps] : {std::tuple(4, 2, 16), std::tuple(5, 3, 56)}) {
    CAPTURE(items);
    const auto compilation = compiled(household(items, rooms, steps));
    REQUIRE(compilation);
    runtime::SolverSession session(compilation->model, runtime::make_cadical_solver());
    runtime::ModelEnumerator enumerator(session);
    const auto first = enumerator.next();
    REQUIRE(first);
    CHECK(first->length() == steps);
    CHECK(!enumerator.next());
  }
}

}  // namespace parallax::tools
