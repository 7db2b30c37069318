// Groups of fluents of which at most one, or exactly one, is true (mutex groups, Helmert 2009).
//
// Candidates are the instances of a fluent symbol that differ in one argument. That at most one
// of them holds is shown by induction over time, without a solver. At timepoint 0 the values of
// all of them have to be stated. In a step, every row that initiates one of them has to find
// each other one false, or the same event terminates it; and no two rows that initiate different
// members can take effect together: their events exclude one another, or their facts contradict
// each other, or one terminates what the other initiates. Exactly one: an event that terminates
// the member that holds initiates another one. Facts about a step are literals in preconditions
// and conditions; what does not stand there as a literal is not seen, and the group is then left
// alone.
//
// Cost: quadratic in the rows of a group and in its members; both are limited. The pairwise
// exclusions, and the disjunction, are added at every timepoint as clauses of an origin of their
// own. They follow from the model, so its traces stay the same, and explanations never use them.

#include "compiler/ground/invariants.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "compiler/formula/formula.h"
#include "compiler/ground/at_most_one.h"
#include "compiler/ground/ground_model.h"
#include "compiler/ground/possible_atoms.h"

namespace parallax::compiler {
namespace {

/// Some fluents at timepoint 0 with their values, by fluent.
using StateFacts = std::map<std::uint32_t, bool>;

/// Facts about a step in the constraints that hold at every timepoint: preconditions of events, and
/// events that exclude one another. Only facts that stand there as literals are found.
class StepFacts {
 public:
  /// `model` outlives the object. Linear in the constraints' formulas.
  StepFacts(const GroundModel& model, const Meetings& meetings);

  /// Fluents whose values are known when the row's event happens and its condition holds.
  StateFacts of(const EffectRow& row) const;
  bool exclusive(std::uint32_t event, std::uint32_t other) const;
  /// Does the formula hold in every state with these facts?
  bool implied(FormulaId formula, const StateFacts& facts) const;

 private:
  void read(FormulaId formula);
  void read_clause(std::span<const FormulaId> negated_parts);
  void add_literals(FormulaId formula, StateFacts& facts) const;

  const GroundModel& model_;
  const Meetings& meetings_;
  std::map<std::uint32_t, std::vector<FormulaId>> preconditions_;  // by event
  std::set<std::pair<std::uint32_t, std::uint32_t>> exclusive_;    // smaller event first
};

/// The event, if the formula is Happens(event, 0).
std::optional<std::uint32_t> event_of(FormulaId formula, const GroundModel& model) {
  const auto& formulas = model.formulas();
  if (formula.negated() || formulas.kind(formula) != FormulaNodeKind::kAtom) return std::nullopt;
  const auto& atom = model.atom(formulas.variable(formula));
  if (atom.kind != AtomKind::kHappens || atom.time != 0) return std::nullopt;
  return atom.index;
}

StepFacts::StepFacts(const GroundModel& model, const Meetings& meetings)
    : model_(model), meetings_(meetings) {
  for (const auto& constraint : model.constraints()) {
    if (constraint.width == 0 || constraint.width == 1) read(constraint.formula);
  }
}

void StepFacts::read(FormulaId formula) {
  const auto& formulas = model_.formulas();
  if (formulas.kind(formula) != FormulaNodeKind::kAnd) return;
  if (formula.negated()) return read_clause(formulas.children(formula));
  for (const auto part : formulas.children(formula)) {
    if (part.negated() && formulas.kind(part) == FormulaNodeKind::kAnd) {
      read_clause(formulas.children(part));
    }
  }
}

void StepFacts::read_clause(std::span<const FormulaId> negated_parts) {
  if (negated_parts.size() != 2) return;  // Happens(e) -> a | b says nothing of a single fluent
  const auto first = event_of(negated_parts[0], model_);
  const auto second = event_of(negated_parts[1], model_);
  if (first && second) {
    exclusive_.emplace(std::min(*first, *second), std::max(*first, *second));
  } else if (first) {
    preconditions_[*first].push_back(~negated_parts[1]);
  } else if (second) {
    preconditions_[*second].push_back(~negated_parts[0]);
  }
}

void StepFacts::add_literals(FormulaId formula, StateFacts& facts) const {
  const auto& formulas = model_.formulas();
  const auto note = [&](FormulaId part) {
    if (formulas.kind(part) != FormulaNodeKind::kAtom) return;
    const auto& atom = model_.atom(formulas.variable(part));
    if (atom.kind == AtomKind::kHoldsAt && atom.time == 0) facts[atom.index] = !part.negated();
  };
  note(formula);
  if (formulas.kind(formula) != FormulaNodeKind::kAnd || formula.negated()) return;
  for (const auto part : formulas.children(formula)) note(part);
}

StateFacts StepFacts::of(const EffectRow& row) const {
  StateFacts facts;
  const auto found = preconditions_.find(row.event);
  if (found != preconditions_.end()) {
    for (const auto formula : found->second) add_literals(formula, facts);
  }
  add_literals(row.condition, facts);
  if (meetings_.empty()) return facts;
  for (const auto fluent : meetings_.absent(row.event)) facts.emplace(fluent, false);
  return facts;
}

bool StepFacts::exclusive(std::uint32_t event, std::uint32_t other) const {
  return exclusive_.contains({std::min(event, other), std::max(event, other)});
}

bool StepFacts::implied(FormulaId formula, const StateFacts& facts) const {
  const auto value = evaluate(model_.formulas(), formula, [&](std::int32_t variable) {
    const auto& atom = model_.atom(variable);
    if (atom.kind != AtomKind::kHoldsAt || atom.time != 0) return Truth::kUnknown;
    const auto found = facts.find(atom.index);
    if (found == facts.end()) return Truth::kUnknown;
    return found->second ? Truth::kTrue : Truth::kFalse;
  });
  return value == Truth::kTrue;
}

using Group = FluentGroup;

/// The instances of each fluent symbol that differ in one argument, for each of its arguments.
std::vector<Group> candidates(const GroundModel& model) {
  std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, Group> groups;
  std::vector<Group> result;
  std::size_t widest = 0;
  for (const auto fluent : model.fluents())
    widest = std::max(widest, model.terms().arguments(fluent).size());
  for (std::size_t counted = 0; counted < widest; ++counted) {
    groups.clear();
    for (std::uint32_t f = 0; f < model.fluents().size(); ++f) {
      const auto arguments = model.terms().arguments(model.fluents()[f]);
      if (counted >= arguments.size() || !model.may_hold(f)) continue;
      std::vector<std::uint32_t> others;
      for (std::size_t i = 0; i < arguments.size(); ++i) {
        if (i != counted) others.push_back(arguments[i].index());
      }
      const auto symbol = model.terms()[model.fluents()[f]].symbol;
      groups[{symbol.index(), std::move(others)}].push_back(f);
    }
    for (auto& [key, group] : groups) {
      if (group.size() > 1 && group.size() <= kMaxGroup) result.push_back(std::move(group));
    }
  }
  return result;
}

class InvariantFinder {
 public:
  InvariantFinder(GroundModel& model, const EffectRows& rows, const Meetings& meetings)
      : model_(model), rows_(rows), facts_(model, meetings), initial_(initial_values(model)) {
    for (const auto& row : rows.always()) {
      rows_of_[row.fluent].push_back(&row);
      rows_by_event_[key(row.fluent, row.event)].push_back(&row);
    }
  }

  /// `known` groups need not be shown again.
  void run(const std::vector<Group>& known, std::size_t clique) {
    const std::set<Group> shown(known.begin(), known.end());
    for (const auto& group : candidates(model_)) {
      if (!is_inertial(group)) continue;
      const auto true_at_0 = count_true_at_0(group);
      if (!true_at_0 || *true_at_0 > 1) continue;
      if (!shown.contains(group) && !at_most_one_is_kept(group)) continue;
      add_at_most_one(group, clique);
      if (*true_at_0 == 1 && one_is_kept(group)) add_at_least_one(group);
    }
  }

  std::vector<Group> groups() {
    std::vector<Group> found;
    for (auto& group : candidates(model_)) {
      if (!is_inertial(group)) continue;
      const auto true_at_0 = count_true_at_0(group);
      if (true_at_0 && *true_at_0 <= 1 && at_most_one_is_kept(group)) {
        found.push_back(std::move(group));
      }
    }
    return found;
  }

 private:
  bool is_inertial(const Group& group) const {
    return std::all_of(group.begin(), group.end(), [&](std::uint32_t f) {
      return !model_.can_be_released(f) && !model_.fluent_symbol(f).noninertial &&
             rows_.is_uniform(f);
    });
  }

  /// None: something is not stated.
  std::optional<std::size_t> count_true_at_0(const Group& group) const {
    std::size_t count = 0;
    for (const auto f : group) {
      if (initial_[f] == Truth::kUnknown) return std::nullopt;
      if (initial_[f] == Truth::kTrue) ++count;
    }
    return count;
  }

  /// The rows that change members of the group; null if there are too many.
  std::optional<std::vector<const EffectRow*>> rows_of(const Group& group, EffectKind kind) const {
    std::vector<const EffectRow*> result;
    for (const auto f : group) {
      const auto found = rows_of_.find(f);
      if (found == rows_of_.end()) continue;
      for (const auto* row : found->second) {
        if (row->kind == kind) result.push_back(row);
      }
      if (result.size() > kMaxGroupRows) return std::nullopt;
    }
    return result;
  }

  /// Facts known when the row takes effect, given that at most one member holds.
  StateFacts facts_in(const EffectRow& row, const Group& group) const {
    auto facts = facts_.of(row);
    const auto holds = [&](std::uint32_t f) {
      const auto found = facts.find(f);
      return found != facts.end() && found->second;
    };
    const auto known = std::find_if(group.begin(), group.end(), holds);
    if (known == group.end()) return facts;
    for (const auto f : group) {
      if (f != *known) facts.emplace(f, false);
    }
    return facts;
  }

  /// With these facts, does the event do this to the fluent?
  bool changes(EffectKind kind, std::uint32_t event, std::uint32_t fluent,
               const StateFacts& facts) const {
    const auto found = rows_by_event_.find(key(fluent, event));
    if (found == rows_by_event_.end()) return false;
    return std::any_of(found->second.begin(), found->second.end(), [&](const EffectRow* row) {
      return row->kind == kind && facts_.implied(row->condition, facts);
    });
  }

  bool at_most_one_is_kept(const Group& group) const {
    const auto initiations = rows_of(group, EffectKind::kInitiates);
    if (!initiations) return false;
    std::vector<StateFacts> facts;
    for (const auto* row : *initiations) {
      facts.push_back(facts_in(*row, group));
      if (!others_are_false_after(*row, facts.back(), group)) return false;
    }
    for (std::size_t i = 0; i < initiations->size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const auto &row = *(*initiations)[i], &other = *(*initiations)[j];
        if (row.fluent != other.fluent && !cannot_coincide(row, facts[i], other, facts[j])) {
          return false;
        }
      }
    }
    return true;
  }

  /// Unless another event initiates them.
  bool others_are_false_after(const EffectRow& row, const StateFacts& facts,
                              const Group& group) const {
    return std::all_of(group.begin(), group.end(), [&](std::uint32_t other) {
      if (other == row.fluent) return true;
      const auto found = facts.find(other);
      if (found != facts.end() && !found->second) return true;
      auto with_other = facts;
      with_other[other] = true;
      return changes(EffectKind::kTerminates, row.event, other, with_other);
    });
  }

  bool cannot_coincide(const EffectRow& row, const StateFacts& facts, const EffectRow& other,
                       const StateFacts& other_facts) const {
    if (row.event != other.event && facts_.exclusive(row.event, other.event)) return true;
    const bool contradiction = std::any_of(facts.begin(), facts.end(), [&](const auto& fact) {
      const auto found = other_facts.find(fact.first);
      return found != other_facts.end() && found->second != fact.second;
    });
    // No trace has an event initiate a fluent that another terminates at the same time (DEC9,
    // DEC10).
    return contradiction || changes(EffectKind::kTerminates, row.event, other.fluent, facts) ||
           changes(EffectKind::kTerminates, other.event, row.fluent, other_facts);
  }

  /// Every event that terminates the member that holds initiates another member.
  bool one_is_kept(const Group& group) const {
    const auto terminations = rows_of(group, EffectKind::kTerminates);
    if (!terminations) return false;
    return std::all_of(terminations->begin(), terminations->end(), [&](const EffectRow* row) {
      auto facts = facts_.of(*row);
      const auto found = facts.find(row->fluent);
      if (found != facts.end() && !found->second) return true;  // did not hold
      for (const auto f : group) facts[f] = f == row->fluent;
      return std::any_of(group.begin(), group.end(), [&](std::uint32_t f) {
        return changes(EffectKind::kInitiates, row->event, f, facts);
      });
    });
  }

  std::uint32_t origin_of(const Group& group) {
    return model_.add_origin(model_.fluent_symbol(group[0]).declared, OriginKind::kInvariant);
  }

  void add_at_most_one(const Group& group, std::size_t clique) {
    const auto origin = origin_of(group);
    std::vector<FormulaId> members;
    for (const auto f : group) members.push_back(model_.holds(f, 0));
    for (const auto pair : at_most_one(members, clique, model_)) {
      model_.require_always(pair, origin, 0);
    }
  }

  void add_at_least_one(const Group& group) {
    std::vector<FormulaId> members;
    for (const auto f : group) members.push_back(model_.holds(f, 0));
    model_.require_always(model_.formulas().disjunction(members), origin_of(group), 0);
  }

  static std::uint64_t key(std::uint32_t fluent, std::uint32_t event) {
    return (std::uint64_t{fluent} << 32U) | event;
  }

  GroundModel& model_;
  const EffectRows& rows_;
  StepFacts facts_;
  std::vector<Truth> initial_;                                      // by fluent, at 0
  std::map<std::uint32_t, std::vector<const EffectRow*>> rows_of_;  // by fluent
  std::unordered_map<std::uint64_t, std::vector<const EffectRow*>> rows_by_event_;  // and fluent
};

}  // namespace

void add_invariants(GroundModel& model, const EffectRows& rows,
                    const std::vector<FluentGroup>& known, const Meetings& meetings,
                    std::size_t clique) {
  if (model.horizon() > 0) InvariantFinder(model, rows, meetings).run(known, clique);
}

std::vector<FluentGroup> at_most_one_groups(GroundModel& model, const EffectRows& rows) {
  const Meetings nothing;
  return InvariantFinder(model, rows, nothing).groups();
}

}  // namespace parallax::compiler
