#include "compiler/artifact/derived.h"

#include <algorithm>

namespace parallax::compiler {

Timepoint derived_timepoint(const CompiledModel& model, std::span<const Literal> clause) {
  Timepoint needed = 0;
  const auto base = model.base();
  for (const auto literal : clause) {
    const auto v = literal.var();
    if (v <= base) {
      needed = std::max(needed, needed_horizon(model.fixed[static_cast<std::size_t>(v) - 1]));
      continue;
    }
    const auto place = v - base - 1;
    const auto slot = static_cast<std::uint32_t>(place % model.stride());
    const auto time = place / model.stride();
    needed = std::max(needed, slot < model.state_slots ? time : time + 1);
  }
  return needed;
}

Timepoint usual_timepoint(const CompiledModel& model, const Section& section,
                          std::span<const Literal> clause) {
  return section.repeated ? section.width : derived_timepoint(model, clause);
}

Occurrences occurrences(const CompiledModel& model) {
  Occurrences found{std::vector<bool>(model.fixed.size()), std::vector<bool>(model.slots.size())};
  const auto base = model.base();
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    for (const auto literal : model.clauses[i]) {
      const auto v = literal.var();
      if (v <= base) {
        found.fixed[static_cast<std::size_t>(v) - 1] = true;
      } else {
        found.slots[static_cast<std::size_t>((v - base - 1) % model.stride())] = true;
      }
    }
  }
  return found;
}

std::vector<std::int32_t> observable_variables(const CompiledModel& model) {
  std::vector<std::int32_t> variables;
  model.for_each_atom([&](const AtomRef& atom) {
    const bool observable = atom.kind == AtomKind::kHoldsAt || atom.kind == AtomKind::kHappens;
    if (observable) variables.push_back(atom.variable);
  });
  std::sort(variables.begin(), variables.end());
  return variables;
}

bool is_shifted(const CompiledModel& model, std::span<const Literal> first,
                std::span<const Literal> later, std::int64_t steps) {
  const auto moved = [&](Literal a, Literal b) {
    const std::int64_t by = a.var() <= model.base() ? 0 : steps * model.stride();
    return a.is_positive() == b.is_positive() && a.var() + by == b.var();
  };
  return std::equal(first.begin(), first.end(), later.begin(), later.end(), moved);
}

}  // namespace parallax::compiler
