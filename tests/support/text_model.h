#pragma once

#include <memory>
#include <string>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/diagnostic.h"
#include "compiler/cnf/encoder.h"
#include "compiler/ground/grounder.h"
#include "compiler/sema/check.h"
#include "compiler/syntax/loader.h"

namespace parallax::test {

/// A model given as text, through every stage of the compiler. Stages after an error are absent.
struct TextModel {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  std::unique_ptr<compiler::TypedModel> typed;  // the ground model points at it
  std::unique_ptr<compiler::GroundModel> ground;
  compiler::CompiledModel compiled;

  explicit TextModel(const std::string& text, const compiler::GroundOptions& options = {},
                     bool folded = false) {
    const auto file = files.add("test.e", text);
    auto ast = compiler::load_model_text(file, ".", {}, files, sink);
    if (!ast) return;
    auto checked = compiler::check_model(*ast, files, sink);
    if (!checked) return;
    typed = std::make_unique<compiler::TypedModel>(*std::move(checked));
    auto grounded = compiler::ground_model(*typed, options, sink);
    if (!grounded) return;
    ground = std::make_unique<compiler::GroundModel>(*std::move(grounded));
    compiled = compiler::encode(*ground, nullptr, folded);
  }

  /// The codes that were reported, in order, blank-separated.
  std::string codes() const {
    std::string out;
    for (const auto& diagnostic : sink.sorted()) {
      if (!out.empty()) out += ' ';
      out += base::info(diagnostic.code).id;
    }
    return out;
  }
};

}  // namespace parallax::test
