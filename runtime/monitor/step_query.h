#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/graph/window_query.h"

namespace parallax::runtime {

/// Events, as indices into StepLiterals::demanded, ascending.
using DemandedEvents = std::vector<std::uint32_t>;

/// Question about a step. Literals are those of a window.
struct StepQuestion {
  std::vector<Literal> given;  // the state before, and events
  DemandedEvents demanded;     // events that happen where they must, and only then
  std::vector<Literal> after;  // known about the state after it: no reason for any event
};

/// Literals of a window by their role.
struct StepLiterals {
  std::vector<Literal> after;       // the state that a step leads to
  std::vector<Literal> unobserved;  // events that may happen without being reported
  std::vector<Literal> alone;       // those that may happen while the plan's control stands still
  std::vector<Literal> demanded;    // events that may happen where axioms demand them
  std::vector<Literal> succeeded;   // the plan's perform succeeded
};

/// The states that one step leads to.
class StepQuery {
 public:
  /// `stop` may be null.
  StepQuery(WindowClauses window, const StepLiterals& literals, const std::atomic<bool>* stop);

  // Assumptions: one literal of the list is true.
  Literal some_unobserved() const { return Literal::positive(window_.variables + 1); }
  Literal some_alone() const { return Literal::positive(window_.variables + 2); }
  Literal some_succeeded() const { return Literal::positive(window_.variables + 3); }

  /// At most `limit` states, each by its literals of `after`; a state may occur twice. Only
  /// subset-minimal sets of demanded events happen: no proper subset would do in the same state and
  /// with the same other events, whatever state that leads to.
  WindowQuery::Answer ask(const StepQuestion& question, std::size_t limit);

 private:
  std::unique_ptr<WindowQuery> query(const std::vector<Literal>& projection) const;
  bool add_least(const std::vector<Literal>& given, const StepQuestion& question, std::size_t limit,
                 WindowQuery::Answer& answer);
  std::optional<DemandedEvents> some(const std::vector<Literal>& given,
                                     const DemandedEvents& demanded, const DemandedEvents& allowed,
                                     bool& is_complete);
  std::optional<DemandedEvents> least_within(const std::vector<Literal>& given,
                                             const DemandedEvents& demanded,
                                             const DemandedEvents& denied, bool& is_complete);

  WindowClauses window_;
  const StepLiterals& literals_;  // the belief's, which outlives the object
  const std::atomic<bool>* stop_;
  std::unique_ptr<WindowQuery> after_, unobserved_, demanded_;
};

}  // namespace parallax::runtime
