// Truth of a temporal formula at every timepoint of a finite trace, by the definition.
//
// The value of a part is a list, one truth value for each timepoint, none where the part names
// something that does not exist. Leaves are instantiated and evaluated for each timepoint;
// quantifiers, connectives and operators combine the lists of their parts. Always, Until and
// their like look at all the timepoints that their definitions name, not at a recurrence from
// the next one: this is the reference. Why a formula is false is found by going down to the part
// and the timepoint that decide.
//
// Cost: for n timepoints n^2 for an operator, n^3 for Until and Since, times the instances of
// the quantifiers around it; a budget limits them.

#include "compiler/reference/temporal_truth.h"

#include <algorithm>

namespace parallax::compiler {
namespace {

template <typename Is>
bool has_operator_that(const TypedModel& model, TypedFormulaId root, const Is& is) {
  std::vector<TypedFormulaId> todo = {root};
  while (!todo.empty()) {
    const auto& formula = model.formulas[todo.back()];
    todo.pop_back();
    if (formula.kind == FormulaKind::kTemporal && is(formula.temporal)) return true;
    todo.insert(todo.end(), formula.children.begin(), formula.children.end());
  }
  return false;
}

bool has_operator(const TypedModel& model, TypedFormulaId formula) {
  return has_operator_that(model, formula, [](TemporalOp) { return true; });
}

}  // namespace

bool only_looks_back(const TypedModel& model, TypedFormulaId formula) {
  return !has_operator_that(model, formula, [](TemporalOp op) {
    return op <= TemporalOp::kWeakNext || op == TemporalOp::kUntil;
  });
}

bool waits_for_end(const TypedModel& model, TypedFormulaId formula) {
  struct Task {
    TypedFormulaId formula;
    bool is_positive = true;
  };
  std::vector<Task> todo = {{formula, true}};
  while (!todo.empty()) {
    const auto task = todo.back();
    todo.pop_back();
    const auto& one = model.formulas[task.formula];
    const bool has_promise = task.is_positive ? one.temporal == TemporalOp::kEventually ||
                                                    one.temporal == TemporalOp::kUntil
                                              : one.temporal == TemporalOp::kAlways;
    if (one.kind == FormulaKind::kTemporal && has_promise) return true;
    for (std::size_t i = 0; i < one.children.size(); ++i) {
      const bool flips =
          one.kind == FormulaKind::kNot || (one.kind == FormulaKind::kImplies && i == 0);
      todo.push_back({one.children[i], task.is_positive != flips});
      if (one.kind == FormulaKind::kIff) todo.push_back({one.children[i], !task.is_positive});
    }
  }
  return false;
}

TemporalTruth::TemporalTruth(const TypedModel& model, const ReferenceLimits& limits)
    : model_(model),
      limits_(limits),
      budget_(limits.max_instances, limits.stop),
      expander_(model, budget_, expanded_) {
  expander_.begin();
  expander_.end_events();
}

std::optional<std::string> TemporalTruth::refusal() const {
  if (expanded_.too_deep()) return "its formulas nest too deep";
  if (!budget_.spent()) return std::nullopt;
  if (limits_.stop != nullptr && limits_.stop->load()) return "the check was stopped";
  return "the formula has more than " + std::to_string(limits_.max_instances) +
         " ground terms and instances";
}

void TemporalTruth::look_at(std::optional<VariableId> time, const Valuation& trace) {
  trace_ = &trace;
  time_ = time;
  atoms_.clear();
}

TemporalTruth::Values TemporalTruth::values(TypedFormulaId formula, std::optional<VariableId> time,
                                            const Valuation& trace) {
  look_at(time, trace);
  return of(formula);
}

TemporalTruth::Values TemporalTruth::of(TypedFormulaId id) {
  if (!budget_.spend(last() + 1)) return Values(trace_->holds.size());
  if (!has_operator(model_, id)) return leaf(id);
  const auto& formula = model_.formulas[id];
  if (formula.kind == FormulaKind::kTemporal) return temporal(formula);
  if (formula.kind == FormulaKind::kForall || formula.kind == FormulaKind::kExists) {
    return quantified(formula, 0);
  }
  return connected(formula);
}

TemporalTruth::Values TemporalTruth::leaf(TypedFormulaId formula) {
  Values out;
  for (std::int64_t t = 0; t <= last(); ++t) {
    if (time_) expander_.bind(*time_, std::to_string(t));
    const auto node = budget_.spent() ? std::nullopt : expander_.instance(formula);
    if (atoms_.size() != expanded_.atom_count()) atoms_ = atom_values(expanded_, *trace_);
    out.push_back(node ? std::optional(expanded_.trees().value(*node, atoms_)) : std::nullopt);
  }
  return out;
}

/// Instances that do not exist are left out; if none exists, neither does the whole.
TemporalTruth::Values TemporalTruth::quantified(const TypedFormula& formula, std::size_t variable) {
  if (variable == formula.variables.size()) return of(formula.children[0]);
  const bool all = formula.kind == FormulaKind::kForall;
  const auto domain = expander_.values(formula.variables[variable]);
  Values out(trace_->holds.size());
  if (domain.empty()) out.assign(out.size(), all);
  for (const auto& value : domain) {
    expander_.bind(formula.variables[variable], value);
    const auto instance = quantified(formula, variable + 1);
    for (std::size_t t = 0; t < out.size(); ++t) {
      if (!instance[t]) continue;
      out[t] = all ? out[t].value_or(true) && *instance[t] : out[t].value_or(false) || *instance[t];
    }
  }
  return out;
}

TemporalTruth::Values TemporalTruth::connected(const TypedFormula& formula) {
  std::vector<Values> parts;
  for (const auto child : formula.children) parts.push_back(of(child));
  Values out(trace_->holds.size());
  for (std::size_t t = 0; t < out.size(); ++t) {
    std::size_t count = 0, is_true = 0;
    for (const auto& part : parts) {
      if (!part[t]) continue;
      ++count;
      if (*part[t]) ++is_true;
    }
    if (count < parts.size()) continue;
    if (formula.kind == FormulaKind::kNot) out[t] = is_true == 0;
    if (formula.kind == FormulaKind::kAnd) out[t] = is_true == count;
    if (formula.kind == FormulaKind::kOr) out[t] = is_true > 0;
    if (formula.kind == FormulaKind::kImplies) out[t] = !*parts[0][t] || *parts[1][t];
    if (formula.kind == FormulaKind::kIff) out[t] = *parts[0][t] == *parts[1][t];
  }
  return out;
}

TemporalTruth::Values TemporalTruth::temporal(const TypedFormula& formula) {
  const auto a = of(formula.children[0]);
  const auto b = formula.children.size() > 1 ? of(formula.children[1]) : Values();
  const auto size = static_cast<std::int64_t>(a.size());
  const auto at = [](const Values& values, std::int64_t t) {
    return values[static_cast<std::size_t>(t)];
  };
  // Is it so at all (at some) timepoints from first to last?
  const auto all = [&](const Values& values, std::int64_t first, std::int64_t last) {
    bool found = true;
    for (auto t = first; t <= last; ++t) found = found && at(values, t).value_or(true);
    return found;
  };
  const auto some = [&](const Values& values, std::int64_t first, std::int64_t last) {
    bool found = false;
    for (auto t = first; t <= last; ++t) found = found || at(values, t).value_or(false);
    return found;
  };
  Values out;
  for (std::int64_t t = 0; t < size; ++t) {
    bool found = false;
    switch (formula.temporal) {
      case TemporalOp::kAlways:
        out.emplace_back(all(a, t, size - 1));
        break;
      case TemporalOp::kEventually:
        out.emplace_back(some(a, t, size - 1));
        break;
      case TemporalOp::kHistorically:
        out.emplace_back(all(a, 0, t));
        break;
      case TemporalOp::kOnce:
        out.emplace_back(some(a, 0, t));
        break;
      case TemporalOp::kNext:
        out.push_back(t + 1 < size ? at(a, t + 1) : std::optional(false));
        break;
      case TemporalOp::kWeakNext:
        out.push_back(t + 1 < size ? at(a, t + 1) : std::optional(true));
        break;
      case TemporalOp::kPreviously:
        out.push_back(t > 0 ? at(a, t - 1) : std::optional(false));
        break;
      case TemporalOp::kUntil:
        for (auto k = t; k < size; ++k) {
          found = found || (at(b, k).value_or(false) && all(a, t, k - 1));
        }
        out.emplace_back(found);
        break;
      case TemporalOp::kSince:
        for (auto k = t; k >= 0; --k) {
          found = found || (at(b, k).value_or(false) && all(a, k + 1, t));
        }
        out.emplace_back(found);
        break;
    }
  }
  return out;
}

// --- where it breaks -------------------------------------------------------------------------

TemporalBreak TemporalTruth::why_false(TypedFormulaId formula, std::int64_t t,
                                       std::optional<VariableId> time, const Valuation& trace) {
  look_at(time, trace);
  for (;;) {
    if (auto found = step(formula, t)) return *std::move(found);
  }
}

/// Goes on to the part that decides, or describes why the formula itself is false.
std::optional<TemporalBreak> TemporalTruth::step(TypedFormulaId& id, std::int64_t& t) {
  const auto& formula = model_.formulas[id];
  const auto here = [&](std::string text, std::int64_t at) {
    return TemporalBreak{formula.source, at, std::move(text)};
  };
  const auto at_t = " at timepoint " + std::to_string(t);
  const auto go = [&](std::size_t child, std::int64_t to) {
    id = formula.children[child];
    t = to;
    return std::optional<TemporalBreak>();
  };
  const auto is_false = [](const Values& values, std::int64_t at) {
    const auto& value = values[static_cast<std::size_t>(at)];
    return value && !*value;
  };
  const auto whole = here("does not hold" + at_t, t);
  if (!has_operator(model_, id)) return whole;
  if (formula.kind == FormulaKind::kAnd) {
    for (std::size_t i = 0; i < formula.children.size(); ++i) {
      if (is_false(of(formula.children[i]), t)) return go(i, t);
    }
    return whole;
  }
  if (formula.kind == FormulaKind::kImplies) return go(1, t);
  if (formula.kind != FormulaKind::kTemporal) return whole;
  const auto child = of(formula.children[0]);
  switch (formula.temporal) {
    case TemporalOp::kAlways:
      for (auto k = t; k <= last(); ++k) {
        if (is_false(child, k)) return go(0, k);
      }
      return whole;
    case TemporalOp::kHistorically:
      for (auto k = t; k >= 0; --k) {
        if (is_false(child, k)) return go(0, k);
      }
      return whole;
    case TemporalOp::kEventually:
      return here("is not met from timepoint " + std::to_string(t) + " to the end, timepoint " +
                      std::to_string(last()),
                  t);
    case TemporalOp::kOnce:
      return here("is not met from the start to timepoint " + std::to_string(t), t);
    case TemporalOp::kNext:
      if (t == last())
        return here("asks for a timepoint after the last one, " + std::to_string(t), t);
      return go(0, t + 1);
    case TemporalOp::kWeakNext:
      return go(0, t + 1);
    case TemporalOp::kPreviously:
      if (t == 0) return here("asks for a timepoint before 0", t);
      return go(0, t - 1);
    case TemporalOp::kUntil:
    case TemporalOp::kSince:
      return until_step(formula, t);
  }
  return whole;
}

std::optional<TemporalBreak> TemporalTruth::until_step(const TypedFormula& formula,
                                                       std::int64_t t) {
  const bool until = formula.temporal == TemporalOp::kUntil;
  const auto a = of(formula.children[0]), b = of(formula.children[1]);
  const auto end = until ? last() : std::int64_t{0};
  const auto on = until ? 1 : -1;
  for (auto k = t;; k += on) {
    const auto at = static_cast<std::size_t>(k);
    // The right side has not been met up to here, or this would not be false.
    if (a[at] && !*a[at] && !b[at].value_or(false)) {
      return TemporalBreak{
          model_.formulas[formula.children[0]].source, k,
          "does not hold at timepoint " + std::to_string(k) +
              (until ? ", and what it should last until was not met by then"
                     : ", and what it should have lasted since was not met after")};
    }
    if (k == end) break;
  }
  return TemporalBreak{model_.formulas[formula.children[1]].source, t,
                       until ? "is not met from timepoint " + std::to_string(t) +
                                   " to the end, timepoint " + std::to_string(last())
                             : "is not met from the start to timepoint " + std::to_string(t)};
}

}  // namespace parallax::compiler
