#pragma once

#include <algorithm>

#include "compiler/sema/typed_model.h"
#include "runtime/trace/decreasoner_format.h"

namespace parallax::tools {

/// What the model's `option` lines and completions say of the old printed form.
inline runtime::DecreasonerOptions decreasoner_options(const compiler::TypedModel& typed) {
  runtime::DecreasonerOptions options;
  options.time_diff = typed.options.time_diff;
  options.model_diff = typed.options.model_diff;
  options.show_predicates = typed.options.show_predicates;
  options.events_completed = std::any_of(
      typed.completions.begin(), typed.completions.end(),
      [&](const compiler::Completion& one) { return one.predicate == typed.core.happens; });
  return options;
}

}  // namespace parallax::tools
