#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/known.h"
#include "compiler/base/result.h"
#include "harness/campaign/cover_watch.h"
#include "harness/campaign/sample_record.h"
#include "harness/campaign/start_guide.h"
#include "harness/sampling/sampler.h"
#include "harness/simulator/simulator.h"
#include "runtime/trace/trace.h"

namespace parallax::harness {

/// A perform that the plan asks for.
struct PlannedPerform {
  std::int64_t step = 0;  // as PathStep
  std::string event;
  std::string source;
  State arguments;  // what the plan says of it
};

/// One execution of a plan, in a worker's thread. It sees what the simulator shows.
class PlanExecution {
 public:
  virtual ~PlanExecution() = default;
  /// Goes on in the state that was just observed, up to the next perform. None: it has ended.
  virtual std::optional<PlannedPerform> next(const State& observed) = 0;
  /// Tells what became of the perform; writes what the plan makes of it into `step`. An end that is
  /// an error (PathEnd) if it can make nothing of it.
  virtual std::optional<PathEnd> tell(const ActionOutcome& outcome, const State& before,
                                      const State& after, PathStep& step) = 0;
  /// How it ended, once `next` has answered none, and the class or form of that.
  virtual PathEnd end(std::string& detail) const = 0;
};

/// A plan that can be executed, by several threads at the same time.
class ExecutablePlan {
 public:
  virtual ~ExecutablePlan() = default;
  /// Begins an execution. Open choices of the plan are drawn from the key's stream. The plan
  /// outlives the execution.
  virtual std::unique_ptr<PlanExecution> begin(const DrawKey& key) const = 0;
  /// Every perform that it can ask for, with each object that it can have found.
  virtual std::vector<PlannedPerform> performs() const = 0;
};

/// An initial state of the model that no start of the world can be in.
struct StateWithoutStart {
  std::vector<compiler::FluentId> holds;
  std::string reason;
};

/// The states that executions begin in.
struct LoopStates {
  std::vector<std::vector<compiler::FluentId>> holds;  // in a fixed order
  /// Weights of the states in the draw, none of which is 0. Empty: each is equally likely.
  std::vector<double> weights;
  std::vector<StateWithoutStart> without_start;  // besides; none if no state has a start
};

/// A model with a plan that is executed.
class LoopFeed {
 public:
  using ObservedFluents = std::map<compiler::FluentId, bool>;

  virtual ~LoopFeed() = default;
  virtual const ExecutablePlan& plan() const = 0;
  /// The model's ground fluents and events.
  virtual runtime::Symbols symbols() const = 0;
  /// The performs of one execution that the model was compiled for.
  virtual std::int64_t max_performs() const = 0;
  /// Executions of the plan that are never made, one sentence each, and what a claim leaves out of
  /// it in a few words: "not of every order". Empty: nothing is left out.
  virtual std::vector<std::string> bounds() const { return {}; }
  virtual std::string reservation() const { return {}; }
  /// The states that the model can begin in, but for those that the scenario gives no weight and
  /// those that no start can be in, each as the true ones of `fluents`. Reports that there are too
  /// many, or none, and what is wrong with the weights; nothing if it was stopped.
  virtual base::Result<std::optional<LoopStates>> initial_states(
      std::span<const compiler::FluentId> fluents) = 0;
  /// Returns the guide that chooses the starts of executions drawn from this seed; null: all are
  /// drawn. Call it once, after initial_states.
  virtual StartGuide* guide(std::uint64_t seed) = 0;
  /// Returns the items that executions drawn from this seed must show; null if the solver was
  /// stopped. Call it once, after initial_states.
  virtual CoverWatch* cover(std::uint64_t seed) = 0;
  /// Has the model an execution that begins with these performs, goes through these states (from
  /// timepoint 0 on, perhaps not to the end), and ends the first `outcomes` of the performs as they
  /// ended? Undecided where the stop flag is raised meanwhile.
  virtual base::Known admits(std::span<const PathStep> performs, std::size_t outcomes,
                             std::span<const ObservedFluents> observed) = 0;
  /// Reports an end that is an error, at the perform's place in the binding table.
  virtual base::DiagnosticBuilder report_end(const ExecutedPath& path,
                                             const std::string& reason) = 0;
};

}  // namespace parallax::harness
