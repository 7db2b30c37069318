#pragma once

#include <memory>
#include <string>
#include <variant>

#include "compiler/artifact/compiled_model.h"
#include "runtime/graph/layered_model.h"

namespace parallax::harness {

/// A compiled model cut into steps: a world whose states are those of the model. Never changed, so
/// simulators in several threads share one.
struct SteppedModel {
  std::string name;  // as messages call it: "truth.e"
  compiler::CompiledModel model;
  runtime::LayeredModel layered;
};

/// The model, which has no plan and no state constraints and a horizon of 2 or more; or why it
/// cannot be played step by step: "the clauses of `...` look at more than two neighbouring
/// timepoints".
std::variant<std::shared_ptr<const SteppedModel>, std::string> step_model(
    std::string name, compiler::CompiledModel model);

}  // namespace parallax::harness
