#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/graph/layered_model.h"
#include "runtime/graph/trace_graph.h"
#include "runtime/graph/window_query.h"
#include "runtime/solver/sat_solver.h"

namespace parallax::harness {

/// The reason why a list of possibilities was not given.
enum class ListEnd : std::uint8_t { kComplete, kTooMany, kStopped };

/// One window of a layered model, which is asked for the states at its end, and for the smallest
/// sets of events that a state admits. Answers are sorted and do not depend on earlier questions.
class WindowSolver {
 public:
  /// `model` and `window`, one of its windows, outlive the solver; `is_start`: the one of the
  /// states at 0, which has no state before and no events. `stop` may be null.
  WindowSolver(const runtime::LayeredModel& model, const runtime::WindowClauses& window,
               bool is_start, const std::atomic<bool>* stop);

  /// The distinct states at the end of the window under these assumptions, ascending: moves without
  /// their events.
  ListEnd states(std::span<const runtime::Literal> given, std::size_t limit,
                 std::vector<runtime::Move>& out);
  /// The sets of events, least by inclusion, that `given` admits, as places in
  /// LayeredModel::events, in the order in which they are found: the smallest ways in which what
  /// has to happen can.
  ListEnd least_events(std::span<const runtime::Literal> given, std::size_t limit,
                       std::vector<std::vector<std::size_t>>& out);

  /// Literals of the window for assumptions.
  runtime::Literal before(std::uint32_t slot) const { return at(0, slot); }
  runtime::Literal after(std::uint32_t slot) const {
    return at(is_start_ ? 0 : model_.state_slots, slot);
  }
  runtime::Literal event(std::size_t place) const {
    return at(model_.state_slots, model_.events[place]);
  }

 private:
  static runtime::Literal at(std::uint32_t offset, std::uint32_t slot) {
    return runtime::Literal::positive(static_cast<std::int32_t>(offset + slot) + 1);
  }
  std::vector<runtime::Literal> states_after() const;
  runtime::SolveStatus solve(std::span<const runtime::Literal> given,
                             std::span<const runtime::Literal> more);
  runtime::Literal new_guard() { return runtime::Literal::positive(next_guard_++); }
  runtime::SolveStatus shrink(std::span<const runtime::Literal> given,
                              std::vector<std::size_t>& events);
  std::vector<std::size_t> events_at_hand() const;

  const runtime::LayeredModel& model_;
  bool is_start_;
  runtime::WindowQuery query_;                  // for states
  std::unique_ptr<runtime::SatSolver> solver_;  // for events
  std::int32_t next_guard_;
};

}  // namespace parallax::harness
