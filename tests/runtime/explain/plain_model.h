#pragma once

#include <memory>
#include <string>

#include "compiler/artifact/describe.h"
#include "compiler/cnf/encoder.h"
#include "compiler/ground/grounder.h"
#include "compiler/sema/check.h"
#include "compiler/syntax/loader.h"

namespace parallax::test {

/// A model given as text, grounded so that each axiom's clauses stand for themselves: nothing is
/// settled while grounding.
struct PlainModel {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::unique_ptr<compiler::TypedModel> typed;
  std::unique_ptr<compiler::GroundModel> ground;
  compiler::CompiledModel compiled;

  explicit PlainModel(const std::string& text) {
    const auto file = files.add("test.e", text);
    auto ast = compiler::load_model_text(file, ".", {}, files, sink);
    if (!ast) return;
    auto checked = compiler::check_model(*ast, files, sink);
    if (!checked) return;
    typed = std::make_unique<compiler::TypedModel>(*std::move(checked));
    compiler::GroundOptions options;
    options.relevance = false;
    options.invariants = false;
    auto grounded = compiler::ground_model(*typed, options, sink);
    if (!grounded) return;
    ground = std::make_unique<compiler::GroundModel>(*std::move(grounded));
    compiled = compiler::encode(*ground);
    compiler::describe_sources(compiled, files);
  }
};

}  // namespace parallax::test
