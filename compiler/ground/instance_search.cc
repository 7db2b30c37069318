// Runs the plan of a join (instance_plan.cc) by backtracking.
//
// Steps are taken in the plan's order. A filter or an equation is tested in passing; a table or
// a sort opens one level of recursion for each row or element. Bound variables are on a trail
// and are unbound on the way back. The rows of a table are found by a hash index on the columns
// that are bound; hashes may collide, so each row is matched against the patterns all the same.
// Assignments that some conjunct makes false are never completed; those that come out are sorted
// and each is kept once, so the result does not depend on the order of the joins.
//
// Cost: each row looked at and each element tried is charged to the grounder's budget; then n
// log n for n assignments that do not come out in order.

#include "compiler/ground/instance_search.h"

#include <algorithm>
#include <utility>

namespace parallax::compiler {
namespace {

using StepKind = InstancePlan::StepKind;

/// Sorts equal-length tuples that lie one after the other, and drops repetitions.
std::vector<GroundTermId> sorted(std::vector<GroundTermId> flat, std::size_t width) {
  if (width == 0) return flat;
  const auto count = flat.size() / width;
  const auto less = [&](std::size_t a, std::size_t b) {
    return std::lexicographical_compare(
        flat.begin() + static_cast<std::ptrdiff_t>(a * width),
        flat.begin() + static_cast<std::ptrdiff_t>((a + 1) * width),
        flat.begin() + static_cast<std::ptrdiff_t>(b * width),
        flat.begin() + static_cast<std::ptrdiff_t>((b + 1) * width));
  };
  bool ordered = true;
  for (std::size_t i = 1; i < count && ordered; ++i) ordered = less(i - 1, i);
  if (ordered) return flat;
  std::vector<std::uint32_t> order(count);
  for (std::uint32_t i = 0; i < count; ++i) order[i] = i;
  std::sort(order.begin(), order.end(), less);
  std::vector<GroundTermId> out;
  out.reserve(flat.size());
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0 && !less(order[i - 1], order[i])) continue;
    const auto begin = flat.begin() + static_cast<std::ptrdiff_t>(order[i] * width);
    out.insert(out.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
  }
  return out;
}

}  // namespace

std::vector<GroundTermId> InstanceSearch::run(const InstancePlan& plan,
                                              const std::vector<VariableId>& variables) {
  plan_ = &plan;
  variables_ = &variables;
  found_.clear();
  for (const auto variable : variables) {
    // Over an empty sort there is no instance, whatever the equations say.
    const auto sort = terms_.model().typed().variables[variable].sort;
    if (terms_.model().universe().domain(sort).empty()) return {};
  }
  step(0);
  return sorted(std::move(found_), variables.size());
}

/// One level of recursion for every variable at most: filters and equations are taken in passing.
void InstanceSearch::step(std::size_t number) {
  const auto mark = trail_.size();
  for (; number < plan_->steps.size(); ++number) {
    const auto& step = plan_->steps[number];
    if (step.kind == StepKind::kFilter) {
      if (filter(step.conjunct)) continue;
      return undo(mark);
    }
    if (step.kind == StepKind::kSolve) {
      const auto value = terms_.term(step.value);
      if (value && match(step.pattern, *value)) continue;
      return undo(mark);
    }
    if (step.kind == StepKind::kMatch) {
      match_rows(step, number);
      return undo(mark);
    }
    const auto sort = terms_.model().typed().variables[step.variable].sort;
    for (const auto value : terms_.model().universe().domain(sort)) {
      if (!terms_.spend(1)) break;
      const auto inner = trail_.size();
      terms_.bind(step.variable, value);
      trail_.push_back(step.variable);
      this->step(number + 1);
      undo(inner);
    }
    return undo(mark);
  }
  if (terms_.spend(variables_->empty() ? 1 : 0)) {
    for (const auto variable : *variables_) found_.push_back(*terms_.value(variable));
  }
  undo(mark);
}

void InstanceSearch::undo(std::size_t mark) {
  while (trail_.size() > mark) {
    terms_.unbind(trail_.back());
    trail_.pop_back();
  }
}

bool InstanceSearch::filter(const Conjunct& conjunct) {
  const auto& typed = terms_.model().typed();
  if (conjunct.kind == Conjunct::Kind::kCompare) {
    const auto value = terms_.compare(typed.formulas[conjunct.formula]);
    return value && *value != conjunct.negated;
  }
  if (conjunct.kind == Conjunct::Kind::kAtom) return may_be_true(typed.formulas[conjunct.formula]);
  if (conjunct.kind == Conjunct::Kind::kMeeting) {
    return may_meet(typed.formulas[conjunct.formula], typed.formulas[conjunct.other]);
  }
  const auto term = terms_.term(conjunct.term);
  if (!term) return false;
  auto& model = terms_.model();
  if (conjunct.kind == Conjunct::Kind::kFluent) return model.fluent_number(*term).has_value();
  const auto event = model.event_number(*term);
  const auto time = terms_.term(conjunct.time);
  if (!event || !time) return false;
  return possible_->may_happen(*event, static_cast<Timepoint>(model.terms()[*time].integer));
}

bool InstanceSearch::may_meet(const TypedFormula& happens, const TypedFormula& holds) {
  const auto event = terms_.term(happens.terms[0]);
  const auto fluent = terms_.term(holds.terms[0]);
  if (!event || !fluent) return false;
  const auto e = terms_.model().event_number(*event);
  const auto f = terms_.model().fluent_number(*fluent);
  return e && f && possible_->may_meet(*e, *f);
}

bool InstanceSearch::may_be_true(const TypedFormula& atom) {
  auto& model = terms_.model();
  const auto& core = model.typed().core;
  const bool is_holds = atom.predicate == core.holds_at;
  if (is_holds || atom.predicate == core.happens) {
    const auto term = terms_.term(atom.terms[0]);
    const auto time = terms_.term(atom.terms[1]);
    if (!term || !time) return false;
    const auto number = is_holds ? model.fluent_number(*term) : model.event_number(*term);
    if (!number) return false;
    const auto t = static_cast<Timepoint>(model.terms()[*time].integer);
    return is_holds ? possible_->may_hold(*number, t) : possible_->may_happen(*number, t);
  }
  const auto* table = possible_->predicates(atom.predicate);
  // A table of effects has no column for the time: it tells who changes what, not when.
  if (table == nullptr || table->columns() < atom.terms.size()) return true;
  std::vector<GroundTermId> arguments;
  for (const auto id : atom.terms) {
    const auto value = terms_.term(id);
    if (!value) return false;
    arguments.push_back(*value);
  }
  return possible_->may_be_true(atom.predicate, model.terms().apply(atom.predicate, arguments));
}

/// Gives a variable the value, or compares it with the one it has.
bool InstanceSearch::take(VariableId variable, GroundTermId value) {
  const auto present = terms_.value(variable);
  if (present) return *present == value;
  if (!terms_.in_sort(terms_.model().typed().variables[variable].sort, value)) return false;
  terms_.bind(variable, value);
  trail_.push_back(variable);
  return true;
}

bool InstanceSearch::match(TermId root, GroundTermId root_value) {
  const auto& model = terms_.model();
  std::vector<std::pair<TermId, GroundTermId>> todo = {{root, root_value}};
  while (!todo.empty()) {
    const auto [id, value] = todo.back();
    todo.pop_back();
    const auto& pattern = model.typed().terms[id];
    if (pattern.kind == TermKind::kVariable) {
      if (!take(pattern.variable, value)) return false;
    } else if (pattern.kind == TermKind::kArithmetic && is_open(id)) {
      if (!match_arithmetic(pattern, value)) return false;
    } else if (pattern.kind != TermKind::kApply ||
               model.typed().symbols[pattern.symbol].kind == SymbolKind::kFunction) {
      const auto own = terms_.term(id);
      if (!own || *own != value) return false;
    } else {
      if (model.terms()[value].kind != TermKind::kApply ||
          model.terms()[value].symbol != pattern.symbol) {
        return false;
      }
      const auto parts = model.terms().arguments(value);
      for (std::size_t i = parts.size(); i-- > 0;)
        todo.emplace_back(pattern.arguments[i], parts[i]);
    }
  }
  return true;
}

bool InstanceSearch::is_open(TermId id) const {
  const auto all = variables_of(terms_.model().typed(), id);
  return std::any_of(all.begin(), all.end(), [&](VariableId v) { return !terms_.is_bound(v); });
}

/// `a + b` or `a - b` with one side bound: the other is a difference or a sum.
bool InstanceSearch::match_arithmetic(const Term& pattern, GroundTermId value) {
  auto& store = terms_.model().terms();
  const bool left_open = is_open(pattern.arguments[0]);
  const auto known = terms_.term(pattern.arguments[left_open ? 1 : 0]);
  if (!known || store[*known].kind != TermKind::kInteger ||
      store[value].kind != TermKind::kInteger) {
    return false;
  }
  const auto result = store[value].integer;
  const auto other = store[*known].integer;
  const bool adds = pattern.op == ArithmeticOp::kAdd;
  std::int64_t solved = 0;
  bool overflow = false;
  if (left_open) {
    overflow = adds ? __builtin_sub_overflow(result, other, &solved)
                    : __builtin_add_overflow(result, other, &solved);
  } else {
    overflow = adds ? __builtin_sub_overflow(result, other, &solved)
                    : __builtin_sub_overflow(other, result, &solved);
  }
  if (overflow) return false;
  return match(pattern.arguments[left_open ? 0 : 1], store.integer(solved));
}

void InstanceSearch::match_rows(const InstancePlan::Step& step, std::size_t number) {
  const auto& typed = terms_.model().typed();
  // The columns as patterns, and the table they belong to.
  std::vector<TermId> columns;
  GroundTable* table = nullptr;
  TermId time = step.conjunct.time;
  bool is_event = step.conjunct.kind == Conjunct::Kind::kEvent;
  if (step.conjunct.kind == Conjunct::Kind::kAtom) {
    const auto& atom = typed.formulas[step.conjunct.formula];
    is_event = atom.predicate == typed.core.happens;
    if (!is_event && atom.predicate != typed.core.holds_at) {
      table = possible_->predicates(atom.predicate);
      columns.assign(atom.terms.begin(),
                     atom.terms.begin() + static_cast<std::ptrdiff_t>(table->columns()));
    } else {
      time = atom.terms[1];
    }
  }
  if (table == nullptr) {
    const auto& term = typed.terms[step.pattern];
    columns = term.arguments;
    table = is_event ? &possible_->events(term.symbol) : &possible_->fluents(term.symbol);
    if (table->columns() > columns.size()) columns.push_back(time);
  }
  std::uint64_t mask = 0;
  std::vector<GroundTermId> key;
  for (std::size_t i = 0; i < columns.size() && i < 64; ++i) {
    const auto all = variables_of(typed, columns[i]);
    if (!std::all_of(all.begin(), all.end(), [&](VariableId v) { return terms_.is_bound(v); })) {
      continue;
    }
    const auto value = terms_.term(columns[i]);
    if (!value) return;
    mask |= std::uint64_t{1} << i;
    key.push_back(*value);
  }
  const auto rows = table->find(mask, key);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!terms_.spend(1)) return;
    const auto inner = trail_.size();
    const auto row = table->row(rows[i]);
    bool fits = true;
    for (std::size_t c = 0; c < columns.size() && fits; ++c) fits = match(columns[c], row[c]);
    if (fits) this->step(number + 1);
    undo(inner);
  }
}

}  // namespace parallax::compiler
