#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/known.h"
#include "compiler/base/result.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// One event of a trace and the step of the plan that it came from.
struct TraceEvent {
  std::string text;                    // "Go(r2)", printed without blanks
  std::string symbol;                  // "Go"
  std::vector<std::string> arguments;  // "r2"
  std::string source;                  // "fetch.lisp:4"; empty without a plan
  State plan_arguments;                // laid over the action's own: target.x, target.y, ...
};

/// A trace as the campaign needs it. `holds` has one entry more than `events`.
struct CampaignTrace {
  std::int64_t number = 0;  // from 1, in order of enumeration
  std::string key;          // stable text that names the trace, part of every draw's key
  std::vector<std::vector<std::string>> holds;  // true ground fluents per timepoint, sorted
  std::vector<TraceEvent> events;               // event t leads from timepoint t to t + 1
  bool other_initial_states = false;            // others lead to the same events
  bool other_outcomes = false;  // the same start and events may end otherwise: see `admits`
};

/// Where traces come from: an enumeration, a file, a list in a test.
class TraceFeed {
 public:
  virtual ~TraceFeed() = default;
  /// The next trace, or none when there is no further one.
  virtual base::Result<std::optional<CampaignTrace>> next() = 0;
  /// What may be said when `next` has answered none: "all traces explored", "complete up to
  /// bound" or "stopped".
  virtual std::string exploration() const = 0;
  /// Why it is complete up to a bound only, one sentence each: the forms of the plan that were cut.
  virtual std::vector<std::string> bounds() const { return {}; }
  /// All ground fluents of the model, sorted.
  virtual const std::vector<std::string>& fluents() const = 0;
  /// Does the model let the events of `trace`, from its initial state, end in a state in which each
  /// of these fluents has this value? Asked about the trace that was given last, and only if it has
  /// `other_outcomes`. Undecided where the stop flag is raised meanwhile.
  virtual base::Known admits(const CampaignTrace& trace,
                             const std::map<std::string, bool>& last_state) {
    (void)trace, (void)last_state;
    return base::Known::kNo;
  }
};

}  // namespace parallax::harness
