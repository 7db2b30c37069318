#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/prepared_trace.h"
#include "harness/campaign/repetition.h"
#include "harness/campaign/sample_row.h"
#include "harness/campaign/sample_runner.h"
#include "harness/campaign/start_states.h"
#include "harness/campaign/trace_input.h"
#include "harness/campaign/worker_pool.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

class Journal;

struct TrialOptions {
  std::uint64_t seed = 1;
  std::int64_t jobs = 1;
  const std::atomic<bool>* stop = nullptr;
  /// Called in the worker's thread with the recorded motion of each sample.
  std::function<void(const SampleRecord&, const MotionLog&)> moved = {};
};

/// The shared state of the simulations of one command: workers with a simulator each, the info of
/// that simulator, the model's fluents, and the count of consecutive losses, which goes on from
/// trace to trace.
class SimulatorBench {
 public:
  /// Begins to make the first simulator. `finished` is called in a worker's thread for each
  /// simulation, before the pool gives it. Everything that is referred to must outlive this.
  SimulatorBench(const Scenario& scenario, const compiler::SymbolTable& symbols,
                 const SimulatorFactory& make_simulator, const TrialOptions& options,
                 std::function<void(const SampleRecord&)> finished, base::DiagnosticSink& sink);

  /// Waits for what the first simulator says of itself; no trial may be prepared before. False when
  /// stopped. Reports kSimulatorNotStarted and what check_against_simulator reports.
  base::Result<bool> start();

  const SimulatorInfo& simulator() const { return simulator_; }
  const ModelFluents& fluents() const { return fluents_; }
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  WorkerPool& pool() { return pool_; }
  /// Counts a loss. Is it one too many in a row? Then it is reported, unless it was `on_record`.
  bool lost_too_often(const SampleRecord& record, bool on_record);
  /// A simulation was observed.
  void end_row_of_losses() { lost_in_a_row_ = 0; }

  /// Simulates the start and seed of `record` once more, in a worker that may have made others
  /// before. What ran ahead is forgotten. None when stopped.
  std::optional<SampleRecord> repeat(const std::shared_ptr<const SampleMaker>& maker,
                                     const SampleRecord& record);
  /// The same by a simulator that is started for it, when the workers have ended.
  std::optional<SampleRecord> repeat_fresh(const std::shared_ptr<const SampleMaker>& maker,
                                           const SampleRecord& record);

  /// Ends the workers. Nothing may be simulated by them afterwards.
  void close() { pool_.close(); }
  std::int64_t runs_made() const { return pool_.runs_made() + fresh_runs_; }
  double simulated_s() const { return pool_.simulated_s() + fresh_simulated_s_; }

 protected:
  const Scenario& scenario_;
  TrialOptions options_;
  base::DiagnosticSink& sink_;
  ModelFluents fluents_;
  SimulatorInfo simulator_;
  std::int64_t lost_in_a_row_ = 0;
  SimulatorFactory make_simulator_;
  std::int64_t fresh_runs_ = 0;  // by simulators that were started for one
  double fresh_simulated_s_ = 0.0;
  WorkerPool pool_;
};

/// A start that was chosen: an initial state of the trace, by number, and a point in its region.
struct ChosenStart {
  std::int64_t state = 0;
  State point;
};

/// The same for trials of traces.
class TrialBench : public SimulatorBench {
 public:
  TrialBench(const Scenario& scenario, TraceFeed& feed, const SimulatorFactory& make_simulator,
             const TrialOptions& options, std::function<void(const SampleRecord&)> finished,
             base::DiagnosticSink& sink);

 private:
  friend class Trial;

  TraceFeed& feed_;
};

enum class SampleVerdict : std::uint8_t {
  kAsPredicted,  // it went through the states of the trace, as far as they are compared
  kAdmitted,     // it went elsewhere, where the model lets these events lead, too
  kDiscrepancy,
  kLost,
  kLostTooOften,  // one loss too many in a row, which was reported
};

/// One simulation and what it says about the trace.
struct TrialSample {
  SampleRecord record;
  SampleVerdict verdict = SampleVerdict::kLost;
  Judgement judgement;  // of the observations; unset for a lost sample
};

/// Does the model let the events of the trace lead through the compared states? Of a simulation
/// that does not match the trace; undecided where the feed was stopped.
base::Known admitted_by_model(const Scenario& scenario, TraceFeed& feed, const CampaignTrace& trace,
                              const Judgement& judgement);

/// The sample as a row of a table; `cause` is that of a discrepancy, else null.
SampleRow judged_row(const TrialSample& sample, Comparison comparison, const Cause* cause);

/// The one loop that samples, taken apart: a trace is prepared, its samples are simulated by
/// workers that may run ahead, and each is judged in the order of its number. How many there are
/// to be and what is made of them is for the mode to say:
///
///     trial = Trial::prepare(bench, trace)
///     while the mode wants another sample:
///       trial.submit_to(the last one that it is sure to want)
///       sample = trial.next()            // failed: reported; none: stopped
///       take sample.record and sample.verdict into account
///     trial.end()
///
/// Every mode gets the same treatment of losses, refusals and of starts that are not what was
/// asked for.
class Trial {
 public:
  /// Reports what prepare_trace reports.
  static base::Result<Trial> prepare(TrialBench& bench, CampaignTrace trace);

  /// Samples on record in `journal`, which must outlive the trial, are taken from there instead of
  /// being simulated.
  void continue_from(const Journal& journal) { journal_ = &journal; }

  /// The trace from the first of its initial states.
  /// `announce` is called before the first sample from each further initial state; what it reports
  /// ends the trial.
  void announce_by(std::function<base::Status(const TracePlan&)> announce) {
    announce_ = std::move(announce);
  }

  const TracePlan& plan() const { return starts_.first(); }
  /// The trace from the initial state of a sample.
  const TracePlan& plan_of(const SampleRecord& record) const {
    return *starts_.known(record.start_state).plan;
  }
  /// The continuous states that the first initial state stands for.
  const StartCuboid& start() const { return plan().sampler.cuboid(); }
  StartStates& starts() { return starts_; }
  const StartStates& starts() const { return starts_; }
  std::int64_t next_sample() const { return next_; }  // from 1
  /// From now on the initial state of each sample is drawn by itself (StartStates::state_of). What
  /// ran ahead is forgotten.
  void draw_independently();

  /// Lets the workers simulate all samples up to this one, or up to one that cannot begin: what is
  /// wrong with that is reported by `next`, when its turn comes.
  void submit_to(std::int64_t last);
  /// Waits for the next sample. None when stopped, or where `ran_out` says so. Reports what prepare
  /// reports of its initial state. Reports and fails for a simulator that refuses a request
  /// (kSimulatorRefused), does not show what is compared (the same), or shows another initial state
  /// than it was put into (kStartNotTaken of an external one, else kMappingNotInverse), and for
  /// starts that are always invalid (kStartsRejected).
  base::Result<std::optional<TrialSample>> next();
  /// Has the next sample no initial state to begin in, because drawing ended?
  bool ran_out() const { return starts_.ran_out(next_); }
  /// The same from an initial state that is chosen; what ran ahead is forgotten.
  base::Result<std::optional<TrialSample>> visit(std::int64_t state);
  /// Simulates chosen starts, as the samples from number `first` on. They are not draws, and no
  /// claim rests on them. A start that is invalid or missing has the status kRejected and the
  /// verdict kLost. The last one is kLostTooOften where the rest was not simulated for it. None
  /// when stopped; reports what `next` reports, and kForeignJournalLine where the journal has
  /// another start under the number.
  base::Result<std::optional<std::vector<TrialSample>>> try_starts(
      std::int64_t first, std::vector<std::optional<ChosenStart>> starts);
  /// The samples up to this number were chosen ones: draws come after them.
  void begin_after(std::int64_t sample);
  /// Simulates the start and seed of `record` once more. None when stopped.
  std::optional<SampleRecord> repeat(const SampleRecord& record);
  /// The simulation on record, and how it is made and judged again; it was clean.
  CleanSample clean_sample(const SampleRecord& record) const;
  /// Forgets what ran ahead.
  void end() { bench_->pool_.abandon(); }

 private:
  Trial(TrialBench& bench, StartStates starts) : bench_(&bench), starts_(std::move(starts)) {}

  base::Result<std::optional<PreparedStart>> begin_in(std::int64_t state);
  base::Result<std::optional<PreparedStart>> begin_of(std::int64_t sample);
  base::Result<bool> submit_one();
  base::Result<std::optional<TrialSample>> judged(SampleRecord record);

  const SampleRecord* recorded(std::int64_t sample, DrawPhase phase) const;
  std::optional<SampleRecord> result_of(std::int64_t sample, DrawPhase phase, std::int64_t state);
  TrialSample lost(SampleRecord record);
  base::Result<std::optional<TrialSample>> observed(SampleRecord record);
  base::DiagnosticBuilder report_refused(const SampleRecord& record) const;
  base::DiagnosticBuilder report_missing(const SampleRecord& record,
                                         const std::string& variable) const;

  TrialBench* bench_;
  const Journal* journal_ = nullptr;
  StartStates starts_;
  std::function<base::Status(const TracePlan&)> announce_;
  std::set<std::int64_t> announced_;  // numbers of initial states
  bool independent_ = false;
  std::int64_t next_ = 1;       // the sample that `next` waits for
  std::int64_t submitted_ = 0;  // the last one that the workers were given or the journal has
  std::int64_t blocked_ = 0;    // one that could not begin when it was to run ahead
};

}  // namespace parallax::harness
