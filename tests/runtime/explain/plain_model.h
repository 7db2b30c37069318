#pragma once

#include <string>

#include "compiler/artifact/describe.h"
#include "tests/support/text_model.h"

namespace parallax::test {

/// A model given as text, grounded so that each axiom's clauses stand for themselves: nothing is
/// settled while grounding.
struct PlainModel : TextModel {
  explicit PlainModel(const std::string& text)
      : TextModel(text, {.relevance = false, .invariants = false}) {
    if (ground != nullptr) compiler::describe_sources(compiled, files);
  }
};

}  // namespace parallax::test
