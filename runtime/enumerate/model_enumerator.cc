#include "runtime/enumerate/model_enumerator.h"

#include "runtime/enumerate/canonical.h"

namespace parallax::runtime {

using compiler::AtomKind;

ModelEnumerator::ModelEnumerator(SolverSession& session) : session_(&session) {
  session.model().for_each_atom(
      [&](std::int32_t variable, AtomKind kind, const std::string&, std::optional<Timepoint>) {
        if (kind != AtomKind::kHoldsAt && kind != AtomKind::kHappens) return;
        order_.push_back(~Literal::positive(variable));
      });
}

std::optional<Trace> ModelEnumerator::next() {
  const auto n = session_->model().horizon;
  if (exhausted_) return std::nullopt;
  const auto status = session_->solve(n, {});
  exhausted_ = status == SolveStatus::kUnsatisfiable;
  if (status != SolveStatus::kSatisfiable) return std::nullopt;
  auto blocking = make_canonical(*session_, n, {}, order_);
  if (blocking.empty() && !order_.empty()) return std::nullopt;
  auto trace =
      decode_trace(session_->model(), n, [&](Literal literal) { return session_->value(literal); });
  trace.number = ++found_;
  for (auto& literal : blocking) literal = ~literal;
  session_->add_clause(blocking);
  return trace;
}

}  // namespace parallax::runtime
