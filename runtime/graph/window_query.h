#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/enumerate/clause_search.h"
#include "runtime/graph/layered_model.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// The valuations of some variables that the clauses of one window admit under assumptions, each
/// once: by search, and from the first question on that meets too many conflicts by a solver that
/// learns.
class WindowQuery {
 public:
  /// `window` outlives the query; `more` are further clauses, over further variables up to
  /// `variables`. `stop` may be null.
  WindowQuery(const WindowClauses& window, std::vector<std::vector<Literal>> more,
              std::int32_t variables, std::vector<Literal> projection,
              const std::atomic<bool>* stop);
  struct Answer {
    std::vector<std::vector<bool>> found;  // by projection
    bool complete = false;                 // else stopped, or there are more
  };
  /// At most `limit` valuations.
  Answer ask(std::span<const Literal> assumptions, std::size_t limit);

 private:
  bool is_stopped() const { return stop_ != nullptr && stop_->load(); }
  void start_solver();
  template <typename Value>
  std::vector<bool> read(const Value& value) const;
  Answer solve(std::span<const Literal> assumptions, std::size_t limit);

  std::vector<std::vector<Literal>> clauses_;
  std::int32_t variables_;
  std::vector<Literal> projection_;
  const std::atomic<bool>* stop_;
  ClauseSearch search_;
  std::unique_ptr<SatSolver> solver_;  // once the search has given up
  std::int32_t next_guard_;
};

}  // namespace parallax::runtime
