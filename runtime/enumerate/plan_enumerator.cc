// Traces that end where the state constraints hold for the first time, shortest first.
//
// For each length n the solver assumes "hit at n, no hit before" and finds a valuation; it is
// moved to the first one in canonical order (canonical.cc): first the key (events and returned
// objects), then the initial state, then later states, then the plan's free choices. A prefix
// counts only if the model can continue it to its horizon; prefixes are cheaper to find, so the
// first is settled and then continued, and the literals that keep it from going on are learned
// as a clause. A found key is blocked under the guard of its length, which is retired with the
// length. Two more calls for each trace tell whether other initial states or other outcomes have
// the same key. After the last length one call asks whether some execution goes on beyond the
// horizon.
//
// Where the whole model is loaded from the start, as for a proof, and any order will do, one call
// after the first length asks for all others at once: what contradicts one length mostly
// contradicts its neighbours, and a property that holds is proved by one search instead of many.
//
// Cost: per trace one search for the canonical valuation and a few calls; blocking clauses add
// up within a length.

#include "runtime/enumerate/plan_enumerator.h"

#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/enumerate/canonical.h"

namespace parallax::runtime {
namespace {

using compiler::FluentId;

/// The fluents in groups: two are in one if a chain of clauses connects them at timepoint 0, each
/// clause being about the state there alone (with auxiliary variables). A fluent that is false in
/// every trace is in no group.
std::vector<std::vector<FluentId>> connected_at_start(const compiler::CompiledModel& model,
                                                      std::span<const FluentId> fluents) {
  std::map<std::int32_t, FluentId> told;  // by variable
  for (const auto fluent : fluents) {
    if (const auto literal = model.holds_at(fluent, 0)) told.emplace(literal->var(), fluent);
  }
  std::set<std::int32_t> others;  // atoms that are not about the state at 0
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    using Kind = compiler::AtomKind;
    const bool at_start = atom.kind == Kind::kHoldsAt && atom.time == 0;
    if (!at_start && atom.kind != Kind::kAuxiliary) others.insert(atom.variable);
  });
  std::map<std::int32_t, std::int32_t> parent;
  const auto root = [&](std::int32_t variable) {
    parent.try_emplace(variable, variable);
    while (parent.at(variable) != variable) {
      auto& up = parent.at(variable);
      up = parent.at(up);
      variable = up;
    }
    return variable;
  };
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const auto clause = model.clauses[i];
    const bool is_at_start = std::none_of(clause.begin(), clause.end(), [&](const auto literal) {
      return others.contains(literal.var());
    });
    if (!is_at_start || clause.empty()) continue;
    const auto first = root(clause.front().var());
    for (const auto literal : clause) parent.at(root(literal.var())) = first;
  }
  std::map<std::int32_t, std::vector<FluentId>> groups;
  for (const auto& [variable, fluent] : told) groups[root(variable)].push_back(fluent);
  std::vector<std::vector<FluentId>> out;
  for (auto& [variable, group] : groups) {
    std::sort(group.begin(), group.end());
    out.push_back(std::move(group));
  }
  return out;
}

}  // namespace

using compiler::AtomKind;

PlanEnumerator::PlanEnumerator(SolverSession& session, const PlanEnumeratorOptions& options)
    : session_(&session),
      options_(options),
      index_(session.model()),
      symbols_(symbols_of(session.model())) {
  PARALLAX_REQUIRE(session.model().has_constraints, "the model was compiled with constraints");
  if (index_.hit(0)) first_ = 0;
  n_ = first_ - 1;
  if (options.symmetry != nullptr && !options.symmetry->empty()) {
    const auto& symmetry = *options.symmetry;
    breaker_.emplace(session, options.representatives ? symmetry.generators() : symmetry.all(),
                     order_by_horizon(session.model()));
  }
}

/// The assumption that restricts the search to representatives, at the length at hand. Once a trace
/// was found, the remaining traces tell constants apart.
std::optional<Literal> PlanEnumerator::breaking() {
  if (!breaker_ || (found_ > 0 && !options_.representatives)) return std::nullopt;
  session_->load(n_);
  breaker_->extend(static_cast<std::size_t>(n_) + 1);
  return breaker_->assumption();
}

/// Where the first length has no trace and the whole model is loaded anyway, as for a proof that
/// there is none. A plan's clauses end with the trace, so lengths do not share them.
bool PlanEnumerator::asks_all_lengths() const {
  const auto& model = session_->model();
  return n_ == first_ && n_ < model.horizon && session_->loaded() == model.horizon &&
         options_.order == TraceOrder::kAny && !breaker_ && !has_ending_clauses(model);
}

/// One call for all lengths beyond n.
bool PlanEnumerator::may_hit_after(Timepoint n) {
  std::map<Timepoint, Literal> hits;
  for (Timepoint t = n + 1; t <= session_->model().horizon; ++t) hits.emplace(t, *index_.hit(t));
  return session_->solve_some_length(hits) != SolveStatus::kUnsatisfiable;
}

void PlanEnumerator::note_refuted(std::optional<Literal> breaking) {
  by_symmetry_ = by_symmetry_ || (breaking && session_->failed(*breaking));
}

/// Hit at n and, unless all hits count, at no earlier timepoint.
std::vector<Literal> PlanEnumerator::hit_at(Timepoint n) const {
  std::vector<Literal> literals;
  for (Timepoint t = options_.all_hits ? n : first_; t <= n; ++t) {
    const auto hit = index_.hit(t);
    PARALLAX_REQUIRE(hit.has_value(), "every timepoint from the first has its hit atom");
    literals.push_back(t < n ? ~*hit : *hit);
  }
  return literals;
}

PlanEnumerator::Orders PlanEnumerator::orders_of(Timepoint n) const {
  Orders out;
  std::map<std::pair<Timepoint, compiler::PlanAtom>, Literal> results;
  session_->model().for_each_atom([&](const compiler::AtomRef& atom) {
    const auto literal = atom.literal();
    const auto time = atom.time.value_or(0);
    if (atom.kind == AtomKind::kHappens && time < n) out.key.push_back(literal);
    if (atom.kind == AtomKind::kResult && time <= n) {
      results.emplace(std::pair(time, atom.plan), literal);
    }
    if (std::holds_alternative<compiler::PlanChoiceId>(atom.plan) && time <= n) {
      out.choice.push_back(literal);
    }
    if (atom.kind != AtomKind::kHoldsAt || time > n) return;
    (time == 0 ? out.start : out.state).push_back(~literal);
  });
  for (const auto& [what, literal] : results) out.key.push_back(literal);
  return out;
}

/// `assumptions` and, in their order, the literals of a valuation up to `n`, which the session
/// holds. None: the solver was stopped.
std::optional<std::vector<Literal>> PlanEnumerator::settle(Timepoint n, const Orders& orders,
                                                           const std::vector<Literal>& assumptions,
                                                           const std::vector<Literal>& searched) {
  auto fixed = assumptions;
  for (const auto* order : {&orders.key, &orders.start, &orders.state, &orders.choice}) {
    // Which key it is, is asked of representatives, unless the first is wanted, which need not be
    // the first of those; what belongs to the key, of all.
    const bool first = options_.order == TraceOrder::kCanonical && !options_.representatives;
    const auto& under = order == &orders.key && !first ? searched : fixed;
    const auto found = in_order(*session_, n, under, *order, options_.order);
    if (!found) return std::nullopt;
    fixed.insert(fixed.end(), found->literals.begin(), found->literals.end());
  }
  return fixed;
}

/// The next trace of length `n` as `settle` makes it. It is looked for among prefixes, which are
/// cheaper: the first one that the model can continue to its horizon is the first trace. What keeps
/// another from going on is learned as a clause.
SolveStatus PlanEnumerator::find_settled(Timepoint n, const Orders& orders,
                                         const std::vector<Literal>& assumptions,
                                         const std::vector<Literal>& searched,
                                         std::vector<Literal>& fixed) {
  auto status = session_->solve(n, searched);
  for (bool known = false; status == SolveStatus::kSatisfiable; known = true) {
    const auto settled = settle(n, orders, assumptions, searched);
    if (!settled) return SolveStatus::kUnknown;
    status = session_->solve_whole(n, *settled);
    if (status != SolveStatus::kUnsatisfiable) {
      fixed = *settled;
      return status;
    }
    std::vector<Literal> dead;
    for (const auto literal : *settled) {
      if (session_->failed(literal)) dead.push_back(~literal);
    }
    if (!known || options_.order != TraceOrder::kCanonical) {
      status = session_->solve_whole(n, searched);
      if (status == SolveStatus::kUnsatisfiable && !dead_end_) dead_end_ = n;
      if (status != SolveStatus::kSatisfiable) return status;
    }
    session_->add_clause(dead);
    // In any order the valuation at hand does.
    if (options_.order == TraceOrder::kCanonical) status = session_->solve(n, searched);
  }
  return status;
}

std::optional<Trace> PlanEnumerator::next() {
  while (!done_) {
    if (!guard_) {
      if (n_ == session_->model().horizon) {
        finish();
        return std::nullopt;
      }
      if (n_ == 0 && first_ == 1 && !note_cuts(0)) return std::nullopt;
      orders_ = orders_of(++n_);
      guard_ = session_->lengths().ends(n_);
    }
    auto assumptions = hit_at(n_);
    assumptions.push_back(*guard_);
    auto searched = assumptions;
    const auto broken = breaking();
    if (broken) searched.push_back(*broken);
    std::vector<Literal> fixed;
    const auto status = find_settled(n_, orders_, assumptions, searched, fixed);
    if (status == SolveStatus::kUnknown) {
      done_ = true;
      return std::nullopt;
    }
    if (status == SolveStatus::kUnsatisfiable) {
      note_refuted(broken);
      // Nothing of this length is left: its blocking clauses are of no use to longer ones.
      const auto retired = ~*guard_;
      session_->add_clause(std::span(&retired, 1));
      guard_.reset();
      if (!note_cuts(n_)) return std::nullopt;
      if (asks_all_lengths() && !may_hit_after(n_)) n_ = session_->model().horizon;
      continue;
    }
    const auto head = assumptions.size();
    auto trace = decode_trace(session_->model(), symbols_, n_,
                              [&](Literal literal) { return session_->value(literal); });
    trace.number = ++found_;
    note_alternatives(fixed, head, trace);
    const auto named = orders_.key.size() + (options_.split_initial ? orders_.start.size() : 0);
    std::vector<Literal> blocking;
    for (const auto literal : std::span(fixed).subspan(head, named)) blocking.push_back(~literal);
    blocking.push_back(~*guard_);
    session_->add_clause(blocking);
    return trace;
  }
  return std::nullopt;
}

/// Is there a valuation with the fixed literals in which some literal of `different` is false?
base::Known PlanEnumerator::has_alternative(Timepoint n, std::span<const Literal> fixed,
                                            std::span<const Literal> different) {
  const auto wanted = session_->new_variable();
  std::vector<Literal> clause = {~wanted};
  for (const auto literal : different) clause.push_back(~literal);
  session_->add_clause(clause);
  std::vector<Literal> assumptions(fixed.begin(), fixed.end());
  assumptions.push_back(wanted);
  const auto status = session_->solve_whole(n, assumptions);
  const auto retired = ~wanted;
  session_->add_clause(std::span(&retired, 1));
  return possible(status);
}

/// `fixed`: `length` literals that define the length, then the key, the initial state and the
/// states after it.
void PlanEnumerator::note_alternatives(std::span<const Literal> fixed, std::size_t length,
                                       Trace& trace) {
  const auto head = length + orders_.key.size();
  const auto start = fixed.subspan(head, orders_.start.size());
  const auto states = fixed.subspan(head + start.size(), orders_.state.size());
  if (!options_.split_initial) {
    trace.other_initial_states = has_alternative(n_, fixed.first(head), start);
  }
  trace.other_outcomes = has_alternative(n_, fixed.first(head + start.size()), states);
}

std::vector<Literal> PlanEnumerator::key_of(const Trace& trace) const {
  const auto n = trace.length();
  auto out = hit_at(n);
  session_->model().for_each_atom([&](const compiler::AtomRef& atom) {
    const auto literal = atom.literal();
    const auto time = atom.time.value_or(0);
    if (atom.kind == AtomKind::kHappens && time < n) {
      const auto& point = trace.points[static_cast<std::size_t>(time)];
      out.push_back(contains(point.happens, atom.event()) ? literal : ~literal);
    } else if (atom.kind == AtomKind::kResult && time <= n) {
      const auto& point = trace.points[static_cast<std::size_t>(time) - 1];
      const auto* returned = std::get_if<compiler::ReturnedObject>(&atom.plan);
      const bool is_true = returned != nullptr && point.returned == returned->object;
      out.push_back(is_true ? literal : ~literal);
    }
  });
  return out;
}

base::Known PlanEnumerator::admits(const Trace& trace,
                                   const std::vector<std::map<compiler::FluentId, bool>>& observed,
                                   const std::vector<compiler::FluentId>* start_fluents) {
  const auto n = trace.length();
  // A fluent without a variable is false in every trace.
  for (const auto& state : observed) {
    for (const auto& [fluent, holds] : state) {
      if (holds && !session_->model().fluents[fluent.index()].slot) return base::Known::kNo;
    }
  }
  const auto is_fixed = [&](compiler::FluentId fluent) {
    return start_fluents == nullptr ||
           std::binary_search(start_fluents->begin(), start_fluents->end(), fluent);
  };
  auto assumptions = key_of(trace);
  session_->model().for_each_atom([&](const compiler::AtomRef& atom) {
    const auto time = atom.time.value_or(0);
    if (atom.kind != AtomKind::kHoldsAt || time > n) return;
    const auto literal = atom.literal();
    if (time == 0) {
      const bool holds = contains(trace.points.front().holds, atom.fluent());
      if (is_fixed(atom.fluent())) assumptions.push_back(holds ? literal : ~literal);
      return;
    }
    const auto& state = observed[static_cast<std::size_t>(time)];
    const auto wanted = state.find(atom.fluent());
    if (wanted == state.end()) return;
    assumptions.push_back(wanted->second ? literal : ~literal);
  });
  return possible(session_->solve_whole(n, assumptions));
}

InitialStates PlanEnumerator::initial_states(const Trace& trace,
                                             std::span<const compiler::FluentId> fluents,
                                             std::size_t limit) {
  const auto n = trace.length();
  const auto& model = session_->model();
  std::vector<std::pair<compiler::FluentId, Literal>> told;
  for (const auto fluent : fluents) {
    if (const auto literal = model.holds_at(fluent, 0)) told.emplace_back(fluent, *literal);
  }
  auto assumptions = key_of(trace);
  const auto others = session_->new_variable();  // switches the blocking clauses on
  assumptions.push_back(others);
  InitialStates out;
  for (;;) {
    const auto status = session_->solve_whole(n, assumptions);
    out.stopped = status == SolveStatus::kUnknown;
    if (status != SolveStatus::kSatisfiable) break;
    out.more = out.states.size() == limit;
    if (out.more) break;
    auto& state = out.states.emplace_back();
    std::vector<Literal> blocking = {~others};
    for (const auto& [fluent, literal] : told) {
      const bool holds = session_->value(literal);
      if (holds) state.push_back(fluent);
      blocking.push_back(holds ? ~literal : literal);
    }
    std::sort(state.begin(), state.end());
    session_->add_clause(blocking);
  }
  const auto retired = ~others;
  session_->add_clause(std::span(&retired, 1));
  std::sort(out.states.begin(), out.states.end());
  return out;
}

std::optional<std::vector<std::vector<std::vector<compiler::FluentId>>>>
PlanEnumerator::initial_parts(const Trace& trace, std::span<const compiler::FluentId> fluents,
                              std::size_t limit) {
  std::vector<std::vector<std::vector<compiler::FluentId>>> out;
  for (const auto& group : connected_at_start(session_->model(), fluents)) {
    auto values = initial_states(trace, group, limit);
    if (values.stopped) return std::nullopt;
    if (values.more) return out = {}, out;
    out.push_back(std::move(values.states));
  }
  return out;
}

TraceFrom PlanEnumerator::from(const Trace& trace, std::span<const compiler::FluentId> fluents,
                               const std::vector<compiler::FluentId>& state) {
  const auto n = trace.length();
  auto start = key_of(trace);
  for (const auto fluent : fluents) {
    const auto literal = session_->model().holds_at(fluent, 0);
    const bool holds = contains(state, fluent);
    if (holds && !literal) return {base::Known::kNo, std::nullopt};
    if (literal) start.push_back(holds ? *literal : ~*literal);
  }
  auto orders = orders_of(n);
  orders.key.clear();
  const auto dead_end = dead_end_;  // is about keys
  std::vector<Literal> fixed;
  const auto status = find_settled(n, orders, start, start, fixed);
  dead_end_ = dead_end;
  TraceFrom out{possible(status), std::nullopt};
  if (status != SolveStatus::kSatisfiable) return out;
  out.trace = decode_trace(session_->model(), symbols_, n,
                           [&](Literal literal) { return session_->value(literal); });
  out.trace->number = trace.number;
  const auto states =
      std::span(fixed).subspan(start.size() + orders.start.size(), orders.state.size());
  out.trace->other_outcomes = has_alternative(n, start, states);
  if (out.trace->other_outcomes == base::Known::kUndecided) return {};
  return out;
}

/// No hit up to `n`, unless all hits count.
std::vector<Literal> PlanEnumerator::no_hit_until(Timepoint n) const {
  std::vector<Literal> unmet;
  for (Timepoint t = first_; t <= n && !options_.all_hits; ++t) {
    unmet.push_back(~*index_.hit(t));
  }
  return unmet;
}

}  // namespace parallax::runtime
