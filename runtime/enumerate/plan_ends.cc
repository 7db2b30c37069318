#include "runtime/enumerate/plan_ends.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "compiler/base/ground_name.h"

namespace parallax::runtime {

using compiler::AtomKind;

PlanEnds::PlanEnds(const CompiledModel& model, std::unique_ptr<SatSolver> solver, bool all_hits)
    : model_(&model), session_(model, std::move(solver)), index_(model), all_hits_(all_hits) {
  std::set<std::string> ends;
  model.for_each_atom([&](const compiler::AtomRef& atom) {
    if (atom.kind != AtomKind::kLocation) return;
    if (const auto* end = std::get_if<compiler::PlanEnd>(&atom.plan)) ends.insert(end->text);
  });
  ends_.assign(ends.begin(), ends.end());
}

std::vector<Literal> PlanEnds::assumptions_of(const Trace& trace) const {
  std::vector<Literal> out;
  const auto n = trace.length();
  for (Timepoint t = all_hits_ ? n : 0; t <= n && model_->has_constraints; ++t) {
    if (const auto hit = index_.hit(t)) out.push_back(t < n ? ~*hit : *hit);
  }
  model_->for_each_atom([&](const compiler::AtomRef& atom) {
    if (!atom.time || atom.needed_horizon(model_->horizon) > n) return;
    const auto time = static_cast<std::size_t>(*atom.time);
    std::optional<bool> value;
    if (atom.kind == AtomKind::kHoldsAt) {
      value = contains(trace.points[time].holds, atom.fluent());
    } else if (atom.kind == AtomKind::kHappens) {
      value = contains(trace.points[time].happens, atom.event());
    } else if (atom.kind == AtomKind::kResult) {
      const auto* returned = std::get_if<compiler::ReturnedObject>(&atom.plan);
      value = returned != nullptr && trace.points[time - 1].returned == returned->object;
    }
    if (value) out.push_back(*value ? atom.literal() : ~atom.literal());
  });
  return out;
}

std::string PlanEnds::of(const Trace& trace) {
  const auto n = trace.length();
  auto assumptions = assumptions_of(trace);
  std::string out;
  const auto try_end = [&](const std::optional<Literal>& there, const std::string& name) {
    if (!there || out == name || out.ends_with(" or " + name)) return;
    assumptions.push_back(*there);
    const auto status = session_.solve_whole(n, assumptions);
    assumptions.pop_back();
    if (status == SolveStatus::kSatisfiable) out += (out.empty() ? "" : " or ") + name;
  };
  for (const auto& end : ends_) {
    const auto there = index_.at(compiler::PlanEnd{end}, n);
    try_end(there, end == "DONE" ? "done" : end);
  }
  if (n == model_->horizon && !model_->has_constraints) try_end(index_.running(n), "cut");
  for (std::size_t cut = 0; cut < model_->plan_cuts.size(); ++cut) {
    try_end(index_.at(compiler::PlanCutId(static_cast<std::uint32_t>(cut)), n), "cut");
  }
  return out;
}

std::int64_t PlanEnds::initial_states(const Trace& trace, const std::set<std::string>& asked,
                                      std::int64_t most) {
  std::vector<Literal> settings;
  model_->for_each_atom([&](const compiler::AtomRef& atom) {
    const bool starts = atom.kind == AtomKind::kRegister && atom.time == 0;
    const bool counts = atom.kind == AtomKind::kPredicate && !atom.time &&
                        asked.contains(std::string(base::symbol_of(atom.name)));
    if (starts || counts) settings.push_back(atom.literal());
  });
  // Cuts that every execution has do not count; `of` has told the solver which they are.
  std::erase_if(settings, [&](Literal literal) {
    return session_.is_fixed(literal) || session_.is_fixed(~literal);
  });
  if (settings.empty()) return 1;
  const auto n = trace.length();
  auto assumptions = assumptions_of(trace);
  const auto counting = session_.new_variable();
  assumptions.push_back(counting);
  std::int64_t count = 0;
  auto status = SolveStatus::kSatisfiable;
  while (count < most) {
    status = session_.solve_whole(n, assumptions);
    if (status != SolveStatus::kSatisfiable) break;
    ++count;
    std::vector<Literal> other = {~counting};
    for (const auto literal : settings) {
      other.push_back(session_.value(literal) ? ~literal : literal);
    }
    session_.add_clause(other);
  }
  const auto over = ~counting;
  session_.add_clause(std::span(&over, 1));
  return status == SolveStatus::kUnknown ? 0 : count;
}

}  // namespace parallax::runtime
