#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/result.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/replay.h"
#include "runtime/enumerate/path_admission.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// One step of a recorded simulation: an event of its trace, or a perform of an executed plan.
struct ObservedStep {
  compiler::EventId event;
  std::string name;                             // of the event
  std::optional<compiler::PlanStepId> perform;  // of an executed plan
  std::string source;                           // "fetch.lisp:4"; empty without a plan
  harness::ActionOutcome outcome;               // in the simulator's words
  bool succeeded = true;                        // of an executed plan: as the plan was told
  std::string object;                           // likewise, what it found
};

/// The course of a recorded simulation, in the ids of a compiled model.
struct ObservedPath {
  using State = std::map<compiler::FluentId, bool>;

  harness::SampleId id;
  bool experiment = false;  // of the experiments that repair made, which have numbers of their own
  bool executed = false;    // the plan was, in closed loop
  std::vector<ObservedStep> steps;
  std::vector<harness::LoopState> points;  // as it was seen, one more than steps
  /// The fluents that are compared with the model, by timepoint. At the start of a trace all
  /// fluents, as the trace begins there; else those that are compared and were observed. Where only
  /// the end is compared: for states on the way, the values on which trace and simulation agree, up
  /// to where they part for good.
  std::vector<State> states;
  harness::State start;  // the continuous state that was drawn

  /// No state of a model corresponds to the observation at `t`, and that is compared.
  bool in_no_state(std::size_t t) const {
    return !states[t].empty() && points[t].state.in_no_state;
  }
};

/// Every simulation of a journal that came to its end, in order. The scenario is that of the run,
/// loaded in the way that it was run; what is on record must be what it can have, as far as the
/// steps and the variables go: kForeignJournalLine. Traces in the ids of the model are the
/// caller's to check (check_recorded_run).
base::Result<std::vector<ObservedPath>> observed_paths(const ScenarioModel& loaded,
                                                       const harness::JournalText& journal,
                                                       Context& context);
/// One of them.
base::Result<ObservedPath> observed_path(const ScenarioModel& loaded,
                                         const harness::RecordedRun& run, Context& context);

/// States observed paths as literals of a model's atoms.
class PathFacts {
 public:
  /// `model` outlives the object.
  explicit PathFacts(const compiler::CompiledModel& model) : admission_(model) {}
  /// States that the first `steps` steps happen, the first `outcomes` of them (of an executed plan)
  /// with their outcomes, through these states. None: some of it is false in every execution.
  std::optional<std::vector<compiler::Literal>> facts(
      const ObservedPath& path, std::size_t steps, std::size_t outcomes,
      std::span<const ObservedPath::State> states) const;
  /// The same up to timepoint `t` with all its states.
  std::optional<std::vector<compiler::Literal>> up_to(const ObservedPath& path,
                                                      std::size_t t) const;

 private:
  runtime::PathAdmission admission_;
};

/// Where a path leaves those of the model.
struct PathParting {
  bool undecided = false;            // the solver was stopped
  std::optional<std::size_t> after;  // the first timepoint that the model cannot reach like that
};
/// The shortest prefix of the path that the model of `session` cannot go, which is the one that
/// `facts` are of. At most a solver call for each step, and one.
PathParting parting_of(const ObservedPath& path, const PathFacts& facts,
                       runtime::SolverSession& session);

}  // namespace parallax::tools
