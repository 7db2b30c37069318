#pragma once

#include <span>
#include <string>

#include "compiler/lint/lint.h"
#include "tests/compiler/front_end.h"

namespace parallax::test {

/// A model text after the front end and some rules of lint.
struct LintedText : FrontEnd {
  explicit LintedText(std::string source) {
    const auto file = add(std::move(source));
    const auto ast = compiler::load_model_text(file, ".", {}, files, sink);
    REQUIRE(ast);
    const auto model = compiler::check_model(*ast, files, sink);
    REQUIRE_MESSAGE(model.has_value(), text());
    sink = base::DiagnosticSink(1000, 1000);  // what lint says alone
    compiler::lint_model(compiler::lint_rules(), *ast, *model, sink);
    compiler::lint_model(compiler::difference_rules(), *ast, *model, sink);
  }
};

}  // namespace parallax::test
