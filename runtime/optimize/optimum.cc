// The lexicographically least values of several objectives.
//
// For one length of traces the objectives are minimized one after the other by cores
// (core_guided.cc); each settled value is required from then on, so it binds the later ones.
// With state constraints lengths are searched in turn, each only as far as it can beat the best
// values so far: while a length is equal to them in the objectives before, the next one must be
// no worse, and the last one better. So among equally good traces the shortest stays. If the
// solver is stopped, the best trace found is kept, and the bound is the least that any length
// still allows.
//
// Cost: that of the core-guided search, for each objective and length.

#include "runtime/optimize/optimum.h"

#include <algorithm>
#include <utility>

#include "runtime/optimize/core_guided.h"

namespace parallax::runtime {
namespace {

class OptimumSearch {
 public:
  explicit OptimumSearch(SolverSession& session)
      : session_(session), model_(session.model()), index_(model_), symbols_(symbols_of(model_)) {}

  Optimum run() {
    if (!model_.has_constraints) {
      last_length_ = model_.horizon;
      finish(explore(model_.horizon, {}, true), model_.horizon + 1);
    } else {
      explore_lengths();
    }
    best_.solve_calls = session_.solve_calls();
    return std::move(best_);
  }

 private:
  void explore_lengths() {
    std::vector<Literal> unmet;  // no hit so far
    last_length_ = model_.horizon;
    for (Timepoint n = 0; n <= model_.horizon; ++n) {
      const auto hit = index_.hit(n);
      if (!hit) continue;
      auto assumptions = unmet;
      assumptions.push_back(*hit);
      if (!explore(n, std::move(assumptions), false)) return finish(false, n + 1);
      unmet.push_back(~*hit);
    }
    finish(true, model_.horizon + 1);
  }

  /// The traces of one length; false if the solver was stopped.
  bool explore(Timepoint n, std::vector<Literal> assumptions, bool alone) {
    const auto others = best_.values;  // of other lengths
    bool equal = !others.empty();      // in the objectives so far
    decided_ = 0;
    CoreGuidedSearch search(session_, n, std::move(assumptions), alone, [&] { note(n); });
    for (std::size_t i = 0; i < model_.objectives.size(); ++i) {
      const bool last = i + 1 == model_.objectives.size();
      std::optional<std::int64_t> below;
      if (equal) below = others[i] + (last ? 0 : 1);
      const auto status = search.minimize(model_.objectives[i], below);
      best_.cores += search.cores() - std::exchange(cores_, search.cores());
      lower_ = search.lower();
      if (status == SolveStatus::kUnknown) return false;
      if (status == SolveStatus::kUnsatisfiable) break;
      ++decided_;
      equal = equal && lower_ == others[i];
    }
    cores_ = 0;
    return true;
  }

  /// Keeps the session's valuation if it is better than the best one so far.
  void note(Timepoint n) {
    const auto value = [&](Literal literal) { return session_.value(literal); };
    std::vector<std::int64_t> values;
    for (const auto& objective : model_.objectives) {
      values.push_back(objective_value(objective, n, value));
    }
    if (best_.witness && values >= best_.values) return;
    best_.values = std::move(values);
    best_.witness = decode_trace(model_, symbols_, n, value);
    best_.witness->number = 1;
  }

  /// `next`: the first length that was not looked at.
  void finish(bool complete, Timepoint next) {
    if (complete) {
      best_.none = !best_.witness;
      best_.decided = best_.values.size();
      return;
    }
    if (!model_.has_constraints) {
      best_.decided = decided_;
      best_.at_least = lower_;
      return;
    }
    // For several lengths, only the bounds of the first objective are compared.
    auto least = decided_ == 0 ? lower_ : trivial_bound(model_.objectives.front(), next - 1);
    if (!best_.values.empty()) least = std::min(least, best_.values.front());
    for (auto n = next; n <= last_length_; ++n) {
      least = std::min(least, trivial_bound(model_.objectives.front(), n));
    }
    best_.at_least = least;
  }

  SolverSession& session_;
  const CompiledModel& model_;
  compiler::AtomIndex index_;
  Symbols symbols_;
  Optimum best_;
  Timepoint last_length_ = 0;
  std::size_t decided_ = 0;  // objectives of the length that is looked at
  std::int64_t lower_ = 0;   // bound of the next objective
  std::int64_t cores_ = 0;
};

}  // namespace

Optimum find_optimum(SolverSession& session) { return OptimumSearch(session).run(); }

}  // namespace parallax::runtime
