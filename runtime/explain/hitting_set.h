#pragma once

#include <atomic>
#include <memory>
#include <optional>

#include "runtime/explain/group_solver.h"

namespace parallax::runtime {

/// Smallest sets that have an element of each given set, by a SAT solver and a sequential counter
/// (Sinz 2005). Size: elements times `bound` clauses.
class HittingSets {
 public:
  /// Elements 0 .. count - 1; nobody asks for sets with more than `bound` elements.
  HittingSets(std::size_t count, std::size_t bound, const std::atomic<bool>* stop);
  void add(const IndexSet& to_hit);
  /// A smallest one; none if every one has more than `bound` elements, or the solver was stopped
  /// (then `stopped`). The size never falls from call to call.
  std::optional<IndexSet> smallest();
  bool stopped() const { return stopped_; }
  /// No hitting set is smaller than this.
  std::size_t lower_bound() const { return size_; }

 private:
  Literal element(std::size_t i) const {
    return Literal::positive(static_cast<std::int32_t>(i) + 1);
  }
  /// At least j of the elements 0 .. i are in the set, 1 <= j <= bound + 1.
  Literal at_least(std::size_t j, std::size_t i) const;

  std::unique_ptr<SatSolver> solver_;
  std::size_t count_, bound_, size_ = 0;
  bool stopped_ = false;
};

}  // namespace parallax::runtime
