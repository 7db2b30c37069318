// Order in which the variables of a quantified formula are bound, as in the plan of a database
// join.
//
// The planner is greedy. Conjuncts whose variables are all bound become filters at once. Then an
// equation with one side bound gives the variables of the other side. If variables are still
// open, the table with the fewest expected rows for each look-up is matched; a sort is
// enumerated, the smallest first, only where no table helps. Expected rows assume that a column
// of a table with n rows has sqrt(n) different values. The product of all steps' fan-outs is the
// estimate by which the grounder refuses a formula before it begins; a plan of enumerations
// alone is a bare product of sorts.
//
// Cost: quadratic in conjuncts and variables.

#include <algorithm>
#include <cmath>
#include <optional>

#include "compiler/ground/instance_search.h"

namespace parallax::compiler {
namespace {

using StepKind = InstancePlan::StepKind;

/// Share of the instances that a comparison is assumed to keep, where nothing better is known.
constexpr double kFilterShare = 0.3;

class Planner {
 public:
  Planner(const std::vector<VariableId>& variables, const std::vector<Conjunct>& conjuncts,
          const GroundModel& model, PossibleAtoms* possible,
          const std::function<bool(VariableId)>& bound)
      : variables_(variables),
        conjuncts_(conjuncts),
        model_(model),
        typed_(model.typed()),
        possible_(possible),
        bound_outside_(bound) {
    if (possible != nullptr && possible->knows_meetings()) {
      const auto meetings = meetings_in(typed_, conjuncts);
      conjuncts_.insert(conjuncts_.end(), meetings.begin(), meetings.end());
    }
    used_.assign(conjuncts_.size(), false);
    matched_.assign(conjuncts_.size(), false);
  }

  InstancePlan run() && {
    for (;;) {
      if (add_filters() || add_equation()) continue;
      const auto open = open_variables();
      if (open.empty()) break;
      add_match_or_enumeration(open);
    }
    for (const auto& step : plan_.steps) plan_.estimate *= step.fan_out;
    return std::move(plan_);
  }

 private:
  bool bound(VariableId variable) const {
    return bound_here_.contains(variable.index()) || bound_outside_(variable);
  }
  bool bound(TermId term) const {
    const auto all = variables_of(typed_, term);
    return std::all_of(all.begin(), all.end(), [&](VariableId v) { return bound(v); });
  }
  bool bound(const Conjunct& conjunct) const {
    if (conjunct.kind != Conjunct::Kind::kCompare && conjunct.kind != Conjunct::Kind::kAtom &&
        conjunct.kind != Conjunct::Kind::kMeeting) {
      return bound(conjunct.term) &&
             (conjunct.kind != Conjunct::Kind::kEvent || bound(conjunct.time));
    }
    const auto bound_in = [&](TypedFormulaId formula) {
      const auto& terms = typed_.formulas[formula].terms;
      return std::all_of(terms.begin(), terms.end(), [&](TermId term) { return bound(term); });
    };
    return bound_in(conjunct.formula) &&
           (conjunct.kind != Conjunct::Kind::kMeeting || bound_in(conjunct.other));
  }
  std::vector<VariableId> open_variables() const {
    std::vector<VariableId> open;
    for (const auto variable : variables_) {
      if (!bound(variable)) open.push_back(variable);
    }
    return open;
  }
  void bind_all(TermId term) {
    for (const auto variable : variables_of(typed_, term)) bound_here_.insert(variable.index());
  }

  /// Can the values of the term's open variables be read off the term's value?
  bool matchable(TermId root) const {
    std::vector<TermId> todo = {root};
    while (!todo.empty()) {
      const auto id = todo.back();
      todo.pop_back();
      const auto& term = typed_.terms[id];
      if (term.kind != TermKind::kApply && term.kind != TermKind::kArithmetic) continue;
      if (bound(id)) continue;
      if (term.kind == TermKind::kApply) {
        if (typed_.symbols[term.symbol].kind == SymbolKind::kFunction) return false;
        todo.insert(todo.end(), term.arguments.begin(), term.arguments.end());
        continue;
      }
      if (term.op != ArithmeticOp::kAdd && term.op != ArithmeticOp::kSubtract) return false;
      const bool left = bound(term.arguments[0]);
      if (!left && !bound(term.arguments[1])) return false;
      todo.push_back(term.arguments[left ? 1 : 0]);
    }
    return true;
  }

  bool add_filters() {
    bool any = false;
    for (std::size_t i = 0; i < conjuncts_.size(); ++i) {
      if (used_[i] || !bound(conjuncts_[i])) continue;
      used_[i] = any = true;
      const bool compares = conjuncts_[i].kind == Conjunct::Kind::kCompare;
      if (!compares && possible_ == nullptr) continue;
      const bool selects = compares || conjuncts_[i].kind == Conjunct::Kind::kMeeting;
      plan_.steps.push_back(
          {StepKind::kFilter, conjuncts_[i], {}, {}, {}, selects ? kFilterShare : 1.0});
      plan_.is_product = false;
    }
    return any;
  }

  bool add_equation() {
    for (std::size_t i = 0; i < conjuncts_.size(); ++i) {
      const auto& conjunct = conjuncts_[i];
      if (used_[i] || conjunct.kind != Conjunct::Kind::kCompare) continue;
      const auto& formula = typed_.formulas[conjunct.formula];
      const auto equal = conjunct.negated ? CompareOp::kNotEqual : CompareOp::kEqual;
      if (formula.compare != equal) continue;
      for (const bool left : {true, false}) {
        const auto pattern = formula.terms[left ? 0 : 1];
        const auto value = formula.terms[left ? 1 : 0];
        if (!bound(value) || !matchable(pattern)) continue;
        used_[i] = true;
        bind_all(pattern);
        plan_.steps.push_back({StepKind::kSolve, conjunct, pattern, value, {}, 1.0});
        plan_.is_product = false;
        return true;
      }
    }
    return false;
  }

  struct Candidate {
    std::size_t conjunct = 0;
    TermId pattern;
    double fan_out = 0.0;
  };

  /// The table behind an atom, as the pattern that its rows match and their number.
  std::optional<Candidate> candidate(std::size_t i) const {
    const auto& conjunct = conjuncts_[i];
    if (used_[i] || matched_[i] || possible_ == nullptr ||
        conjunct.kind == Conjunct::Kind::kCompare || conjunct.kind == Conjunct::Kind::kFluent ||
        conjunct.kind == Conjunct::Kind::kTime || conjunct.kind == Conjunct::Kind::kMeeting) {
      return std::nullopt;
    }
    TermId pattern = conjunct.term;
    bool is_event = conjunct.kind == Conjunct::Kind::kEvent;
    TermId time = conjunct.time;
    if (conjunct.kind == Conjunct::Kind::kAtom) {
      const auto& formula = typed_.formulas[conjunct.formula];
      const auto& core = typed_.core;
      is_event = formula.predicate == core.happens;
      if (!is_event && formula.predicate != core.holds_at) return predicate_candidate(i);
      pattern = formula.terms[0];
      time = formula.terms[1];
    }
    const auto& term = typed_.terms[pattern];
    if (term.kind != TermKind::kApply || !matchable(pattern)) return std::nullopt;
    const bool timed = is_event && possible_->is_scheduled(term.symbol);
    if (timed && !matchable(time)) return std::nullopt;
    if (bound(pattern) && (!timed || bound(time))) return std::nullopt;
    auto& table = is_event ? possible_->events(term.symbol) : possible_->fluents(term.symbol);
    auto columns = term.arguments;
    if (timed) columns.push_back(time);
    return Candidate{i, pattern, fan_out(table, columns)};
  }

  std::optional<Candidate> predicate_candidate(std::size_t i) const {
    const auto& formula = typed_.formulas[conjuncts_[i].formula];
    auto* table = possible_->predicates(formula.predicate);
    if (table == nullptr) return std::nullopt;
    const std::vector<TermId> columns(
        formula.terms.begin(),
        formula.terms.begin() + static_cast<std::ptrdiff_t>(table->columns()));
    bool open = false;
    for (const auto term : columns) {
      if (!matchable(term)) return std::nullopt;
      open = open || !bound(term);
    }
    if (!open) return std::nullopt;
    return Candidate{i, {}, fan_out(*table, columns)};
  }

  /// Rows per look-up, as if each column of n rows had sqrt(n) different values, evenly spread.
  double fan_out(const GroundTable& table, const std::vector<TermId>& columns) const {
    double rows = static_cast<double>(table.size());
    for (const auto column : columns) {
      if (!bound(column)) continue;
      const double distinct = std::sqrt(static_cast<double>(table.size()));
      rows /= std::max(1.0, distinct);
    }
    return std::max(rows, 0.01);
  }

  void add_match_or_enumeration(const std::vector<VariableId>& open) {
    std::optional<Candidate> best;
    for (std::size_t i = 0; i < conjuncts_.size(); ++i) {
      const auto next = candidate(i);
      if (next && (!best || next->fan_out < best->fan_out)) best = next;
    }
    if (best) {
      // Whether the row's atom may be true at the very timepoint is a filter of its own.
      matched_[best->conjunct] = true;
      const auto& conjunct = conjuncts_[best->conjunct];
      if (conjunct.kind == Conjunct::Kind::kAtom) {
        const auto& terms = typed_.formulas[conjunct.formula].terms;
        // An untimed table does not bind the atom's timepoint.
        const auto count = terms.size() - (binds_time(conjunct) ? 0 : 1);
        for (std::size_t i = 0; i < count; ++i) bind_all(terms[i]);
      } else {
        bind_all(conjunct.term);
        if (conjunct.kind == Conjunct::Kind::kEvent && binds_time(conjunct)) {
          bind_all(conjunct.time);
        }
      }
      plan_.steps.push_back({StepKind::kMatch, conjunct, best->pattern, {}, {}, best->fan_out});
      plan_.is_product = false;
      return;
    }
    const auto size = [&](VariableId variable) {
      return model_.universe().domain(typed_.variables[variable].sort).size();
    };
    // The first of the smallest sorts, so that filters come early.
    auto chosen = open.front();
    for (const auto variable : open) {
      if (size(variable) < size(chosen)) chosen = variable;
    }
    bound_here_.insert(chosen.index());
    plan_.steps.push_back(
        {StepKind::kEnumerate, {}, {}, {}, chosen, static_cast<double>(size(chosen))});
  }

  /// Does matching the conjunct's table determine its timepoint (or last argument) as well?
  bool binds_time(const Conjunct& conjunct) const {
    if (conjunct.kind == Conjunct::Kind::kEvent) {
      return possible_->is_scheduled(typed_.terms[conjunct.term].symbol);
    }
    const auto& formula = typed_.formulas[conjunct.formula];
    if (formula.predicate == typed_.core.holds_at) return false;
    if (formula.predicate == typed_.core.happens) {
      return possible_->is_scheduled(typed_.terms[formula.terms[0]].symbol);
    }
    return possible_->predicates(formula.predicate)->columns() == formula.terms.size();
  }

  const std::vector<VariableId>& variables_;
  std::vector<Conjunct> conjuncts_;
  const GroundModel& model_;
  const TypedModel& typed_;
  PossibleAtoms* possible_;
  const std::function<bool(VariableId)>& bound_outside_;
  std::vector<bool> used_, matched_;  // by conjunct
  std::set<std::uint32_t> bound_here_;
  InstancePlan plan_;
};

}  // namespace

InstancePlan plan_instances(const std::vector<VariableId>& variables,
                            const std::vector<Conjunct>& conjuncts, const GroundModel& model,
                            PossibleAtoms* possible, const std::function<bool(VariableId)>& bound) {
  return Planner(variables, conjuncts, model, possible, bound).run();
}

}  // namespace parallax::compiler
