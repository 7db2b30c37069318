#include "runtime/enumerate/model_enumerator.h"

#include "runtime/enumerate/canonical.h"
#include "runtime/enumerate/projection.h"

namespace parallax::runtime {

ModelEnumerator::ModelEnumerator(SolverSession& session, Distinct distinct) : session_(&session) {
  for (const auto& block : projection_blocks(session.model(), distinct)) {
    for (const auto atom : block) order_.push_back(~atom);
  }
}

std::optional<Trace> ModelEnumerator::next() {
  const auto n = session_->model().horizon;
  if (exhausted_) return std::nullopt;
  const auto status = session_->solve(n, {});
  exhausted_ = status == SolveStatus::kUnsatisfiable;
  if (status != SolveStatus::kSatisfiable) return std::nullopt;
  auto blocking = make_canonical(*session_, n, {}, order_);
  if (!blocking) return std::nullopt;
  session_->require_model(n);
  auto trace =
      decode_trace(session_->model(), n, [&](Literal literal) { return session_->value(literal); });
  trace.number = ++found_;
  for (auto& literal : *blocking) literal = ~literal;
  session_->add_clause(*blocking);
  return trace;
}

SourceStats ModelEnumerator::stats() const {
  SourceStats stats;
  stats.strategy = "blocking";
  stats.solve_calls = session_->solve_calls();
  return stats;
}

}  // namespace parallax::runtime
