#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "runtime/session/solver_session.h"

namespace parallax::runtime {

/// Bounds how many of some literals are true: a totalizer (Bailleux and Boufkhad 2003) with outputs
/// up to a largest bound. Clauses: at most the number of literals times the bound.
class SizeBound {
 public:
  /// `session` outlives the object.
  SizeBound(SolverSession& session, std::vector<Literal> literals, std::size_t largest);
  std::size_t largest() const { return largest_; }
  /// The literal that, assumed, forbids more than `most`, which is below `largest`; none if there
  /// are not that many.
  std::optional<Literal> at_most(std::size_t most) const {
    return most < outputs_.size() ? std::optional(~outputs_[most]) : std::nullopt;
  }

 private:
  std::vector<Literal> count(std::vector<Literal> literals);
  SolverSession& session_;
  std::size_t largest_;
  std::vector<Literal> outputs_;  // [i]: more than i are true
};

}  // namespace parallax::runtime
