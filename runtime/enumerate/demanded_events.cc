#include "runtime/enumerate/demanded_events.h"

namespace parallax::runtime {

std::vector<compiler::EventId> demandable_events(const compiler::CompiledModel& model) {
  std::vector<bool> demanded(model.slots.size(), false);
  for (std::size_t c = 0; c < model.clauses.size(); ++c) {
    if (model.origins[model.clause_origins[c]].kind != compiler::OriginKind::kAxiom) continue;
    for (const auto literal : model.clauses[c]) {
      if (!literal.is_positive() || literal.var() <= model.base()) continue;
      const auto place = literal.var() - model.base() - 1;
      demanded[static_cast<std::size_t>(place % model.stride())] = true;
    }
  }
  std::vector<compiler::EventId> out;
  for (std::uint32_t e = 0; e < model.events.size(); ++e) {
    const auto slot = model.events[e].slot;
    if (slot && demanded[*slot]) out.emplace_back(e);
  }
  return out;
}

}  // namespace parallax::runtime
