#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/contract.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/loop_counts.h"
#include "harness/campaign/loop_judge.h"
#include "harness/campaign/loop_stream.h"
#include "harness/campaign/loop_tally.h"
#include "harness/campaign/repetition.h"
#include "harness/campaign/run_setup.h"
#include "harness/campaign/start_check.h"
#include "harness/campaign/start_visits.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/criterion.h"

namespace parallax::harness {
namespace {

using LoopClock = std::chrono::steady_clock;

bool has_no_execution(const base::DiagnosticSink& sink) {
  const auto said = sink.sorted();
  return std::any_of(said.begin(), said.end(), [](const base::Diagnostic& each) {
    return each.code == codes::kModelUnsatisfiable;
  });
}

class LoopCampaign {
 public:
  LoopCampaign(const Scenario& scenario, ClaimedRun claimed, LoopFeed& feed,
               const SimulatorFactory& make_simulator, const CampaignOptions& options,
               base::SourceFiles& files, base::DiagnosticSink& sink)
      : scenario_(scenario),
        claimed_(std::move(claimed)),
        feed_(feed),
        options_(options),
        files_(files),
        sink_(sink),
        criterion_(make_criterion(scenario.criterion)),
        limit_(run_limit(scenario)),
        tally_(planned(), options.seed, stream_),
        samples_(scenario, feed, bench_, options.seed, sink),
        recorder_(options.record, options.run_dir),
        bench_(
            scenario, *feed.symbols(), make_simulator,
            {options.seed, options.jobs, options.stop, recorder_.taker()},
            [this](const SampleRecord& record) { keep(record); }, sink) {
    describe_run(scenario, options, bench_.fluents().ground(), result_);
    result_.execution = Execution::kClosedLoop;
    result_.exploration = "stopped";
    stream_.loop.emplace();
    if (scenario.starts == Starts::kGuided) stream_.loop->guided = 0;
    stream_.trace = LoopStream::start_state(feed, {});
  }

  base::Result<CampaignResult> run() {
    const auto started = bench_.start();
    if (!started) return sink_.already_reported();
    if (!*started) return finished(true);
    result_.simulator = bench_.simulator();
    recorder_.set_simulator(result_.simulator);
    const auto prepared = samples_.prepare();
    if (!prepared) {
      // Repair needs the folder: if the world is a model, too, it says why this one has no start.
      if (!scenario_.simulator.models.empty() && has_no_execution(sink_)) (void)open_journal();
      return sink_.already_reported();
    }
    if (!*prepared) return finished(true);
    if (!open_journal()) return sink_.already_reported();
    result_.journal_open = true;
    stream_.loop->initial_states = samples_.initial_states();
    stream_.loop->has_weights = samples_.has_weights();
    stream_.starts.unrealisable = samples_.unrealisable();
    stream_.starts.all = samples_.initial_states() + std::ssize(samples_.unrealisable());
    stream_.starts.law = scenario_.initial;
    if (scenario_.until_covered && !watch_what_is_shown()) return finished(true);
    if (!samples_.continue_from(*journal_)) return sink_.already_reported();
    auto ended = sample();
    if (ended && *ended == End::kDecided) ended = visit_others();
    result_.failed = !ended;
    if (ended && *ended != End::kStopped && *ended != End::kLost) repeat_first_clean();
    if (result_.failed && tally_.runs().runs() == 0) return sink_.already_reported();
    return finished(!ended || *ended == End::kStopped);
  }

 private:
  enum class End : std::uint8_t {
    kDecided,
    kDiscrepancy,
    kRunLimit,
    kPlanned,
    kUnfinished,
    kLost,
    kStopped
  };

  base::Status open_journal() {
    auto journal = Journal::open(
        std::move(claimed_.folder), journal_header(scenario_, options_, result_.simulator),
        std::move(claimed_.recorded), scenario_.limits.max_lost_in_a_row, files_, sink_);
    if (!journal) return sink_.already_reported();
    journal_ = std::move(*journal);
    return base::Unit{};
  }

  /// Called in a worker's thread; by then the journal is open.
  void keep(const SampleRecord& record) {
    if (is_repeating_) return;  // no sample, and on no journal
    const bool is_result =
        record.status == SampleStatus::kOk || record.status == SampleStatus::kLost;
    if (is_result) journal_->append(record);
  }

  base::Result<End> sample() {
    for (;;) {
      const auto decision = criterion_->decide(tally_.runs());
      report_progress(decision);
      if (decision.stop && tally_.is_covered()) return End::kDecided;
      if (tally_.executions() >= limit_.max_runs) return End::kRunLimit;
      if (goes_on_anyway() && tally_.executions() >= planned() && tally_.is_covered())
        return End::kPlanned;
      samples_.submit_to(last_wanted(decision));
      auto next = samples_.next();
      if (!next || !check_written(*journal_, options_, sink_)) return sink_.already_reported();
      if (!*next) return End::kStopped;
      auto end = consume(**std::move(next));
      if (!end) return sink_.already_reported();
      if (*end) return **end;
    }
  }

  /// Enough was executed for the claim: the initial states that nothing was seen of are executed
  /// once each. These executions count for no claim.
  base::Result<End> visit_others() {
    auto& starts = stream_.starts;
    VisitRounds rounds(starts, starts.is_single() ? 0 : samples_.initial_states());
    for (;;) {
      const auto left = rounds.next(limit_.most - tally_.executions() - starts.visits);
      if (left.empty()) return End::kDecided;
      for (const auto state : left) {
        auto record = samples_.visit(state);
        if (!check_written(*journal_, options_, sink_)) return sink_.already_reported();
        if (!record) return End::kStopped;
        ++starts.visits;
        const auto end = consume(*std::move(record));
        if (!end) return sink_.already_reported();
        if (*end) return **end;
      }
    }
  }

  /// Counts an execution by its initial state.
  void count_by_start(const SampleRecord& record, StartOutcome outcome) {
    const auto text = [this](std::int64_t state) { return samples_.text(state); };
    const bool is_single = stream_.starts.is_single();
    count_start(is_single ? 0 : record.path->start, outcome, text, stream_.starts);
  }

  /// False when stopped.
  bool watch_what_is_shown() {
    auto* watch = feed_.cover(options_.seed);
    if (watch == nullptr) return false;
    tally_.watch(*watch, scenario_.criterion);
    if (scenario_.limits.max_runs == 0) {
      limit_.max_runs = std::max(limit_.max_runs, 2 * tally_.cover()->runs_needed());
      limit_.most = std::max(limit_.most, limit_.max_runs);
    }
    return true;
  }

  /// Something was found that ends other runs.
  bool goes_on_anyway() const {
    return options_.keep_going && (tally_.runs().mismatch() > 0 || stream_.loop->unfinished > 0);
  }
  /// With --keep-going and a discrepancy: as many as if all had been clean, so that the number does
  /// not depend on what is found, and rates are rates.
  std::int64_t planned() const { return std::min(limit_.needed, limit_.max_runs); }

  /// The last sample to submit. Workers run ahead of the consumed samples, but not beyond what the
  /// criterion still asks for.
  std::int64_t last_wanted(const Decision& decision) const {
    const std::int64_t window = options_.jobs == 1 ? 1 : 2 * options_.jobs;
    const auto guided = stream_.loop->guided.value_or(0);
    auto asked = goes_on_anyway() ? planned() : decision.runs_needed.value_or(limit_.max_runs);
    if (!tally_.is_covered()) asked = std::max(asked, tally_.cover()->runs_needed());
    const auto needed = std::max(asked + guided, samples_.next_sample());
    return std::min({samples_.next_sample() + window - 1, needed, limit_.max_runs + guided});
  }

  /// Takes in one sample. Returns the end that it causes, if any.
  base::Result<std::optional<End>> consume(SampleRecord record) {
    const auto& start = samples_.start_of(record);
    if (record.status == SampleStatus::kRejected) {
      return report_rejected(scenario_, *start.state, record.rejected, record.sample, record.reason,
                             sink_);
    }
    if (record.status == SampleStatus::kRefused) return samples_.report_refused(record);
    if (record.status == SampleStatus::kLost) return lost(std::move(record));
    const auto& mapping = *scenario_.mapping;
    const auto first = judge(mapping, bench_.fluents(), *start.state, {record.observations[0]});
    if (first.missing.empty() && first.first_divergence) {
      return report_other_start(scenario_, record, first.first.front(), sink_);
    }
    const auto judgement =
        judge_path(mapping, bench_.fluents(), feed_, record, scenario_.comparison());
    if (!judgement.missing.empty()) {
      return sink_.error(codes::kSimulatorRefused, scenario_.mapping_source,
                         fmt::format("does not show what is compared in simulation {}.{}",
                                     record.trace, record.sample),
                         fmt::format("its observations lack `{}`", judgement.missing));
    }
    if (judgement.admitted == base::Known::kUndecided || bench_.stopped()) {
      return std::optional(End::kStopped);
    }
    bench_.end_row_of_losses();
    count_by_start(record, judgement.admitted == base::Known::kYes ? StartOutcome::kClean
                                                                   : StartOutcome::kDiscrepancy);
    if (judgement.admitted == base::Known::kNo) return accept(std::move(record), judgement);
    const auto unfinished = why_unfinished(*record.path, scenario_);
    using Kept = RunRecorder::Verdict;
    recorder_.judge(record, !unfinished.empty() ? Kept::kFinding
                            : record.visit      ? Kept::kNothing
                                                : Kept::kClean);
    tally_.add_admitted(record, start.sampler, unfinished);
    tell(record, unfinished.empty() ? "clean" : "unfinished");
    if (unfinished.empty() && !clean_) clean_ = samples_.clean_sample(record);
    consumed_.push_back(std::move(record));
    if (unfinished.empty() || options_.keep_going) return std::optional<End>();
    return std::optional(End::kUnfinished);
  }

  /// Does the simulator do what it did at first? Only where something is claimed of clean runs.
  void repeat_first_clean() {
    if (!clean_ || !result_.discrepancies.empty()) return;
    is_repeating_ = true;
    sampled_ = {0.0, bench_.simulated_s(), bench_.runs_made()};
    result_.repetition = repeat_clean(*clean_, bench_);
  }

  void tell(const SampleRecord& record, const char* outcome,
            const LoopJudgement* judgement = nullptr) const {
    if (!options_.on_sample) return;
    auto row = sample_row(record, outcome);
    if (judgement != nullptr) {
      row.event = judgement->divergence.event;
      row.cause = judgement->cause.text;
      row.reason = judgement->cause.reason;
    }
    options_.on_sample(std::move(row));
  }

  std::optional<End> lost(SampleRecord record) {
    recorder_.judge(record, RunRecorder::Verdict::kNothing);
    tally_.add_lost(record, samples_.start_of(record).sampler);
    count_by_start(record, StartOutcome::kLost);
    tell(record, "lost");
    lost_too_often_ = bench_.lost_too_often(record, samples_.on_record(record));
    consumed_.push_back(std::move(record));
    return lost_too_often_ ? std::optional(End::kLost) : std::nullopt;
  }

  /// Repeats the first simulation of each cause once: a discrepancy that cannot be repeated says so
  /// in the report.
  std::optional<End> accept(SampleRecord record, const LoopJudgement& judgement) {
    recorder_.judge(record, RunRecorder::Verdict::kFinding);
    const auto& sampler = samples_.start_of(record).sampler;
    auto& causes = stream_.loop->causes;
    const auto known = std::find_if(causes.begin(), causes.end(), [&](const CauseRate& rate) {
      return rate.cause == judgement.cause.text;
    });
    if (known != causes.end()) {
      if (tally_.add_mismatch(record, sampler)) ++known->count;
      tell(record, "discrepancy", &judgement);
      consumed_.push_back(std::move(record));
      return std::nullopt;
    }
    const auto again = samples_.repeat(record, options_.keep_going);
    if (!again) return End::kStopped;
    const std::int64_t rated = tally_.add_mismatch(record, sampler) ? 1 : 0;
    tell(record, "discrepancy", &judgement);
    if (options_.keep_going) {
      causes.push_back({judgement.cause.text, rated, 0.0, 0.0, 0.0, record.sample,
                        judgement.cause.reason, record.initial});
    }
    auto found = path_discrepancy(record, judgement, *again);
    found.end =
        mapped_part(*scenario_.mapping, bench_.fluents().ground(), record.observations.back());
    consumed_.push_back(std::move(record));
    consumed_.push_back(*again);
    result_.discrepancies.push_back(std::move(found));
    return options_.keep_going ? std::nullopt : std::optional(End::kDiscrepancy);
  }

  void report_progress(const Decision& decision) const {
    if (!options_.progress) return;
    const std::chrono::duration<double> elapsed = LoopClock::now() - started_;
    CampaignProgress progress;
    progress.trace = 1;
    progress.done = tally_.runs().runs();
    progress.needed = goes_on_anyway() ? planned()
                                       : std::min(decision.runs_needed.value_or(limit_.max_runs),
                                                  limit_.max_runs);
    if (!tally_.is_covered()) {
      progress.needed =
          std::min(std::max(progress.needed, tally_.cover()->runs_needed()), limit_.max_runs);
    }
    const auto made = static_cast<double>(bench_.runs_made());
    progress.runs_per_s = elapsed.count() > 0.0 ? made / elapsed.count() : 0.0;
    options_.progress(progress);
  }

  void fill_stream() {
    auto& stream = stream_;
    stream.law = tally_.law().result();
    stream.left_out = tally_.law().drawn().left_out;
    stream.is_decided = criterion_->decide(tally_.runs()).stop && stream.loop->unfinished == 0 &&
                        tally_.is_covered();
    const auto* found = result_.discrepancies.empty() ? nullptr : &result_.discrepancies.front();
    const auto other_starts = tally_.echo().faults();
    stream.began_elsewhere = !other_starts.empty();
    const bool is_shown = stream.is_decided && stream.starts.is_covered() && other_starts.empty();
    stream.verdict = found != nullptr ? CampaignVerdict::kDiscrepancy
                     : is_shown       ? CampaignVerdict::kNoDiscrepancy
                                      : CampaignVerdict::kInconclusive;
    stream.simulations = tally_.executions() + stream.loop->guided.value_or(0);
    claim_executions(scenario_, tally_.runs(), tally_.law().drawn(), stream);
    const auto left_out = feed_.reservation();
    const bool is_claimed = !stream.claim.empty() && stream.loop->unfinished == 0;
    if (is_claimed && !left_out.empty()) stream.claim += fmt::format(" ({})", left_out);
    if (found != nullptr && found->record.visit) stream.claim = kFoundByVisit;
    if (feed_.plan().performs().empty()) {
      stream.caveats.emplace_back("the plan performs nothing: initial states alone were compared");
    }
    stream.caveats.insert(stream.caveats.end(), other_starts.begin(), other_starts.end());
    add_loop_caveats(stream);
    if (found == nullptr) {
      add_start_caveats(stream.starts, tally_.executions(), limit_.most, stream.caveats);
    }
    rate_causes(tally_.rated(), lost_too_often_, result_.interrupted, stream);
    add_loss_caveats(stream);
    add_simulator_caveats(result_.simulator, found, stream);
  }

  void fill_cover() {
    if (!tally_.cover()) return;
    const auto& cover =
        stream_.loop->cover.emplace(tally_.cover()->result(tally_.executions() >= limit_.max_runs));
    using CoverEnd = CoverResult::End;
    if (cover.end == CoverEnd::kShown) result_.exploration = to_string(cover.end);
    if (cover.end == CoverEnd::kRare) result_.exploration = "complete up to bound";
    if (cover.end == CoverEnd::kShown && !feed_.reservation().empty()) {
      result_.exploration = "complete up to bound";
    }
  }

  base::Result<CampaignResult> finished(bool interrupted) {
    bench_.close();
    if (lost_too_often_ && may_repeat_losses(result_.simulator)) {
      // Left in the journal they would end every continuation where this run ended.
      while (!consumed_.empty() && consumed_.back().status == SampleStatus::kLost) {
        consumed_.pop_back();
      }
    }
    stream_.simulated_s = result_.simulated_s = simulated_s(consumed_);
    result_.kinds = count_kinds(consumed_);
    if (!interrupted && !result_.failed) recorder_.finish(consumed_);
    recorder_.report(sink_);
    if (!interrupted && !result_.failed) {
      if (!journal_->rewrite({}, std::move(consumed_), sink_)) return sink_.already_reported();
    }
    result_.interrupted = interrupted;
    fill_cover();
    fill_stream();
    result_.bounds = feed_.bounds();
    result_.verdict = interrupted && stream_.verdict != CampaignVerdict::kDiscrepancy
                          ? CampaignVerdict::kInconclusive
                          : stream_.verdict;
    result_.simulations = stream_.simulations;
    stream_.wall_s = std::chrono::duration<double>(LoopClock::now() - started_).count();
    result_.traces.push_back(std::move(stream_));
    apply_repetition(result_);
    if (!result_.repetition.holds()) result_.verdict = CampaignVerdict::kInconclusive;
    note_timing(bench_, started_, result_);
    if (is_repeating_) {
      result_.timing.runs_made = sampled_.runs_made;
      result_.timing.simulated_s = sampled_.simulated_s;
    }
    return std::move(result_);
  }

  const Scenario& scenario_;
  ClaimedRun claimed_;  // until the journal takes it over
  LoopFeed& feed_;
  const CampaignOptions& options_;
  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  LoopClock::time_point started_ = LoopClock::now();
  std::unique_ptr<ConfidenceCriterion> criterion_;
  RunLimit limit_;
  TraceResult stream_;
  LoopTally tally_;
  std::unique_ptr<Journal> journal_;
  CampaignResult result_;
  std::vector<SampleRecord> consumed_;
  std::optional<CleanSample> clean_;  // the first
  bool is_repeating_ = false;         // set before workers repeat it
  CampaignResult::Timing sampled_;    // what samples took, before it was repeated
  bool lost_too_often_ = false;
  LoopStream samples_;
  RunRecorder recorder_;
  SimulatorBench bench_;  // last, so that its threads end before what they use
};

}  // namespace

base::Result<CampaignResult> run_loop_campaign(const Scenario& scenario, LoopFeed& feed,
                                               const SimulatorFactory& make_simulator,
                                               const CampaignOptions& options,
                                               base::SourceFiles& files,
                                               base::DiagnosticSink& sink) {
  PARALLAX_REQUIRE(scenario.mapping.has_value(), "a scenario that was loaded without errors");
  auto claimed = claim_run(scenario, options, files, sink);
  if (!claimed) return sink.already_reported();
  return LoopCampaign(scenario, std::move(*claimed), feed, make_simulator, options, files, sink)
      .run();
}

}  // namespace parallax::harness
