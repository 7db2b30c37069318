#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/loop_stream.h"
#include "harness/campaign/sample_runner.h"
#include "harness/cause/start_line.h"
#include "tools/app/bearing.h"
#include "tools/app/closed_loop.h"
#include "tools/app/extra_runs.h"

namespace parallax::tools {

/// A parameter of a discrepancy's start.
struct StartParameter {
  harness::CellParameter range;
  std::string unit;      // as the simulator says; may be empty
  double failing = 0.0;  // its value in the simulation that failed
};

/// The initial state of its trace that a discrepancy began in. All starts that are tried lie there.
struct StartPlace {
  std::int64_t number = 0;          // among the trace's initial states; 0: it has one only
  std::optional<std::int64_t> all;  // how many there are; none: more than are listed
  std::string holds;                // what tells it from the others: "TrolleyAt(onWay)"
};

struct TriedStartsOptions {
  std::int64_t jobs = 1;
  std::int64_t runs = 200;  // limit on different starts
  std::function<void(const harness::CampaignProgress&)> progress;
};

/// Simulations of a discrepancy's trace, or executions of its plan, from chosen starts, with the
/// seed of the one that failed. They are recorded in RUN_DIR/confirm, where every command finds a
/// start that was simulated before; the run itself stays as it is.
class TriedStarts {
 public:
  static constexpr const char* kFolder = "confirm";
  /// Reason why it ended before everything that was asked for was simulated.
  enum class End : std::uint8_t { kNot, kBudget, kStopped, kLost, kFailed };

  /// `found`, which has a parting, `as_run` (the scenario as it is run) and `context` outlive the
  /// object. Null if it was stopped. Reports as further_runs does.
  static base::Result<std::unique_ptr<TriedStarts>> open(
      const std::string& run_dir, const RecordedDiscrepancy& found, const ScenarioModel& as_run,
      const harness::SimulatorFactory& make_simulator, const TriedStartsOptions& options,
      Context& context);

  /// The parameters with a width, sorted by name; one value of each makes a StartPoint.
  const std::vector<StartParameter>& parameters() const { return parameters_; }
  /// Names of the parameters that have only one value.
  const std::vector<std::string>& fixed() const { return fixed_; }
  /// Starts are drawn by a law, whose ties and conditions moved starts do not keep.
  bool has_law() const { return has_law_; }
  const StartPlace& place() const { return place_; }
  const harness::SimulatorInfo& simulator() const { return runs_->bench().simulator(); }
  harness::StartPoint failing() const;

  /// Verdicts of these starts, in order; fewer if it came to an `end`. A repeated start costs
  /// nothing. The simulations do not depend on the number of jobs.
  std::vector<harness::StartVerdict> probe(const std::vector<harness::StartPoint>& starts);
  End end() const { return end_; }
  std::int64_t asked() const { return std::ssize(verdicts_); }  // different starts
  /// The record of a start that was probed; null if it was not.
  const harness::SampleRecord* record(const harness::StartPoint& start) const;

  /// Writes the journal in order; nothing can be probed afterwards. The folder is still held.
  base::Status close();

 private:
  TriedStarts(const RecordedDiscrepancy& found, const ScenarioModel& as_run,
              const TriedStartsOptions& options, Context& context);
  base::Status prepare_trace();
  base::Status find_place();
  base::Result<bool> prepare_executions();
  base::Status take_record();
  void add_parameters(const harness::Sampler& sampler);
  harness::State state_of(const harness::StartPoint& point) const;
  base::Status simulate(const std::vector<harness::State>& starts);
  base::Result<harness::StartVerdict> verdict_of(const harness::SampleRecord& record);

  const RecordedDiscrepancy& found_;
  const ScenarioModel& as_run_;
  TriedStartsOptions options_;
  ExtraRunsOptions extra_;
  Context& context_;
  harness::SampleRecord like_;  // the simulation that failed
  std::unique_ptr<ExtraRuns> runs_;
  std::unique_ptr<ClosedLoop> loop_;                     // of an executed plan
  std::unique_ptr<harness::LoopStream> stream_;          // likewise
  std::optional<harness::TraceLine> line_;               // of a trace, from the start's state
  std::shared_ptr<const harness::CampaignTrace> start_;  // that all of them begin in
  std::vector<StartParameter> parameters_;
  std::vector<std::string> fixed_;
  bool has_law_ = false;
  StartPlace place_;
  std::map<harness::State, std::int64_t> numbers_;  // of simulations
  std::map<harness::State, harness::StartVerdict> verdicts_;
  std::int64_t next_ = 1;
  End end_ = End::kNot;
  BearingReader reader_;
};

}  // namespace parallax::tools
