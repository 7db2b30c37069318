#include "compiler/artifact/extended_model.h"

namespace parallax::compiler {

CompiledModel extended_model(const CompiledModel& model, const std::vector<Atom>& fixed,
                             const std::vector<AddedClause>& clauses, const Origin& origin) {
  const FixedInsertion moved(model, fixed.size());
  CompiledModel out = model;
  out.fixed.insert(out.fixed.end(), fixed.begin(), fixed.end());
  out.clauses = {};
  std::vector<Literal> scratch;
  const auto add = [&](std::span<const Literal> clause) {
    scratch.clear();
    for (const auto literal : clause) scratch.push_back(moved(literal));
    out.clauses.add(scratch);
  };
  for (std::size_t c = 0; c < model.clauses.size(); ++c) add(model.clauses[c]);
  for (auto& objective : out.objectives) {
    for (auto& term : objective.terms) {
      if (term.literal) term.literal = moved(*term.literal);
    }
  }
  if (clauses.empty()) return out;
  out.sections.push_back({model.clauses.size(), clauses.size(), 1, false, 0});
  out.origins.push_back(origin);
  for (const auto& clause : clauses) {
    add(clause.literals);
    out.clause_timepoints.push_back(clause.needed);
    out.clause_origins.push_back(static_cast<std::uint32_t>(out.origins.size()) - 1);
    out.clause_is_definition.push_back(clause.is_definition);
  }
  return out;
}

}  // namespace parallax::compiler
