#include "runtime/enumerate/plan_enumerator.h"

#include <algorithm>

#include "runtime/enumerate/canonical.h"

namespace parallax::runtime {

using compiler::AtomKind;

std::string_view to_string(Exploration exploration) {
  switch (exploration) {
    case Exploration::kStopped:
      return "stopped";
    case Exploration::kCompleteUpToBound:
      return "complete up to bound";
    case Exploration::kAllTracesExplored:
      return "all traces explored";
  }
  return {};
}

PlanEnumerator::PlanEnumerator(SolverSession& session)
    : session_(&session), index_(session.model()) {
  PARALLAX_REQUIRE(session.model().has_constraints, "the model was compiled with constraints");
}

/// Hit at n and at no earlier timepoint but 0: an execution has at least one step.
std::vector<Literal> PlanEnumerator::first_hit(Timepoint n) const {
  std::vector<Literal> literals;
  for (Timepoint t = 1; t <= n; ++t) {
    const auto hit = index_.find(AtomKind::kHit, "hit", t);
    PARALLAX_REQUIRE(hit.has_value(), "every timepoint from 1 has its hit atom");
    literals.push_back(t < n ? ~*hit : *hit);
  }
  return literals;
}

void PlanEnumerator::prepare_orders(Timepoint n) {
  event_order_.clear();
  start_order_.clear();
  state_order_.clear();
  session_->model().for_each_atom(
      [&](std::int32_t variable, AtomKind kind, const std::string&, std::optional<Timepoint> when) {
        const auto literal = Literal::positive(variable);
        const auto time = when.value_or(0);
        if (kind == AtomKind::kHappens && time < n) event_order_.push_back(literal);
        if (kind != AtomKind::kHoldsAt || time > n) return;
        (time == 0 ? start_order_ : state_order_).push_back(~literal);
      });
}

std::optional<Trace> PlanEnumerator::next() {
  while (!done_) {
    if (!guard_) {
      if (n_ == session_->model().horizon) {
        finish();
        return std::nullopt;
      }
      prepare_orders(++n_);
      guard_ = session_->new_variable();
    }
    auto assumptions = first_hit(n_);
    assumptions.push_back(*guard_);
    const auto status = session_->solve(n_, assumptions);
    if (status == SolveStatus::kUnknown) {
      done_ = true;
      return std::nullopt;
    }
    if (status == SolveStatus::kUnsatisfiable) {
      // Nothing of this length is left: its blocking clauses are of no use to longer ones.
      const auto retired = ~*guard_;
      session_->add_clause(std::span(&retired, 1));
      guard_.reset();
      continue;
    }
    auto fixed = std::move(assumptions);
    const auto extend = [&](const std::vector<Literal>& order) {
      auto literals = make_canonical(*session_, n_, fixed, order);
      fixed.insert(fixed.end(), literals.begin(), literals.end());
      return literals;
    };
    auto key = extend(event_order_);
    extend(start_order_);
    extend(state_order_);
    if (fixed.size() != static_cast<std::size_t>(n_) + 1 + event_order_.size() +
                            start_order_.size() + state_order_.size()) {
      done_ = true;  // the solver was stopped on the way
      return std::nullopt;
    }
    auto trace = decode_trace(session_->model(), n_,
                              [&](Literal literal) { return session_->value(literal); });
    trace.number = ++found_;
    note_alternatives(fixed, trace);
    for (auto& literal : key) literal = ~literal;
    key.push_back(~*guard_);
    session_->add_clause(key);
    return trace;
  }
  return std::nullopt;
}

/// Is there a valuation with the fixed literals in which some literal of `different` is false?
bool PlanEnumerator::has_alternative(std::span<const Literal> fixed,
                                     std::span<const Literal> different) {
  const auto wanted = session_->new_variable();
  std::vector<Literal> clause = {~wanted};
  for (const auto literal : different) clause.push_back(~literal);
  session_->add_clause(clause);
  std::vector<Literal> assumptions(fixed.begin(), fixed.end());
  assumptions.push_back(wanted);
  const bool found = session_->solve(n_, assumptions) == SolveStatus::kSatisfiable;
  const auto retired = ~wanted;
  session_->add_clause(std::span(&retired, 1));
  return found;
}

/// `fixed`: what defines the length, then the events, the initial state and the states after it.
void PlanEnumerator::note_alternatives(std::span<const Literal> fixed, Trace& trace) {
  const auto head = static_cast<std::size_t>(n_) + 1 + event_order_.size();
  const auto start = fixed.subspan(head, start_order_.size());
  const auto states = fixed.subspan(head + start.size());
  trace.other_initial_states = has_alternative(fixed.first(head), start);
  trace.other_outcomes = has_alternative(fixed.first(head + start.size()), states);
}

bool PlanEnumerator::admits(const Trace& trace, const std::map<std::string, bool>& last_state) {
  const auto n = trace.length();
  auto assumptions = first_hit(n);
  // What has no variable is false in every trace.
  for (const auto& fluent : session_->model().fluents) {
    const auto wanted = last_state.find(fluent.name);
    if (!fluent.slot && wanted != last_state.end() && wanted->second) return false;
  }
  session_->model().for_each_atom([&](std::int32_t variable, AtomKind kind, const std::string& name,
                                      std::optional<Timepoint> when) {
    const auto literal = Literal::positive(variable);
    const auto time = when.value_or(0);
    const auto among = [&](const std::vector<std::string>& names) {
      return std::binary_search(names.begin(), names.end(), name);
    };
    if (kind == AtomKind::kHappens && time < n) {
      const auto& point = trace.points[static_cast<std::size_t>(time)];
      assumptions.push_back(among(point.happens) ? literal : ~literal);
    } else if (kind == AtomKind::kHoldsAt && time == 0) {
      assumptions.push_back(among(trace.points.front().holds) ? literal : ~literal);
    } else if (kind == AtomKind::kHoldsAt && time == n) {
      const auto wanted = last_state.find(name);
      if (wanted == last_state.end()) return;
      assumptions.push_back(wanted->second ? literal : ~literal);
    }
  });
  return session_->solve(n, assumptions) == SolveStatus::kSatisfiable;
}

/// Is there an execution that never meets the constraints and goes on beyond the horizon?
void PlanEnumerator::finish() {
  done_ = true;
  std::vector<Literal> assumptions;
  for (Timepoint t = 1; t <= n_; ++t) {
    assumptions.push_back(~*index_.find(AtomKind::kHit, "hit", t));
  }
  const auto running = index_.find(AtomKind::kRunning, "running", n_);
  if (running) assumptions.push_back(*running);
  switch (session_->solve(n_, assumptions)) {
    case SolveStatus::kSatisfiable:
      exploration_ = Exploration::kCompleteUpToBound;
      break;
    case SolveStatus::kUnsatisfiable:
      exploration_ = Exploration::kAllTracesExplored;
      break;
    case SolveStatus::kUnknown:
      exploration_ = Exploration::kStopped;
      break;
  }
}

}  // namespace parallax::runtime
