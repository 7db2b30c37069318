#include "harness/campaign/trace_campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/compare.h"
#include "harness/campaign/judge.h"
#include "harness/campaign/start_blame.h"
#include "harness/confidence/claim.h"
#include "harness/confidence/regression_frame.h"

namespace parallax::harness {
namespace {

using base::DiagnosticCode;
using Clock = std::chrono::steady_clock;

std::set<std::string> as_set(const std::vector<std::string>& names) {
  return {names.begin(), names.end()};
}

class TraceCampaign {
 public:
  TraceCampaign(const TraceContext& context, std::shared_ptr<const TracePlan> plan,
                const StartCuboid& start)
      : context_(context),
        plan_(std::move(plan)),
        tally_(regression_frame(*context.scenario.mapping, start, context.fluents,
                                as_set(plan_->trace.holds.back()))) {
    auto& result = outcome_.result;
    result.number = plan_->trace.number;
    result.events = plan_->trace.events;
    result.initial_state = plan_->trace.holds.front();
    result.start_region = start.dimensions;
    result.not_compared = ignored_fluents(*context.scenario.mapping, context.fluents);
  }

  base::Result<TraceOutcome> run() {
    for (std::int64_t sample = 1;; ++sample) {
      decision_ = context_.criterion.decide(tally_);
      report_progress();
      if (decision_.stop) return finished(TraceEnd::kDecided);
      if (tally_.runs() >= context_.max_runs) return finished(TraceEnd::kRunLimit);
      schedule_from(sample);
      auto record = result_of(sample, Phase::kCertify);
      if (!record) return ended_early();
      const auto more = consume(std::move(*record));
      if (!more) return context_.sink.already_reported();
      if (more->end) return finished(*more->end);
    }
  }

 private:
  struct Step {
    std::optional<TraceEnd> end;  // none: go on
  };

  bool stopped() const {
    const auto* stop = context_.options.stop;
    return stop != nullptr && stop->load();
  }

  /// Workers run ahead of what is consumed, but not beyond what the criterion still asks for.
  void schedule_from(std::int64_t sample) {
    const std::int64_t jobs = context_.options.jobs;
    const std::int64_t window = jobs == 1 ? 1 : 2 * jobs;
    const auto needed = std::max(decision_.runs_needed.value_or(context_.max_runs), sample);
    const auto last = std::min({sample + window - 1, needed, context_.max_runs});
    next_ = std::max(next_, sample);
    for (; next_ <= last; ++next_) {
      if (recorded(next_, Phase::kCertify) == nullptr) context_.pool.submit(plan_, next_);
    }
  }

  const SampleRecord* recorded(std::int64_t sample, Phase phase) const {
    return context_.journal.find(plan_->trace.number, sample, phase);
  }

  std::optional<SampleRecord> result_of(std::int64_t sample, Phase phase) {
    if (const auto* known = recorded(sample, phase)) {
      if (stopped()) return std::nullopt;
      return *known;
    }
    return context_.pool.wait(sample, phase);
  }

  base::Result<TraceOutcome> ended_early() { return finished(TraceEnd::kStopped); }

  base::Result<Step> consume(SampleRecord record) {
    const auto error = context_.journal.write_error();
    if (!error.empty()) {
      const auto path = context_.options.run_dir / kJournalName;
      return context_.sink.error_about(DiagnosticCode::kFileNotWritable, path.string(), error);
    }
    tally_.add_rejected(record.rejected);
    outcome_.result.rejected += record.rejected;
    switch (record.status) {
      case SampleStatus::kRejected:
        return report_rejected(context_.scenario, plan_->trace, record.rejected, record.sample,
                               record.reason, context_.sink);
      case SampleStatus::kRefused:
        return context_.sink.error(DiagnosticCode::kSimulatorRefused,
                                   context_.scenario.actions_source, "a request", record.reason);
      case SampleStatus::kLost:
        return consume_lost(std::move(record));
      case SampleStatus::kOk:
        break;
    }
    return consume_observed(std::move(record));
  }

  base::Result<Step> consume_lost(SampleRecord record) {
    tally_.add_lost();
    ++outcome_.result.lost;
    ++context_.lost_in_a_row;
    const auto reason = record.reason;
    // Such a row on record has ended a run, which somebody continues knowing of it.
    const bool known = recorded(record.sample, record.phase) != nullptr;
    outcome_.consumed.push_back(std::move(record));
    if (context_.lost_in_a_row < context_.scenario.limits.max_lost_in_a_row) return Step{};
    if (known) {
      context_.lost_in_a_row = 0;
      return Step{};
    }
    context_.sink.error(DiagnosticCode::kSimulatorLost, context_.scenario.simulator.source,
                        context_.lost_in_a_row, reason);
    return Step{TraceEnd::kLostTooOften};
  }

  base::Result<Step> consume_observed(SampleRecord record) {
    const auto judgement =
        judge(*context_.scenario.mapping, context_.fluents, plan_->trace, record.observations);
    if (!judgement.missing.empty()) {
      return context_.sink.error(DiagnosticCode::kSimulatorRefused,
                                 context_.scenario.mapping_source, "an observation",
                                 fmt::format("it lacks `{}`", *judgement.missing.begin()));
    }
    if (judgement.first_divergence == 0) {
      const auto& fluent = judgement.first.front();
      if (!context_.scenario.simulator.command.empty()) {
        return context_.sink.error(
            DiagnosticCode::kStartNotTaken, context_.scenario.simulator.source, record.sample,
            record.trace,
            fmt::format("`{}` {}", fluent.fluent, fluent.observed ? "holds" : "does not hold"));
      }
      return context_.sink.error(
          DiagnosticCode::kMappingNotInverse, context_.scenario.mapping_source, record.sample,
          record.trace, fluent.observed ? "a state with" : "a state without", fluent.fluent);
    }
    context_.lost_in_a_row = 0;
    if (record.retries > 0) ++outcome_.result.retried;
    if (judgement.matches()) {
      if (judgement.first_divergence) ++outcome_.result.strayed;
      add_clean_run(tally_, record.initial, record.observations.back());
    } else {
      const bool open =
          context_.scenario.match_model && !judgement.in_no_state && plan_->trace.other_outcomes;
      const auto admitted =
          open ? context_.feed.admits(plan_->trace, judgement.last_state) : base::Known::kNo;
      if (admitted == base::Known::kUndecided || stopped()) return Step{TraceEnd::kStopped};
      if (admitted == base::Known::kNo) return accept_discrepancy(std::move(record), judgement);
      tally_.add_clean_elsewhere();
      ++outcome_.result.admitted;
    }
    ++outcome_.result.clean;
    outcome_.consumed.push_back(std::move(record));
    return Step{};
  }

  /// Repeats the simulation once: a discrepancy that cannot be repeated says so in the report.
  base::Result<Step> accept_discrepancy(SampleRecord record, const Judgement& judgement) {
    if (recorded(record.sample, Phase::kConfirm) == nullptr) {
      context_.pool.abandon();  // nothing that ran ahead is needed any more
      context_.pool.submit_repeat(plan_, record);
    }
    const auto again = result_of(record.sample, Phase::kConfirm);
    if (!again) return Step{TraceEnd::kStopped};
    tally_.add_mismatch();
    Discrepancy found;
    found.trace = record.trace;
    found.sample = record.sample;
    found.seed = record.seed;
    found.first_divergence = *judgement.first_divergence;
    found.first = judgement.first;
    found.fluents = judgement.last;
    found.cause = cause_of(plan_->trace, judgement, record.outcomes);
    if (again->status == SampleStatus::kLost) {
      found.confirmation = Confirmation::kLost;
    } else if (first_difference(record, *again)) {
      found.confirmation = Confirmation::kDiffers;
    }
    found.record = record;
    found.end =
        mapped_part(*context_.scenario.mapping, context_.fluents, record.observations.back());
    outcome_.discrepancy = std::move(found);
    outcome_.consumed.push_back(std::move(record));
    outcome_.consumed.push_back(*again);
    return Step{TraceEnd::kDiscrepancy};
  }

  void report_progress() const {
    if (!context_.options.progress) return;
    const std::chrono::duration<double> elapsed = Clock::now() - started_;
    const auto made = context_.pool.runs_made() - runs_before_;
    CampaignProgress progress;
    progress.trace = plan_->trace.number;
    progress.done = tally_.runs();
    progress.needed =
        std::min(decision_.runs_needed.value_or(context_.max_runs), context_.max_runs);
    progress.runs_per_s = elapsed.count() > 0.0 ? static_cast<double>(made) / elapsed.count() : 0.0;
    context_.options.progress(progress);
  }

  TraceOutcome finished(TraceEnd end) {
    context_.pool.abandon();
    const auto& criterion = context_.scenario.criterion;
    auto& result = outcome_.result;
    outcome_.end = end;
    result.verdict = end == TraceEnd::kDecided       ? CampaignVerdict::kNoDiscrepancy
                     : end == TraceEnd::kDiscrepancy ? CampaignVerdict::kDiscrepancy
                                                     : CampaignVerdict::kInconclusive;
    result.simulations = tally_.runs();
    const auto bound = certified_bound(tally_, criterion.confidence_level);
    result.certified_level = bound.confidence_level;
    result.certified_epsilon = bound.epsilon;
    result.paper_stopped_at = paper_stopped_at(tally_, criterion.paper, criterion.confidence_level);
    result.paper_variant = paper_variant(tally_, criterion.paper);
    result.not_covered = tally_.frame().not_covered;
    result.claim = claim(tally_, criterion);
    result.caveats = caveats(tally_, criterion);
    add_own_caveats(result);
    return std::move(outcome_);
  }

  void add_own_caveats(TraceResult& result) const {
    if (plan_->trace.other_outcomes && context_.scenario.match_model) {
      result.caveats.push_back(
          "the model leaves the outcome of these events open; an end state counts as predicted if "
          "the model admits it");
    }
    if (plan_->trace.other_initial_states) {
      result.caveats.push_back(
          "other initial states lead to the same events; only the first, in the model's order, was "
          "sampled");
    }
    if (!context_.criterion.is_anytime_valid()) {
      result.caveats.push_back(fmt::format(
          "the criterion `{}` looks again after every run and is not made for it: its level is not "
          "the probability of a false stop",
          context_.criterion.name()));
    }
    if (result.retried > 0) {
      result.caveats.push_back(fmt::format(
          "{} lost at first and observed when repeated with the same start and seed",
          result.retried == 1 ? "1 run was" : fmt::format("{} runs were", result.retried)));
    }
    if (result.strayed > 0) {
      result.caveats.push_back(fmt::format(
          "{} of the clean runs left the trace on the way and ended as predicted", result.strayed));
    }
    if (!context_.simulator.seeds) {
      result.caveats.push_back(
          "the simulator takes no seed, so its own randomness is not under control");
    }
    const auto& found = outcome_.discrepancy;
    if (found && found->confirmation == Confirmation::kDiffers) {
      result.caveats.push_back(
          "the simulator is not deterministic: the same start and seed gave another result");
    }
    if (found && found->confirmation == Confirmation::kLost) {
      result.caveats.push_back("the simulator was lost when the discrepancy was repeated");
    }
  }

  const TraceContext& context_;
  std::shared_ptr<const TracePlan> plan_;
  Tally tally_;
  Decision decision_;
  TraceOutcome outcome_;
  std::int64_t next_ = 1;  // first sample that was not scheduled
  Clock::time_point started_ = Clock::now();
  std::int64_t runs_before_ = context_.pool.runs_made();
};

}  // namespace

base::Result<TraceOutcome> run_trace(const TraceContext& context,
                                     std::shared_ptr<const TracePlan> plan,
                                     const StartCuboid& start) {
  return TraceCampaign(context, std::move(plan), start).run();
}

}  // namespace parallax::harness
