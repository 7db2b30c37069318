#include "harness/campaign/trace_campaign.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <set>

#include "harness/campaign/judge.h"
#include "harness/campaign/run_setup.h"
#include "harness/campaign/sample_record.h"
#include "harness/campaign/search_phase.h"
#include "harness/campaign/start_echo.h"
#include "harness/campaign/start_visits.h"
#include "harness/campaign/start_words.h"
#include "harness/confidence/criterion.h"
#include "harness/confidence/regression.h"

namespace parallax::harness {
namespace {

using Clock = std::chrono::steady_clock;

std::set<std::string> as_set(const runtime::Names& names) { return {names.begin(), names.end()}; }

class TraceCampaign {
 public:
  TraceCampaign(const TraceContext& context, Trial trial)
      : context_(context),
        trial_(std::move(trial)),
        tally_(regression_frame(*context.scenario.mapping, trial_.start(),
                                context.bench.fluents().ground(),
                                as_set(trace().holds(trace().event_count())))),
        spec_(context.scenario.criterion) {
    criterion_ = make_criterion(spec_);
    limit_ = run_limit(context_.scenario);
    if (context_.family.is_settled()) (void)share_error();
    // With failures, the bound of Clopper and Pearson holds for independent draws only.
    if (criterion_->kind() == CriterionKind::kClopperPearson) trial_.draw_independently();
    auto& result = outcome_.result;
    result.trace = trial_.plan().trace;
    result.start_region = trial_.start().dimensions;
    trial_.starts().describe(result.starts, trial_.next_sample() - 1);
    law_.name(trial_.plan().sampler);
    result.left_out = law_.drawn().left_out;
    result.start_shares =
        start_shares(*context.scenario.mapping, as_set(result.trace->holds(0)), trial_.start(),
                     result.left_out.empty() ? 0.0 : trial_.plan().sampler.inset());
  }

  base::Result<TraceOutcome> run() {
    if (context_.scenario.search.runs > 0) {
      report_progress();  // a search tells nothing until it is over
      const auto end = search();
      if (!end) return context_.sink.already_reported();
      if (*end) return finished(**end);
    }
    for (;;) {
      decision_ = criterion_->decide(tally_);
      if ((decision_.stop || tally_.runs() >= limit_.max_runs) && !share_error()) {
        return finished(TraceEnd::kStopped);
      }
      report_progress();
      if (decision_.stop) {
        const auto end = visit_others();
        if (!end) return context_.sink.already_reported();
        return finished(*end);
      }
      if (tally_.runs() >= limit_.max_runs) return finished(TraceEnd::kRunLimit);
      trial_.submit_to(last_wanted());
      auto sample = trial_.next();
      if (!sample || !check_written(context_.journal, context_.options, context_.sink)) {
        return context_.sink.already_reported();
      }
      if (!*sample) return finished(trial_.ran_out() ? TraceEnd::kRanOut : TraceEnd::kStopped);
      if (const auto end = consume(**std::move(sample))) return finished(*end);
    }
  }

 private:
  const CampaignTrace& trace() const { return *trial_.plan().trace; }

  /// Finds out what error the trace may spend in a claim that leaves other traces out. False when
  /// stopped on the way.
  bool share_error() {
    if (is_shared_) return true;
    const auto share = context_.family.share();
    // A feed that cannot tell leaves the trace by itself, and so it is claimed.
    if (!share && context_.bench.stopped()) return false;
    is_shared_ = true;
    is_alone_ = !share;
    share_ = share.value_or(1.0);
    return true;
  }

  /// The last sample to submit. Workers run ahead of the consumed samples, but not beyond what the
  /// criterion still asks for.
  std::int64_t last_wanted() const {
    const std::int64_t jobs = context_.options.jobs;
    const std::int64_t window = jobs == 1 ? 1 : 2 * jobs;
    const auto next = trial_.next_sample();
    const auto needed = std::max(decision_.runs_needed.value_or(limit_.max_runs), next);
    return std::min({next + window - 1, needed, limit_.max_runs});
  }

  /// Searches for a discrepancy. Returns the end that it causes, if any. None of its simulations is
  /// counted.
  base::Result<std::optional<TraceEnd>> search() {
    auto searched = search_trace(trial_, context_.scenario.search, context_.scenario,
                                 context_.bench.fluents(), context_.sink);
    if (!searched || !check_written(context_.journal, context_.options, context_.sink)) {
      return context_.sink.already_reported();
    }
    outcome_.result.search = searched->result;
    for (auto& sample : searched->samples) {
      if (sample.verdict == SampleVerdict::kDiscrepancy) {
        context_.recorder.judge(sample.record, RunRecorder::Verdict::kFinding);
        return std::optional(accept_discrepancy(std::move(sample)));
      }
      context_.recorder.judge(sample.record, RunRecorder::Verdict::kNothing);
      tell(sample, nullptr);
      outcome_.consumed.push_back(std::move(sample.record));
    }
    if (searched->end == SearchEnd::kStopped) return std::optional(TraceEnd::kStopped);
    if (searched->end == SearchEnd::kLostTooOften) return std::optional(TraceEnd::kLostTooOften);
    return std::optional<TraceEnd>();
  }

  /// Enough was simulated for the claim: the initial states that nothing was seen of are simulated
  /// once each, where the limit of runs has room for it. These runs count for no claim.
  base::Result<TraceEnd> visit_others() {
    const auto& starts = outcome_.result.starts;
    const auto listed = trial_.starts().is_single() ? 0 : trial_.starts().count().value_or(0);
    VisitRounds rounds(starts, listed);
    for (;;) {
      const auto left = rounds.next(limit_.most - tally_.runs() - starts.visits);
      if (left.empty()) return TraceEnd::kDecided;
      for (const auto state : left) {
        auto sample = trial_.visit(state);
        if (!sample || !check_written(context_.journal, context_.options, context_.sink)) {
          return context_.sink.already_reported();
        }
        if (!*sample) return TraceEnd::kStopped;
        if (const auto end = consume_visit(**std::move(sample))) return *end;
      }
    }
  }

  /// Takes in a run that counts for no claim. Returns the end that it causes, if any.
  std::optional<TraceEnd> consume_visit(TrialSample sample) {
    auto& starts = outcome_.result.starts;
    ++starts.visits;
    count_start(trial_.starts(), sample, starts);
    const bool found = sample.verdict == SampleVerdict::kDiscrepancy;
    context_.recorder.judge(
        sample.record, found ? RunRecorder::Verdict::kFinding : RunRecorder::Verdict::kNothing);
    if (found) return accept_discrepancy(std::move(sample));
    tell(sample, nullptr);
    outcome_.consumed.push_back(std::move(sample.record));
    if (sample.verdict == SampleVerdict::kLostTooOften) return TraceEnd::kLostTooOften;
    return std::nullopt;
  }

  /// A run whose final state was that of its trace.
  void add_clean(const SampleRecord& record) {
    // The paper's regression is about one initial state.
    if (trial_.starts().is_single()) {
      add_clean_run(tally_, record.initial, record.observations.back());
    } else {
      tally_.add_clean_of_many();
    }
  }

  /// Takes in one sample. Returns the end that it causes, if any.
  std::optional<TraceEnd> consume(TrialSample sample) {
    auto& result = outcome_.result;
    tally_.add_rejected(sample.record.rejected);
    const auto& plan = trial_.plan_of(sample.record);
    law_.add(plan.sampler, plan.campaign_seed, plan.trace_key, sample.record);
    result.rejected += sample.record.rejected;
    const bool is_lost =
        sample.verdict == SampleVerdict::kLost || sample.verdict == SampleVerdict::kLostTooOften;
    if (!is_lost && sample.record.retries > 0) ++result.retried;
    if (!is_lost) echo_.add(sample.record);
    count_start(trial_.starts(), sample, result.starts);
    using Kept = RunRecorder::Verdict;
    context_.recorder.judge(sample.record, is_lost ? Kept::kNothing
                                           : sample.verdict == SampleVerdict::kDiscrepancy
                                               ? Kept::kFinding
                                               : Kept::kClean);
    switch (sample.verdict) {
      case SampleVerdict::kLost:
      case SampleVerdict::kLostTooOften:
        tally_.add_lost();
        count_loss(sample.record, result);
        trial_.draw_independently();
        break;
      case SampleVerdict::kDiscrepancy:
        return accept_discrepancy(std::move(sample));
      case SampleVerdict::kAsPredicted:
        if (sample.judgement.first_divergence) ++result.strayed;
        add_clean(sample.record);
        note_failures(sample.record);
        ++result.clean;
        break;
      case SampleVerdict::kAdmitted:
        tally_.add_clean_elsewhere();
        note_failures(sample.record);
        ++result.admitted;
        ++result.clean;
        break;
    }
    tell(sample, nullptr);
    if (!is_lost && !outcome_.first_clean)
      outcome_.first_clean = trial_.clean_sample(sample.record);
    outcome_.consumed.push_back(std::move(sample.record));
    if (sample.verdict == SampleVerdict::kLostTooOften) return TraceEnd::kLostTooOften;
    return std::nullopt;
  }

  void tell(const TrialSample& sample, const Cause* cause) const {
    if (!context_.options.on_sample) return;
    context_.options.on_sample(judged_row(sample, context_.scenario.comparison(), cause));
  }

  /// Actions that failed in a clean run though the model does not let them.
  void note_failures(const SampleRecord& record) {
    for (std::size_t i = 0; i < record.outcomes.size(); ++i) {
      const auto& point = trial_.plan_of(record).trace->points[i];
      const bool may_fail = point.plan_step && !point.succeeded;
      if (may_fail || record.outcomes[i].status == SimStatus::kOk) continue;
      auto& noted = failures_[i];
      if (noted.runs++ == 0) noted.reason = record.outcomes[i].reason;
    }
  }

  /// Repeats the simulation once: a discrepancy that cannot be repeated says so in the report.
  TraceEnd accept_discrepancy(TrialSample sample) {
    const auto again = trial_.repeat(sample.record);
    if (!again) return TraceEnd::kStopped;
    if (!sample.record.searched && !sample.record.visit) tally_.add_mismatch();
    const auto& judgement = sample.judgement;
    auto& record = sample.record;
    Discrepancy found;
    found.trace = record.trace;
    found.sample = record.sample;
    found.seed = record.seed;
    found.first_divergence = *judgement.first_divergence;
    found.first = judgement.first;
    found.fluents = judgement.last;
    if (judgement.last.empty()) found.kind = DiscrepancyKind::kTransient;
    found.cause = cause_of(*trial_.plan_of(record).trace, judgement, context_.scenario.comparison(),
                           record.outcomes);
    found.confirmation = confirmation_of(record, *again);
    tell(sample, &found.cause);
    found.record = record;
    found.end = mapped_part(*context_.scenario.mapping, context_.bench.fluents().ground(),
                            record.observations.back());
    outcome_.discrepancy = std::move(found);
    outcome_.consumed.push_back(std::move(record));
    outcome_.consumed.push_back(*again);
    return TraceEnd::kDiscrepancy;
  }

  void report_progress() const {
    if (!context_.options.progress) return;
    const std::chrono::duration<double> elapsed = Clock::now() - started_;
    const auto made = context_.bench.runs_made() - runs_before_;
    CampaignProgress progress;
    progress.trace = trace().number;
    progress.done = tally_.runs();
    progress.needed = std::min(decision_.runs_needed.value_or(limit_.max_runs), limit_.max_runs);
    progress.runs_per_s = elapsed.count() > 0.0 ? static_cast<double>(made) / elapsed.count() : 0.0;
    context_.options.progress(progress);
  }

  TraceOutcome finished(TraceEnd end) {
    trial_.end();
    // A discrepancy that ends the run makes no claim, so other traces need not share the error.
    const bool is_last = end == TraceEnd::kDiscrepancy && !context_.options.keep_going;
    if (!(is_last && trace().number == 1) && end != TraceEnd::kStopped) (void)share_error();
    if (!is_shared_ && end == TraceEnd::kStopped) is_alone_ = true;
    auto& result = outcome_.result;
    outcome_.end = end;
    result.is_decided = end == TraceEnd::kDecided;
    trial_.starts().describe(result.starts,
                             trial_.next_sample() - (end == TraceEnd::kRanOut ? 0 : 1));
    const auto other_starts = echo_.faults();
    result.began_elsewhere = !other_starts.empty();
    const bool is_covered = result.starts.is_covered() && other_starts.empty();
    result.verdict = end == TraceEnd::kDecided && is_covered ? CampaignVerdict::kNoDiscrepancy
                     : end == TraceEnd::kDiscrepancy         ? CampaignVerdict::kDiscrepancy
                                                             : CampaignVerdict::kInconclusive;
    result.simulations = tally_.runs();
    result.simulated_s = simulated_s(outcome_.consumed);
    result.wall_s = std::chrono::duration<double>(Clock::now() - started_).count();
    const auto bound = certified_bound(tally_, spec_.confidence_level, spec_.share);
    result.certified_level = bound.confidence_level;
    result.certified_epsilon = bound.epsilon;
    result.stated = stated_bound(tally_, spec_);
    auto shared = spec_;
    shared.share = share_;
    result.shared = stated_bound(tally_, shared);
    if (trial_.starts().is_single()) {
      result.paper_stopped_at = paper_stopped_at(tally_, spec_.paper, spec_.confidence_level);
      result.paper_variant = paper_variant(tally_, spec_.paper);
      if (spec_.kind == CriterionKind::kPaper) {
        result.paper_figures = paper_figures(tally_, spec_.paper, spec_.confidence_level);
      }
    }
    result.not_covered = tally_.frame().not_covered;
    result.law = law_.result();
    if (result.search && result.search->found) {
      result.claim =
          "a search found a discrepancy; nothing is claimed about how often there is one";
    } else if (outcome_.discrepancy && outcome_.discrepancy->record.visit) {
      result.claim = kFoundByVisit;
    } else {
      result.claim =
          claim(tally_, spec_, context_.scenario.comparison(), drawn_starts(result, law_.drawn()));
      result.caveats = caveats(tally_, spec_, result.paper_stopped_at);
    }
    if (result.search) add_search_caveats(*result.search, result);
    if (result.search && !result.starts.all) {
      result.caveats.push_back("the search looked at the first initial state only");
    }
    result.caveats.insert(result.caveats.end(), other_starts.begin(), other_starts.end());
    add_own_caveats(result);
    return std::move(outcome_);
  }

  /// "at any step" is not said of all of them.
  void add_rest_caveat(TraceResult& result) const {
    std::vector<std::string> names;
    for (const auto& fluents :
         compared_fluents(*context_.scenario.mapping, context_.bench.fluents().ground(),
                          Comparison::kEveryStep)) {
      if (fluents.how == ComparedFluents::How::kAtTheEnd) names.push_back(fluents.fluent);
    }
    if (names.empty()) return;
    result.caveats.push_back(fmt::format("compared at the start and in the last state only: {}",
                                         fmt::join(names, ", ")));
  }

  static void add_search_caveats(const SearchResult& search, TraceResult& result) {
    if (search.runs - search.lost > 1 && !search.nearest) {
      result.caveats.push_back(
          "no margin of these simulations changed, so the search had no direction and spread its "
          "starts evenly");
    }
    if (!search.contradicting.empty()) {
      result.caveats.push_back(
          fmt::format("margins below zero though all went as predicted, which the search left out: "
                      "{}",
                      fmt::join(search.contradicting, ", ")));
    }
  }

  void add_own_caveats(TraceResult& result) const {
    if (trace().other_outcomes == base::Known::kYes && context_.scenario.match_model) {
      result.caveats.push_back(context_.scenario.comparison() == Comparison::kFinal
                                   ? "the model leaves the outcome of these events open; an end "
                                     "state counts as predicted "
                                     "if the model admits it"
                                   : "the model leaves the outcome of these events open; states "
                                     "count as predicted if the "
                                     "model admits them");
    }
    if (context_.scenario.comparison() == Comparison::kEveryStep) add_rest_caveat(result);
    if (!outcome_.discrepancy) {
      add_start_caveats(result.starts, tally_.runs(), limit_.most, result.caveats);
    }
    if (is_alone_) {
      result.caveats.push_back(
          "the claim is about this trace by itself: how many there are was not known when it "
          "ended");
    }
    const auto kind = criterion_->kind();
    const bool looks_once = kind == CriterionKind::kClopperPearson;
    if (!criterion_->is_anytime_valid() && !looks_once) {
      result.caveats.push_back(fmt::format(
          "the criterion `{}` looks again after every run and is not made for it: its level is not "
          "the probability of a false stop",
          to_string(kind)));
    }
    add_loss_caveats(result);
    for (const auto& [event, noted] : failures_) {
      result.caveats.push_back(
          fmt::format("event {}, {}, failed in {} of {} clean runs, and the states were as "
                      "predicted all the same ({})",
                      event, trace().event(event), noted.runs, result.clean,
                      noted.reason.empty() ? "no reason given" : noted.reason));
    }
    const auto& found = outcome_.discrepancy;
    add_simulator_caveats(context_.bench.simulator(), found ? &*found : nullptr, result);
  }

  struct Failures {
    std::int64_t runs = 0;
    std::string reason;  // of the first
  };

  const TraceContext& context_;
  Trial trial_;
  std::map<std::size_t, Failures> failures_;  // in clean runs, by event
  Tally tally_;
  LawCounter law_;
  StartEcho echo_;
  CriterionSpec spec_;
  std::unique_ptr<ConfidenceCriterion> criterion_;
  RunLimit limit_;
  double share_ = 1.0;      // of the error, in a claim that leaves other traces out
  bool is_shared_ = false;  // the share is known
  bool is_alone_ = false;   // it is not, and the trace is claimed by itself
  Decision decision_;
  TraceOutcome outcome_;
  Clock::time_point started_ = Clock::now();
  std::int64_t runs_before_ = context_.bench.runs_made();
};

}  // namespace

base::Result<TraceOutcome> run_trace(const TraceContext& context, Trial trial) {
  return TraceCampaign(context, std::move(trial)).run();
}

}  // namespace parallax::harness
