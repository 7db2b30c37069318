#include "harness/campaign/trace_input.h"

#include <algorithm>

namespace parallax::harness {

ModelFluents::ModelFluents(const compiler::SymbolTable& symbols) {
  for (std::uint32_t i = 0; i < symbols.fluent_count(); ++i) ids_.emplace_back(i);
  std::sort(ids_.begin(), ids_.end(), [&](compiler::FluentId a, compiler::FluentId b) {
    return symbols.name(a) < symbols.name(b);
  });
  for (const auto id : ids_) ground_.push_back(ground_fluent(symbols.name(id)));
}

}  // namespace parallax::harness
