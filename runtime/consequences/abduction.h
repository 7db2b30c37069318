#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "runtime/consequences/size_bound.h"
#include "runtime/session/solver_session.h"

namespace parallax::runtime {

/// Explanations of an observation (Shanahan 1989): sets of occurrences of the abducible events that
/// are possible and after which, if they happen and no other abducible one does, the observation
/// holds in every trace. Subset-minimal, the smallest first.
class Explanations {
 public:
  /// `abducibles`: Happens atoms. `observed`: the literal of the observation, at horizon `n`. Both
  /// sessions are fresh, of one model, and outlive the object.
  Explanations(SolverSession& find, SolverSession& refute, Timepoint n,
               std::vector<Literal> abducibles, Literal observed);

  /// The occurrences of the next explanation, in the order of the abducibles. None: there is no
  /// other one, or the solver was stopped.
  std::optional<std::vector<Literal>> next();
  bool exhausted() const { return exhausted_; }
  /// Number of sets that admit the observation but do not entail it: they explain nothing.
  std::int64_t possible_only() const { return possible_only_; }

 private:
  std::optional<std::vector<Literal>> candidate();
  SolveStatus find_within(std::size_t size);

  SolverSession& find_;
  SolverSession& refute_;
  Timepoint n_;
  std::vector<Literal> abducibles_;
  Literal observed_;
  std::unique_ptr<SizeBound> bound_;
  std::size_t size_ = 0;
  std::int64_t possible_only_ = 0;
  bool exhausted_ = false, stopped_ = false;
};

}  // namespace parallax::runtime
