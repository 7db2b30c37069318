// Which fluents are false whenever an event happens.
//
// A precondition that holds at every timepoint is a clause: the event does not happen, or one of
// some ways is taken. If each way makes a member of one group of mutually exclusive fluents
// true, the group's other members are false when the event happens; if there is one way alone,
// what it denies is false as well. Both follow from the axioms without the instances that are
// left out for it: the groups were shown by induction over time from the start, the effects and
// the exclusions of events alone, and the preconditions stay. So the traces stay the same.
//
// Cost: linear in the clauses with an event, and for each of them in the group it chooses from.

#include "compiler/ground/meetings.h"

#include <algorithm>
#include <optional>

#include "compiler/formula/formula.h"

namespace parallax::compiler {
namespace {

/// The fluent or event, if the formula is an atom of this kind at timepoint 0.
std::optional<std::uint32_t> atom_at_0(AtomKind kind, FormulaId formula, const GroundModel& model) {
  const auto& formulas = model.formulas();
  if (formulas.kind(formula) != FormulaNodeKind::kAtom) return std::nullopt;
  const auto& atom = model.atom(formulas.variable(formula));
  if (atom.kind != kind || atom.time != 0 || atom.last) return std::nullopt;
  return atom.index;
}

/// The literals of a conjunction; of anything else itself.
std::vector<FormulaId> conjuncts(FormulaId formula, const FormulaStore& formulas) {
  if (formula.negated() || formulas.kind(formula) != FormulaNodeKind::kAnd) return {formula};
  const auto parts = formulas.children(formula);
  return {parts.begin(), parts.end()};
}

}  // namespace

bool drops_meetings(const GroundModel& model, const GroundOptions& options) {
  return options.meaning == Meaning::kStandard && options.templates && options.relevance &&
         options.invariants && model.horizon() > 0 &&
         model.fluents().size() * model.events().size() > options.keep_meetings;
}

Meetings::Meetings(const GroundModel& model, const std::vector<FluentGroup>& groups)
    : groups_(&groups), groups_of_(model.fluents().size()), absent_(model.events().size()) {
  for (std::uint32_t g = 0; g < groups.size(); ++g) {
    for (const auto fluent : groups[g]) groups_of_[fluent].push_back(g);
  }
  for (const auto& constraint : model.constraints()) {
    // A formula of width 0 names no event; one of width 1 holds at every timepoint that has one.
    if (constraint.width != 1) continue;
    for (const auto part : conjuncts(constraint.formula, model.formulas())) read(part, model);
  }
  for (auto& fluents : absent_) {
    std::sort(fluents.begin(), fluents.end());
    fluents.erase(std::unique(fluents.begin(), fluents.end()), fluents.end());
  }
  groups_ = nullptr;
  groups_of_.clear();
}

void Meetings::read(FormulaId clause, const GroundModel& model) {
  const auto& formulas = model.formulas();
  if (!clause.negated() || formulas.kind(clause) != FormulaNodeKind::kAnd) return;
  std::optional<std::uint32_t> event;
  std::vector<FormulaId> ways;
  for (const auto part : formulas.children(clause)) {
    const auto happens = part.negated() ? std::nullopt : atom_at_0(AtomKind::kHappens, part, model);
    if (happens && event) return;
    if (happens) {
      event = happens;
    } else {
      ways.push_back(~part);
    }
  }
  if (event && !ways.empty()) read_clause(*event, ways, model);
}

/// The event happens only if one of the ways is taken.
void Meetings::read_clause(std::uint32_t event, const std::vector<FormulaId>& ways,
                           const GroundModel& model) {
  std::vector<std::vector<std::uint32_t>> true_in;  // by way: fluents that it makes true
  for (const auto way : ways) {
    auto& fluents = true_in.emplace_back();
    for (const auto part : conjuncts(way, model.formulas())) {
      const auto fluent = atom_at_0(AtomKind::kHoldsAt, part, model);
      if (!fluent) continue;
      if (!part.negated()) fluents.push_back(*fluent);
      if (part.negated() && ways.size() == 1) absent_[event].push_back(*fluent);
    }
    if (fluents.empty()) return;
  }
  for (const auto first : true_in.front()) {
    for (const auto number : groups_of_[first]) {
      const auto& group = (*groups_)[number];
      std::vector<std::uint32_t> chosen;
      const bool each_way = std::all_of(true_in.begin(), true_in.end(), [&](const auto& fluents) {
        const auto before = chosen.size();
        for (const auto fluent : fluents) {
          if (std::binary_search(group.begin(), group.end(), fluent)) chosen.push_back(fluent);
        }
        return chosen.size() > before;
      });
      if (!each_way) continue;
      for (const auto fluent : group) {
        if (std::find(chosen.begin(), chosen.end(), fluent) == chosen.end()) {
          absent_[event].push_back(fluent);
        }
      }
    }
  }
}

bool Meetings::may_meet(std::uint32_t event, std::uint32_t fluent) const {
  return empty() || !std::binary_search(absent_[event].begin(), absent_[event].end(), fluent);
}

std::vector<EffectRow> rows_that_meet(const EffectRows& rows, const Meetings& meetings,
                                      GroundModel& model) {
  auto& formulas = model.formulas();
  std::vector<EffectRow> result;
  for (auto row : rows.always()) {
    RewriteMemo memo;
    row.condition = rewrite_atoms(
        formulas, row.condition,
        [&](std::int32_t variable) {
          const auto& atom = model.atom(variable);
          const bool never = atom.kind == AtomKind::kHoldsAt && atom.time == 0 &&
                             !meetings.may_meet(row.event, atom.index);
          return never ? formulas.falsity() : formulas.atom(variable);
        },
        memo);
    if (row.condition != formulas.falsity()) result.push_back(row);
  }
  return result;
}

}  // namespace parallax::compiler
