// Smallest sets of edits with which a model admits what was seen.
//
// One compiled model has all edits in it, each behind a predicate that the text leaves open;
// their selectors are shared by one incremental solver. For each way that runs went there is a
// copy of the clauses in which its events and states are facts. Unit propagation of the facts
// settles nearly everything but the edits, satisfied clauses go, and variables that occur in one
// sign only are set (pure literals), so a copy is small. An edit that a copy excludes is
// excluded only where that copy counts. A sequential counter bounds the number of selected edits
// (Sinz 2005); a found set blocks itself and its supersets, so by rising size each set is
// minimal.
//
// Cost: linear in the model for each way that runs went; one call for each set found and one
// more for each size.

#include "tools/repair/edit_search.h"

#include <algorithm>

#include "compiler/base/ground_name.h"
#include "compiler/repair/guarded_model.h"
#include "runtime/enumerate/path_admission.h"

namespace parallax::tools {

using compiler::AtomKind;
using compiler::Edit;
using compiler::Literal;
using compiler::Timepoint;
using runtime::SolveStatus;

EditSearch::EditSearch(const compiler::CompiledModel& guarded, const std::vector<Edit>& edits,
                       const std::vector<Evidence>& evidence, const std::atomic<bool>& stop)
    : guarded_(guarded),
      edits_(edits),
      evidence_(evidence),
      index_(guarded),
      undemanded_(runtime::undemanded_events(guarded)),
      fixed_(static_cast<std::size_t>(guarded.base())),
      solver_(runtime::make_cadical_solver(&stop)),
      circuit_(*solver_, static_cast<std::int32_t>(edits.size()) + 1) {
  std::vector<Literal> selectors;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    selectors.push_back(selector(i));
    const auto atom =
        index_.find(AtomKind::kPredicate, compiler::edit_predicate(i) + "()", std::nullopt);
    if (atom) fixed_[static_cast<std::size_t>(atom->var()) - 1] = selector(i);
    // An edit that no clause mentions changes nothing.
    const bool tells = atom || edits[i].kind == Edit::Kind::kRequire;
    if (!tells) require({~selector(i)});
    if (edits[i].kind == Edit::Kind::kAddCondition) require({~selector(i), selector(edits[i].of)});
    solver_->set_phase(~selector(i));
  }
  counter_.emplace(circuit_, *solver_, selectors, kMostEdits + 1);
  find_occurrences();
  for (std::size_t i = 0; i < evidence.size(); ++i) add(i);
}

namespace {

std::size_t place_of(Literal literal) {
  return 2 * (static_cast<std::size_t>(literal.var()) - 1) + (literal.is_positive() ? 0 : 1);
}

/// 1: true, -1: false, 0: open.
int value_of(Literal literal, const std::vector<std::int8_t>& values) {
  const int value = values[static_cast<std::size_t>(literal.var()) - 1];
  return literal.is_positive() ? value : -value;
}

}  // namespace

void EditSearch::find_occurrences() {
  occurrences_.resize(2 * static_cast<std::size_t>(guarded_.variable_count()));
  for (std::uint32_t c = 0; c < guarded_.clauses.size(); ++c) {
    for (const auto literal : guarded_.clauses[c]) occurrences_[place_of(literal)].push_back(c);
  }
}

/// Unit propagation of the facts over the clauses up to `last`. Events and states of a run settle
/// nearly everything but the edits, so that its copy of the clauses stays small. False if they
/// contradict each other.
bool EditSearch::propagate(std::vector<Literal> facts, Timepoint last,
                           std::vector<std::int8_t>& values) const {
  std::vector<std::uint32_t> false_literals(guarded_.clauses.size(), 0);
  for (std::size_t c = 0; c < guarded_.clauses.size(); ++c) {
    if (guarded_.clauses[c].size() == 1 && guarded_.clause_timepoints[c] <= last) {
      facts.push_back(guarded_.clauses[c].front());
    }
  }
  while (!facts.empty()) {
    const auto literal = facts.back();
    facts.pop_back();
    const int known = value_of(literal, values);
    if (known < 0) return false;
    if (known > 0) continue;
    values[static_cast<std::size_t>(literal.var()) - 1] = literal.is_positive() ? 1 : -1;
    for (const auto c : occurrences_[place_of(~literal)]) {
      const auto clause = guarded_.clauses[c];
      if (guarded_.clause_timepoints[c] > last || ++false_literals[c] + 1 != clause.size()) {
        continue;
      }
      const auto open = std::find_if(clause.begin(), clause.end(),
                                     [&](Literal each) { return value_of(each, values) >= 0; });
      if (open != clause.end()) facts.push_back(*open);
    }
  }
  return true;
}

/// The clauses up to `last` that `values` do not satisfy. Pure literals in them that are not
/// `needed` are set.
std::vector<std::uint32_t> EditSearch::open_clauses(Timepoint last, const std::vector<bool>& needed,
                                                    std::vector<std::int8_t>& values) const {
  const auto is_open = [&](std::uint32_t c) {
    const auto clause = guarded_.clauses[c];
    return std::none_of(clause.begin(), clause.end(),
                        [&](Literal each) { return value_of(each, values) > 0; });
  };
  std::vector<std::uint32_t> open;
  std::vector<std::uint32_t> uses(occurrences_.size(), 0);
  const auto count = [&](std::uint32_t c, bool more) {
    for (const auto literal : guarded_.clauses[c]) uses[place_of(literal)] += more ? 1U : ~0U;
  };
  for (std::uint32_t c = 0; c < guarded_.clauses.size(); ++c) {
    if (guarded_.clause_timepoints[c] > last || !is_open(c)) continue;
    open.push_back(c);
    count(c, true);
  }
  std::vector<std::size_t> candidates;
  for (std::size_t variable = 0; variable < values.size(); ++variable) {
    if (!needed[variable] && values[variable] == 0) candidates.push_back(variable);
  }
  while (!candidates.empty()) {
    const auto variable = candidates.back();
    candidates.pop_back();
    const bool positive = uses[2 * variable] > 0, negative = uses[2 * variable + 1] > 0;
    if (values[variable] != 0 || positive == negative) continue;
    values[variable] = positive ? 1 : -1;
    for (const auto c : occurrences_[2 * variable + (positive ? 0 : 1)]) {
      if (guarded_.clause_timepoints[c] > last) continue;
      const auto clause = guarded_.clauses[c];
      // Has this assignment satisfied the clause?
      const auto true_ones = std::count_if(
          clause.begin(), clause.end(), [&](Literal each) { return value_of(each, values) > 0; });
      if (true_ones != 1) continue;
      count(c, false);
      for (const auto literal : clause) {
        const auto other = static_cast<std::size_t>(literal.var()) - 1;
        if (values[other] == 0 && !needed[other]) candidates.push_back(other);
      }
    }
  }
  std::erase_if(open, [&](std::uint32_t c) { return !is_open(c); });
  return open;
}

void EditSearch::add(std::size_t number) {
  const auto& evidence = evidence_[number];
  const auto active = circuit_.new_variable();
  active_.push_back(active);
  std::vector<Literal> facts;
  std::optional<std::size_t> refused;  // the step whose event the model may forbid
  const auto say = [&](const std::optional<Literal>& literal, bool value) {
    if (literal) facts.push_back(value ? *literal : ~*literal);
    // An atom that the model does not have is false.
    if (!literal && value) require({~active});
  };
  const auto happens = [&](std::size_t i) {
    return index_.find(AtomKind::kHappens, evidence.steps[i].event, static_cast<Timepoint>(i));
  };
  for (std::size_t i = 0; i < evidence.needed(); ++i) {
    const auto event = happens(i);
    const bool may_be_refused =
        evidence.steps[i].failed && !evidence.until && evidence.divergence == i + 1;
    if (event && may_be_refused) {
      refused = i;
    } else {
      say(event, true);
    }
    for (const auto slot : undemanded_) {
      const auto literal = Literal::positive(guarded_.variable(slot, static_cast<Timepoint>(i)));
      if (!event || literal != *event) facts.push_back(~literal);
    }
  }
  for (std::size_t t = 0; t <= evidence.needed(); ++t) {
    for (const auto& [fluent, holds] : evidence.states[t]) {
      say(index_.find(AtomKind::kHoldsAt, fluent, static_cast<Timepoint>(t)), holds);
    }
  }
  const auto last = static_cast<Timepoint>(evidence.needed());
  std::vector<std::int8_t> values(static_cast<std::size_t>(guarded_.variable_count()), 0);
  if (!propagate(std::move(facts), last, values)) {
    require({~active});
    return;
  }
  std::vector<std::optional<Literal>> own(values.size());
  const auto mapped = [&](Literal literal) {
    const auto variable = static_cast<std::size_t>(literal.var()) - 1;
    auto& here = own[variable];
    if (!here && variable < fixed_.size()) here = fixed_[variable];
    if (!here && values[variable] != 0) here = circuit_.constant(values[variable] > 0);
    if (!here) here = circuit_.new_variable();
    return literal.is_positive() ? *here : ~*here;
  };
  // An edit that this copy excludes is excluded for this copy alone.
  for (std::size_t variable = 0; variable < fixed_.size(); ++variable) {
    if (!fixed_[variable] || values[variable] == 0) continue;
    require({~active, values[variable] > 0 ? *fixed_[variable] : ~*fixed_[variable]});
  }
  std::vector<bool> needed(values.size(), false);  // also elsewhere
  for (std::size_t variable = 0; variable < fixed_.size(); ++variable) {
    needed[variable] = fixed_[variable].has_value();
  }
  if (refused) needed[static_cast<std::size_t>(happens(*refused)->var()) - 1] = true;
  for (const auto c : open_clauses(last, needed, values)) {
    std::vector<Literal> clause = {~active};
    for (const auto literal : guarded_.clauses[c]) {
      if (value_of(literal, values) == 0) clause.push_back(mapped(literal));
    }
    require(std::move(clause));
  }
  if (!refused) return;
  std::map<std::string, Literal> seen;
  for (const auto& [fluent, holds] : evidence.states[*refused]) {
    seen.emplace(fluent, circuit_.constant(holds));
  }
  // Fluents that were not seen there, as those of the start alone, and follow from what was.
  guarded_.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.kind != AtomKind::kHoldsAt || atom.time != static_cast<Timepoint>(*refused)) return;
    const int value = value_of(atom.literal(), values);
    if (value != 0) {
      seen.emplace(guarded_.fluents[atom.fluent().index()].name, circuit_.constant(value > 0));
    }
  });
  add_refusal(evidence, *refused, mapped(*happens(*refused)), active, seen);
}

/// The event happens, or a precondition that was added forbids it.
void EditSearch::add_refusal(const Evidence& evidence, std::size_t t, Literal happens,
                             Literal active, const std::map<std::string, Literal>& state) {
  const auto& event = evidence.steps[t].event;
  const auto arguments = compiler::arguments_of(event);
  std::vector<Literal> reasons = {~active, happens};
  for (std::size_t i = 0; i < edits_.size(); ++i) {
    const auto& edit = edits_[i];
    if (edit.kind != Edit::Kind::kRequire || edit.event != base::symbol_of(event)) continue;
    if (edit.variables.size() != arguments.size()) continue;
    std::map<std::string, std::string> values;
    for (std::size_t a = 0; a < arguments.size(); ++a) values[edit.variables[a]] = arguments[a];
    if (edit.literal->kind != compiler::ConditionLiteral::Kind::kFluent) continue;
    const auto pattern = compiler::atom_pattern(*edit.literal, values);
    std::vector<Literal> any;
    for (const auto& [fluent, literal] : state) {
      if (compiler::matches(fluent, pattern)) any.push_back(literal);
    }
    if (any.empty()) continue;  // not seen: nothing says that it forbids
    const auto atom = circuit_.disjunction(any);
    const auto is_false = edit.literal->negated ? atom : ~atom;
    reasons.push_back(circuit_.conjunction({selector(i), is_false}));
  }
  require(std::move(reasons));
}

std::vector<std::size_t> EditSearch::selected() const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < edits_.size(); ++i) {
    if (solver_->value(selector(i))) out.push_back(i);
  }
  return out;
}

EditSearch::Found EditSearch::find(std::size_t size, std::size_t limit) {
  Found found;
  while (found.sets.size() < limit) {
    solver_->assume(~counter_->at_least(size + 1));
    for (const auto literal : active_) solver_->assume(literal);
    const auto status = solver_->solve();
    found.complete = status == SolveStatus::kUnsatisfiable;
    if (status != SolveStatus::kSatisfiable) break;
    auto set = selected();
    std::vector<Literal> other;
    for (const auto edit : set) other.push_back(~selector(edit));
    require(std::move(other));
    found.sets.push_back(std::move(set));
  }
  return found;
}

std::optional<std::vector<std::size_t>> EditSearch::find_for(const std::vector<std::size_t>& failed,
                                                             std::size_t size) {
  solver_->assume(~counter_->at_least(size + 1));
  for (std::size_t i = 0; i < evidence_.size(); ++i) {
    const bool counts =
        !evidence_[i].divergence || std::find(failed.begin(), failed.end(), i) != failed.end();
    if (counts) solver_->assume(active_[i]);
  }
  if (solver_->solve() != SolveStatus::kSatisfiable) return std::nullopt;
  return selected();
}

}  // namespace parallax::tools
