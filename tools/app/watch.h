#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/artifact/symbol_table.h"
#include "compiler/base/result.h"
#include "harness/campaign/trace_input.h"
#include "harness/monitor/observation_reader.h"
#include "runtime/monitor/belief.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

struct WatchOptions {
  bool with_plan = true;
  std::size_t max_states = 20'000;
  std::vector<std::string> unobserved;  // event symbols, besides those of the scenario
  std::optional<harness::Comparison> comparison = std::nullopt;  // none: as the scenario says
  harness::ReadingTolerance tolerance;
};

/// Observations that a tolerance had a part in.
struct ToleratedReadings {
  std::int64_t near_border = 0;  // a fluent was within the tolerance of a border
  std::int64_t only_within = 0;  // admitted, but would not have been as they were reported
};

/// A fluent for which an observation was refused.
struct RefusedFluent {
  std::string fluent;
  bool observed = false;
  bool neither = false;                                           // it neither holds nor does not
  std::vector<std::pair<std::string, harness::Value>> variables;  // that it was read from
};

/// The part of a report that no still possible state admits.
struct Refusal {
  std::vector<RefusedFluent> fluents;  // of an observation
  std::string event;                   // of a step: `Go(r2)`, several joined by `+`
  bool only_outcome = false;           // it may happen, but not come to this
  std::vector<std::string> expected;   // what the plan may perform now, with its places
  bool plan_is_over = false;
};

/// Holds what is told of a robot, or of another simulator, against the model and the plan of a
/// scenario.
class Watch {
 public:
  /// `loaded` and `context` outlive the watch. Reports kNoSteps, kNoSuchEvent, and what compiling
  /// reports.
  static base::Result<std::unique_ptr<Watch>> make(const ScenarioModel& loaded,
                                                   const WatchOptions& options, Context& context);

  const harness::ObservationReader& reader() const { return *reader_; }
  const compiler::SymbolTable& symbols() const { return *symbols_; }
  std::vector<std::string> event_names() const;
  /// Are there fluents that are compared at the start and at the end only?
  bool compares_at_rest() const { return compares_at_rest_; }

  void restart();
  /// `at_rest`: at the start or at the end.
  runtime::Admission observe(const harness::ReportedValues& values, bool at_rest);
  /// Did the last observation mention a fluent, so that it was compared?
  bool last_was_compared() const { return last_compared_; }
  /// Effects of the tolerance so far, in compared observations.
  const ToleratedReadings& tolerated() const { return tolerated_; }
  runtime::Admission step(const runtime::ToldStep& told);
  const runtime::Belief& belief() const { return *belief_; }
  /// Why nothing is said any more; empty: something is.
  const std::string& undecided_because() const {
    return unexplored_.empty() ? belief_->undecided_because() : unexplored_;
  }
  /// The last refusal.
  const Refusal& refusal() const { return refusal_; }
  /// Number of observations that mentioned a fluent and were compared with the model.
  std::int64_t compared() const { return compared_; }

 private:
  Watch() = default;
  harness::ReportedValues for_axioms(const harness::ReportedValues& values) const;
  runtime::Admission step_of_axioms(const runtime::ToldStep& told);
  runtime::Admission judged(runtime::Admission by_plan, runtime::Admission by_axioms);
  void explain(const harness::ReportedValues& values, bool at_rest);
  void explain_seen(const harness::ReportedValues& values);
  runtime::Observation observation_of(const harness::SeenState& seen) const;
  RefusedFluent refused(std::size_t number, const harness::ReportedValues& values) const;

  const ScenarioModel* loaded_ = nullptr;
  const Context* context_ = nullptr;
  std::unique_ptr<compiler::SymbolTable> symbols_;
  std::optional<harness::ModelFluents> fluents_;
  std::vector<std::size_t> number_of_;  // by FluentId: number among `fluents_`
  std::unique_ptr<harness::ObservationReader> reader_;
  std::unique_ptr<runtime::StepWindows> windows_;
  std::unique_ptr<runtime::Belief> belief_;
  /// The same without the plan, where the plan has executions that are not explored: what this one
  /// admits is not refused. Null: there are none.
  std::unique_ptr<Watch> axioms_;
  std::string gaps_;        // of the plan, if it has some
  std::string unexplored_;  // they may be why a report was not among the explored executions
  bool only_at_rest_ = false, compares_at_rest_ = false;
  harness::ReadingTolerance tolerance_;
  harness::SeenState seen_, exact_;
  runtime::Observation observation_;
  ToleratedReadings tolerated_;
  bool last_compared_ = false;
  Refusal refusal_;
  std::int64_t compared_ = 0;
};

}  // namespace parallax::tools
