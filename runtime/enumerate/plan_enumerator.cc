#include "runtime/enumerate/plan_enumerator.h"

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
  state_order_.clear();
  const auto& atoms = session_->model().atoms;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const auto literal = Literal::positive(static_cast<std::int32_t>(i + 1));
    const auto time = atoms[i].time.value_or(0);
    if (atoms[i].kind == AtomKind::kHappens && time < n) event_order_.push_back(literal);
    if (atoms[i].kind == AtomKind::kHoldsAt && time <= n) state_order_.push_back(~literal);
  }
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
    auto key = make_canonical(*session_, n_, assumptions, event_order_);
    auto fixed = assumptions;
    fixed.insert(fixed.end(), key.begin(), key.end());
    make_canonical(*session_, n_, fixed, state_order_);
    auto trace = decode_trace(session_->model(), n_,
                              [&](Literal literal) { return session_->value(literal); });
    trace.number = ++found_;
    for (auto& literal : key) literal = ~literal;
    key.push_back(~*guard_);
    session_->add_clause(key);
    return trace;
  }
  return std::nullopt;
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
