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
#include "harness/campaign/loop_cover.h"
#include "harness/campaign/loop_judge.h"
#include "harness/campaign/loop_stream.h"
#include "harness/campaign/repetition.h"
#include "harness/campaign/run_setup.h"
#include "harness/campaign/start_check.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/item_bounds.h"

namespace parallax::harness {
namespace {

using LoopClock = std::chrono::steady_clock;

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
        tally_(RegressionFrame{}),
        rated_(planned()),
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
    if (!prepared) return sink_.already_reported();
    if (!*prepared) return finished(true);
    auto journal = Journal::open(
        std::move(claimed_.folder), journal_header(scenario_, options_, result_.simulator),
        std::move(claimed_.recorded), scenario_.limits.max_lost_in_a_row, files_, sink_);
    if (!journal) return sink_.already_reported();
    journal_ = std::move(*journal);
    result_.journal_open = true;
    stream_.loop->initial_states = samples_.initial_states();
    stream_.loop->has_weights = samples_.has_weights();
    stream_.starts.all = samples_.initial_states();
    stream_.starts.law = scenario_.initial;
    if (scenario_.until_covered && !watch_what_is_shown()) return finished(true);
    if (!samples_.continue_from(*journal_)) return sink_.already_reported();
    const auto ended = sample();
    result_.failed = !ended;
    if (ended && *ended != End::kStopped && *ended != End::kLost) repeat_first_clean();
    if (result_.failed && tally_.runs() == 0) return sink_.already_reported();
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

  /// Called in a worker's thread; by then the journal is open.
  void keep(const SampleRecord& record) {
    if (is_repeating_) return;  // no sample, and on no journal
    const bool is_result =
        record.status == SampleStatus::kOk || record.status == SampleStatus::kLost;
    if (is_result) journal_->append(record);
  }

  base::Result<End> sample() {
    for (;;) {
      const auto decision = criterion_->decide(tally_);
      report_progress(decision);
      if (decision.stop && is_covered()) return End::kDecided;
      if (executions() >= limit_.max_runs) return End::kRunLimit;
      if (goes_on_anyway() && executions() >= planned() && is_covered()) return End::kPlanned;
      samples_.submit_to(last_wanted(decision));
      auto next = samples_.next();
      if (!next || !check_written(*journal_, options_, sink_)) return sink_.already_reported();
      if (!*next) return End::kStopped;
      auto end = consume(**std::move(next));
      if (!end) return sink_.already_reported();
      if (*end) return **end;
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
    cover_.emplace(*watch, scenario_.criterion);
    if (scenario_.limits.max_runs == 0) {
      limit_.max_runs = std::max(limit_.max_runs, 2 * cover_->runs_needed());
    }
    return true;
  }

  bool is_covered() const { return !cover_ || cover_->is_over(); }

  /// Something was found that ends other runs.
  bool goes_on_anyway() const {
    return options_.keep_going && (tally_.mismatch() > 0 || stream_.loop->unfinished > 0);
  }
  /// Those with a start that was drawn.
  std::int64_t executions() const { return tally_.runs() + drawn_unfinished_; }
  /// With --keep-going and a discrepancy: as many as if all had been clean, so that the number does
  /// not depend on what is found, and rates are rates.
  std::int64_t planned() const { return std::min(limit_.needed, limit_.max_runs); }

  /// The last sample to submit. Workers run ahead of the consumed samples, but not beyond what the
  /// criterion still asks for.
  std::int64_t last_wanted(const Decision& decision) const {
    const std::int64_t window = options_.jobs == 1 ? 1 : 2 * options_.jobs;
    const auto guided = stream_.loop->guided.value_or(0);
    auto asked = goes_on_anyway() ? planned() : decision.runs_needed.value_or(limit_.max_runs);
    if (!is_covered()) asked = std::max(asked, cover_->runs_needed());
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
    count(record);
    count_by_start(record, judgement.admitted == base::Known::kYes ? StartOutcome::kClean
                                                                    : StartOutcome::kDiscrepancy);
    if (judgement.admitted == base::Known::kNo) return accept(std::move(record), judgement);
    const auto unfinished = why_unfinished(*record.path, scenario_);
    using Kept = RunRecorder::Verdict;
    recorder_.judge(record, unfinished.empty() ? Kept::kClean : Kept::kFinding);
    const bool is_rated = note(record, true);
    auto& loop = *stream_.loop;
    if (unfinished.empty()) {
      if (!is_guided(record)) tally_.add_clean_elsewhere();
      if (is_rated) ++loop.causes_runs;
      ++stream_.clean;
    } else {
      if (!is_guided(record)) ++drawn_unfinished_;
      if (loop.unfinished++ == 0) loop.why_unfinished = unfinished;
    }
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

  /// Claims are about starts that were drawn; of others only what is found counts.
  static bool is_guided(const SampleRecord& record) { return !record.path->target.empty(); }
  void note_guided() { stream_.loop->guided = stream_.loop->guided.value_or(0) + 1; }

  /// An execution that came to a result. Is it one of those that rates are about?
  bool note(const SampleRecord& record, bool admitted) {
    if (cover_) cover_->note(record, admitted);
    if (is_guided(record)) {
      note_guided();
      return false;
    }
    if (cover_) cover_->add_drawn();
    return rated_.next();
  }

  std::optional<End> lost(SampleRecord record) {
    recorder_.judge(record, RunRecorder::Verdict::kNothing);
    stream_.rejected += record.rejected;
    count_law(record);
    if (is_guided(record)) {
      note_guided();
    } else {
      tally_.add_rejected(record.rejected);
      tally_.add_lost();
      if (cover_) cover_->add_lost();
      (void)rated_.next();  // it has its place, but what it would have shown is not known
    }
    count_loss(record, stream_);
    count_by_start(record, StartOutcome::kLost);
    tell(record, "lost");
    lost_too_often_ = bench_.lost_too_often(record, samples_.on_record(record));
    consumed_.push_back(std::move(record));
    return lost_too_often_ ? std::optional(End::kLost) : std::nullopt;
  }

  void count_law(const SampleRecord& record) {
    law_.add(samples_.start_of(record).sampler, options_.seed, loop_start_stream(), record);
  }

  void count(const SampleRecord& record) {
    count_law(record);
    if (!is_guided(record)) tally_.add_rejected(record.rejected);
    stream_.rejected += record.rejected;
    if (record.retries > 0) ++stream_.retried;
    count_path(record, *stream_.loop);
  }

  /// Repeats the first simulation of each cause once: a discrepancy that cannot be repeated says so
  /// in the report.
  std::optional<End> accept(SampleRecord record, const LoopJudgement& judgement) {
    recorder_.judge(record, RunRecorder::Verdict::kFinding);
    auto& causes = stream_.loop->causes;
    const auto known = std::find_if(causes.begin(), causes.end(), [&](const CauseRate& rate) {
      return rate.cause == judgement.cause.text;
    });
    if (known != causes.end()) {
      if (note_mismatch(record)) ++known->count;
      tell(record, "discrepancy", &judgement);
      consumed_.push_back(std::move(record));
      return std::nullopt;
    }
    const auto again = samples_.repeat(record, options_.keep_going);
    if (!again) return End::kStopped;
    const std::int64_t rated = note_mismatch(record) ? 1 : 0;
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

  /// Is it one of those that rates are about?
  bool note_mismatch(const SampleRecord& record) {
    const bool is_rated = note(record, false);
    if (!is_guided(record)) tally_.add_mismatch();
    if (is_rated) ++stream_.loop->causes_runs;
    return is_rated;
  }

  void report_progress(const Decision& decision) const {
    if (!options_.progress) return;
    const std::chrono::duration<double> elapsed = LoopClock::now() - started_;
    CampaignProgress progress;
    progress.trace = 1;
    progress.done = tally_.runs();
    progress.needed = goes_on_anyway() ? planned()
                                       : std::min(decision.runs_needed.value_or(limit_.max_runs),
                                                  limit_.max_runs);
    if (!is_covered()) {
      progress.needed = std::min(std::max(progress.needed, cover_->runs_needed()), limit_.max_runs);
    }
    const auto made = static_cast<double>(bench_.runs_made());
    progress.runs_per_s = elapsed.count() > 0.0 ? made / elapsed.count() : 0.0;
    options_.progress(progress);
  }

  void fill_stream() {
    auto& stream = stream_;
    stream.law = law_.result();
    stream.left_out = law_.drawn().left_out;
    stream.is_decided =
        criterion_->decide(tally_).stop && stream.loop->unfinished == 0 && is_covered();
    stream.verdict = !result_.discrepancies.empty() ? CampaignVerdict::kDiscrepancy
                     : stream.is_decided            ? CampaignVerdict::kNoDiscrepancy
                                                    : CampaignVerdict::kInconclusive;
    stream.simulations = executions() + stream.loop->guided.value_or(0);
    claim_executions(scenario_, tally_, law_.drawn(), stream);
    if (feed_.plan().performs().empty()) {
      stream.caveats.emplace_back("the plan performs nothing: initial states alone were compared");
    }
    add_loop_caveats(stream);
    rate_causes(rated_, lost_too_often_, result_.interrupted, stream);
    const auto* found = result_.discrepancies.empty() ? nullptr : &result_.discrepancies.front();
    add_loss_caveats(stream);
    add_simulator_caveats(result_.simulator, found, stream);
  }

  void fill_cover() {
    if (!cover_) return;
    const auto& cover =
        stream_.loop->cover.emplace(cover_->result(executions() >= limit_.max_runs));
    using CoverEnd = CoverResult::End;
    if (cover.end == CoverEnd::kShown) result_.exploration = to_string(cover.end);
    if (cover.end == CoverEnd::kRare) result_.exploration = "complete up to bound";
  }

  base::Result<CampaignResult> finished(bool interrupted) {
    bench_.close();
    if (lost_too_often_ && may_repeat_losses(result_.simulator)) {
      // Left in the journal they would end every continuation where this run ended.
      while (!consumed_.empty() && consumed_.back().status == SampleStatus::kLost) {
        consumed_.pop_back();
      }
    }
    if (!interrupted && !result_.failed) recorder_.finish(consumed_);
    recorder_.report(sink_);
    if (!interrupted && !result_.failed) {
      if (!journal_->rewrite({}, std::move(consumed_), sink_)) return sink_.already_reported();
    }
    result_.interrupted = interrupted;
    fill_cover();
    fill_stream();
    result_.verdict = interrupted && stream_.verdict != CampaignVerdict::kDiscrepancy
                          ? CampaignVerdict::kInconclusive
                          : stream_.verdict;
    result_.simulations = stream_.simulations;
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
  Tally tally_;
  LawCounter law_;
  FixedCount rated_;
  std::optional<LoopCover> cover_;  // of a run that goes on until everything was shown
  std::int64_t drawn_unfinished_ = 0;
  std::unique_ptr<Journal> journal_;
  CampaignResult result_;
  TraceResult stream_;
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
