#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/base/contract.h"
#include "compiler/base/known.h"
#include "compiler/base/result.h"
#include "harness/region/fluent_binding.h"
#include "harness/simulator/simulator.h"
#include "runtime/trace/trace.h"

namespace parallax::harness {

/// The plan's data for one event of a trace.
struct PlannedEvent {
  std::string source;  // "fetch.lisp:4"; empty without a plan
  State arguments;     // override the action's own: target.x, target.y, ...
  /// The performed event, where axioms of the model demand others at the same time, which belong to
  /// the prediction. Empty: there is only one.
  std::string event = {};
};

/// A trace as the campaign simulates, records and reports it: exactly one event is performed
/// between each timepoint and the next.
struct CampaignTrace : runtime::Trace {
  std::string key;                 // stable text that names the trace, part of every draw's key
  std::vector<PlannedEvent> plan;  // by event

  std::size_t event_count() const { return plan.size(); }
  /// Printed without blanks: "Go(r2)".
  const std::string& event(std::size_t t) const {
    return plan[t].event.empty() ? symbols->name(points[t].happens.front()) : plan[t].event;
  }
  /// All events: "Go(r2) PickUp()", with those that are demanded: "Push()+Ring()".
  std::string events() const {
    std::string out;
    for (std::size_t t = 0; t < event_count(); ++t) {
      out += (t == 0 ? "" : " ") + event(t);
      if (points[t].happens.size() < 2) continue;
      for (const auto other : points[t].happens) {
        if (symbols->name(other) != event(t)) out += "+" + symbols->name(other);
      }
    }
    return out;
  }
};

/// The ground fluents of a model in order of their names, and their ids in traces.
class ModelFluents {
 public:
  explicit ModelFluents(const compiler::SymbolTable& symbols);
  const std::vector<GroundFluent>& ground() const { return ground_; }
  compiler::FluentId id(std::size_t index) const { return ids_[index]; }

 private:
  std::vector<GroundFluent> ground_;
  std::vector<compiler::FluentId> ids_;  // likewise
};

/// The initial states of the model that lead to a trace's events and returned objects.
struct TraceStarts {
  /// Each as its true ones of the fluents that were asked for, ascending; the trace's own first.
  std::vector<std::vector<compiler::FluentId>> states;
  /// There are more than are listed, and `parts` says what they are among.
  bool more = false;
  /// Groups of fluents with the values that each group can have. Every initial state is one value
  /// of each group, but not each such combination is one.
  std::vector<std::vector<std::vector<compiler::FluentId>>> parts;
  /// Weights of the states in a draw, none of which is 0. Empty: each is equally likely.
  std::vector<double> weights;
};

/// A source of traces: an enumeration, a file, a list in a test.
class TraceFeed {
 public:
  virtual ~TraceFeed() = default;
  /// The next trace, or none when there is no further one.
  virtual base::Result<std::optional<CampaignTrace>> next() = 0;
  /// The completeness of the search once `next` has returned none: "all traces explored", "complete
  /// up to bound" or "stopped".
  virtual std::string exploration() const = 0;
  /// Why it is complete up to a bound only, one sentence each: the forms of the plan that were cut,
  /// and executions of the plan that are not explored.
  virtual std::vector<std::string> bounds() const { return {}; }
  /// The part of the plan that no claim about all traces covers, in a few words: "not of every
  /// order". Empty: nothing is left out.
  virtual std::string reservation() const { return {}; }
  /// The ground fluents and events of the model, for all its traces.
  virtual runtime::Symbols symbols() const = 0;
  /// The initial states that lead to the events of `trace`, which was given, as far as these
  /// fluents tell them apart. None: stopped. A feed that cannot tell knows the trace's own only.
  virtual base::Result<std::optional<TraceStarts>> starts(
      const CampaignTrace& trace, std::span<const compiler::FluentId> fluents) {
    TraceStarts own;
    auto& state = own.states.emplace_back();
    for (const auto fluent : fluents) {
      if (runtime::contains(trace.points.front().holds, fluent)) state.push_back(fluent);
    }
    return std::optional(std::move(own));
  }
  /// The trace with the events of `trace` from another initial state, given as its true ones of
  /// `fluents`. None: the model has none; kUndecided: stopped.
  virtual base::Result<std::pair<base::Known, std::optional<CampaignTrace>>> from(
      const CampaignTrace& trace, std::span<const compiler::FluentId> fluents,
      const std::vector<compiler::FluentId>& state) {
    (void)trace, (void)fluents, (void)state;
    return std::pair(base::Known::kNo, std::optional<CampaignTrace>());
  }
  /// Does the model let the events of `trace`, from its initial state, lead through states in which
  /// each of these fluents, by timepoint, has this value? Asked about a trace that was given,
  /// though others may have been given since, and only if it has `other_outcomes`. Undecided where
  /// the stop flag is raised meanwhile.
  virtual base::Known admits(const CampaignTrace& trace,
                             const std::vector<std::map<compiler::FluentId, bool>>& observed) {
    (void)trace, (void)observed;
    return base::Known::kNo;
  }
};

}  // namespace parallax::harness
