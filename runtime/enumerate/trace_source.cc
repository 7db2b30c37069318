#include "runtime/enumerate/trace_source.h"

namespace parallax::runtime {

using compiler::AtomKind;

std::vector<std::vector<Literal>> projection_blocks(const CompiledModel& model, Distinct distinct) {
  std::vector<std::vector<Literal>> blocks(static_cast<std::size_t>(model.horizon) + 1);
  std::vector<Literal> predicates;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    const auto block = static_cast<std::size_t>(atom.time.value_or(0));
    if (atom.kind == AtomKind::kHoldsAt ||
        (atom.kind == AtomKind::kReleasedAt && distinct == Distinct::kAll)) {
      blocks[block].push_back(atom.literal());
    } else if (atom.kind == AtomKind::kHappens) {
      blocks[block + 1].push_back(atom.literal());
    } else if (atom.kind == AtomKind::kPredicate && distinct == Distinct::kAll) {
      predicates.push_back(atom.literal());
    }
  });
  if (!predicates.empty()) blocks.push_back(std::move(predicates));
  return blocks;
}

}  // namespace parallax::runtime
