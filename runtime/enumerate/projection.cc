#include "runtime/enumerate/projection.h"

namespace parallax::runtime {

using compiler::AtomKind;

std::vector<std::vector<Literal>> projection_blocks(const CompiledModel& model, Distinct distinct) {
  std::vector<std::vector<Literal>> blocks(static_cast<std::size_t>(model.horizon) + 1);
  std::vector<Literal> predicates;
  model.for_each_atom(
      [&](std::int32_t variable, AtomKind kind, const std::string&, std::optional<Timepoint> time) {
        const auto atom = Literal::positive(variable);
        if (kind == AtomKind::kHoldsAt ||
            (kind == AtomKind::kReleasedAt && distinct == Distinct::kAll)) {
          blocks[static_cast<std::size_t>(*time)].push_back(atom);
        } else if (kind == AtomKind::kHappens) {
          blocks[static_cast<std::size_t>(*time) + 1].push_back(atom);
        } else if (kind == AtomKind::kPredicate && distinct == Distinct::kAll) {
          predicates.push_back(atom);
        }
      });
  if (!predicates.empty()) blocks.push_back(std::move(predicates));
  return blocks;
}

}  // namespace parallax::runtime
