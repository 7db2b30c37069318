#include "harness/campaign/campaign.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <string>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/contract.h"
#include "compiler/base/hash.h"
#include "compiler/base/words.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/repetition.h"
#include "harness/campaign/run_setup.h"
#include "harness/campaign/start_words.h"
#include "harness/campaign/trace_campaign.h"
#include "harness/campaign/trace_family.h"
#include "harness/confidence/family.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {
namespace {

using Clock = std::chrono::steady_clock;

class Campaign {
 public:
  Campaign(const Scenario& scenario, RunFolder folder, JournalText recorded, TraceFeed& traces,
           const SimulatorFactory& make_simulator, const CampaignOptions& options,
           base::SourceFiles& files, base::DiagnosticSink& sink)
      : scenario_(scenario),
        folder_(std::move(folder)),
        recorded_(std::move(recorded)),
        traces_(traces),
        family_(traces, scenario.criterion.family, scenario.limits.max_traces, sink),
        options_(options),
        files_(files),
        sink_(sink),
        recorder_(options.record, options.run_dir),
        bench_(
            scenario, traces, make_simulator,
            {options.seed, options.jobs, options.stop, recorder_.taker()},
            [this](const SampleRecord& record) { keep(record); }, sink) {
    describe_run(scenario, options, bench_.fluents().ground(), result_);
    result_.exploration = "stopped";
  }

  base::Result<CampaignResult> run() {
    const auto started = bench_.start();
    if (!started) return sink_.already_reported();
    if (!*started) return finished(false);
    result_.simulator = bench_.simulator();
    recorder_.set_simulator(result_.simulator);
    auto journal =
        Journal::open(std::move(folder_), journal_header(scenario_, options_, result_.simulator),
                      std::move(recorded_), scenario_.limits.max_lost_in_a_row, files_, sink_);
    if (!journal) return sink_.already_reported();
    journal_ = std::move(*journal);
    result_.journal_open = true;
    const auto complete = explore();
    if (complete && *complete && !lost_too_often_) repeat_first_clean();
    // Traces that are finished are not lost to an error in a later one.
    result_.failed = !complete;
    if (result_.failed && result_.traces.empty()) return sink_.already_reported();
    return finished(complete && *complete);
  }

 private:
  /// Called in a worker's thread; by then the journal is open, as samples need a trace.
  void keep(const SampleRecord& record) {
    if (is_repeating_) return;  // no sample, and on no journal
    const bool is_result =
        record.status == SampleStatus::kOk || record.status == SampleStatus::kLost;
    if (is_result) journal_->append(record);
  }

  /// Trace after trace. False when something other than the lack of traces ended it early.
  base::Result<bool> explore() {
    const auto max_traces = scenario_.limits.max_traces;
    for (;;) {
      if (bench_.stopped()) return false;
      auto trace = family_.next();
      if (!trace) return sink_.already_reported();
      if (!*trace) {
        return family_.exploration() != "stopped";
      }
      if (max_traces > 0 && static_cast<std::int64_t>(result_.traces.size()) >= max_traces) {
        limited_ = true;
        return true;
      }
      auto end = one_trace(std::move(**trace));
      if (!end) return sink_.already_reported();
      if (*end == TraceEnd::kStopped) return false;
      if (*end == TraceEnd::kLostTooOften) {
        lost_too_often_ = true;
        // Left in the journal they would end every continuation where this run ended. Where losses
        // must not be repeated they stay, and a continuation goes on behind them.
        if (may_repeat_losses(result_.simulator)) {
          while (!consumed_.empty() && consumed_.back().status == SampleStatus::kLost) {
            consumed_.pop_back();
          }
        }
        return true;
      }
      if (*end == TraceEnd::kDiscrepancy && !options_.keep_going) return true;
    }
  }

  base::Result<TraceEnd> one_trace(CampaignTrace trace) {
    auto trial = Trial::prepare(bench_, std::move(trace));
    if (!trial) return sink_.already_reported();
    // Stopped while initial states were listed: the trace is not known as it is to be written down.
    if (bench_.stopped()) return TraceEnd::kStopped;
    if (!announce(*trial)) return sink_.already_reported();
    trial->continue_from(*journal_);
    trial->announce_by([this](const TracePlan& plan) { return announce_start(plan); });
    const TraceContext context{scenario_, options_,  family_, bench_,
                               *journal_, recorder_, files_,  sink_};
    auto outcome = run_trace(context, *std::move(trial));
    if (!outcome) return sink_.already_reported();
    result_.simulations += outcome->result.simulations;
    result_.simulated_s += outcome->result.simulated_s;
    if (outcome->result.search) result_.simulations += outcome->result.search->runs;
    if (!clean_ && !outcome->discrepancy) clean_ = std::move(outcome->first_clean);
    result_.traces.push_back(std::move(outcome->result));
    if (outcome->discrepancy) result_.discrepancies.push_back(std::move(*outcome->discrepancy));
    std::move(outcome->consumed.begin(), outcome->consumed.end(), std::back_inserter(consumed_));
    return outcome->end;
  }

  /// Writes the trace down before its first sample, or finds it as it was written down.
  base::Status announce(const Trial& trial) {
    const auto& plan = trial.plan();
    TraceLine line{plan.trace, plan.calls, 0, trial.starts().law_text()};
    if (const auto* recorded = journal_->find(plan.trace->number)) {
      // The plan may be named from elsewhere, as the scenario may.
      if (!same_but_for_places(*recorded, line)) {
        const auto number = plan.trace->number;
        if (recorded->trace->key == plan.trace->key) {
          const bool other_law = recorded->initial_states != line.initial_states;
          return sink_.error(
              codes::kForeignJournalLine, journal_->recorded().trace_places.at(number),
              other_law ? fmt::format("its initial states are drawn otherwise: {}, now {}",
                                      law_or_first(recorded->initial_states),
                                      law_or_first(line.initial_states))
                        : "it has the events of the trace, but not its states and calls");
        }
        return sink_.error(codes::kJournalMismatch, journal_->recorded().trace_places.at(number),
                           fmt::format("trace {}", number), recorded->trace->key, plan.trace->key);
      }
      if (!check_recorded(plan)) return sink_.already_reported();
    } else {
      journal_->append(line);
    }
    std::vector<std::string> events;
    for (std::size_t t = 0; t < plan.trace->event_count(); ++t) {
      events.push_back(plan.trace->event(t));
    }
    recorder_.announce(plan.trace->number, std::move(events));
    lines_.push_back(std::move(line));
    return base::Unit{};
  }

  static std::string law_or_first(const std::string& law) {
    return law.empty() ? "only the first" : law;
  }

  /// The same of the trace from another initial state.
  base::Status announce_start(const TracePlan& plan) {
    TraceLine line{plan.trace, plan.calls, plan.start_state, {}};
    const auto number = plan.trace->number;
    if (const auto* recorded = journal_->find(number, plan.start_state)) {
      if (!same_but_for_places(*recorded, line)) {
        return sink_.error(codes::kForeignJournalLine,
                           journal_->recorded().start_places.at({number, plan.start_state}),
                           "it is not how the trace goes from this initial state");
      }
      if (!check_recorded(plan)) return sink_.already_reported();
    } else {
      journal_->append(line);
    }
    lines_.push_back(std::move(line));
    return base::Unit{};
  }

  /// Holds the simulations on record that begin in the plan's initial state against their draws.
  base::Status check_recorded(const TracePlan& plan) {
    const auto& recorded = journal_->recorded();
    const SampleKey first(plan.trace->number, 0, DrawPhase::kCertify);
    for (auto at = recorded.samples.lower_bound(first); at != recorded.samples.end(); ++at) {
      const auto& record = at->second;
      if (record.trace != plan.trace->number) break;
      if (record.start_state != plan.start_state) continue;
      const bool of_search = record.sample <= scenario_.search.runs;
      if (record.phase == DrawPhase::kConfirm && of_search) continue;  // of the one before it
      auto why = wrong_draw(record, plan.sampler, plan.campaign_seed, plan.trace_key);
      if (record.searched != of_search) why = "it has the number of a simulation of another phase";
      if (why.empty()) continue;
      return sink_.error(codes::kForeignJournalLine, recorded.places.at(at->first), why);
    }
    return base::Unit{};
  }

  /// Does the simulator do what it did at first? Only where something is claimed of clean runs.
  void repeat_first_clean() {
    if (!clean_) return;
    is_repeating_ = true;
    sampled_ = {0.0, bench_.simulated_s(), bench_.runs_made()};
    result_.repetition = repeat_clean(*clean_, bench_);
    apply_repetition(result_);
  }

  base::Result<CampaignResult> finished(bool complete) {
    bench_.close();
    if (complete) recorder_.finish(consumed_);
    recorder_.report(sink_);
    result_.kinds = count_kinds(consumed_);
    if (complete) keep_used_lines();
    if (complete && !journal_->rewrite(lines_, std::move(consumed_), sink_)) {
      return sink_.already_reported();
    }
    const auto is = [&](CampaignVerdict verdict) {
      return [verdict](const TraceResult& trace) { return trace.verdict == verdict; };
    };
    note_exploration();
    claim_family();
    const auto& traces = result_.traces;
    result_.interrupted = !complete;
    if (std::any_of(traces.begin(), traces.end(), is(CampaignVerdict::kDiscrepancy))) {
      result_.verdict = CampaignVerdict::kDiscrepancy;
    } else if (complete && !limited_ && !traces.empty() &&
               std::all_of(traces.begin(), traces.end(), is(CampaignVerdict::kNoDiscrepancy))) {
      result_.verdict = CampaignVerdict::kNoDiscrepancy;
    }
    note_timing(bench_, started_, result_);
    if (is_repeating_) {
      result_.timing.runs_made = sampled_.runs_made;
      result_.timing.simulated_s = sampled_.simulated_s;
    }
    return std::move(result_);
  }

  /// Puts the lines of traces in order, without those of initial states that only simulations
  /// began in that ran ahead.
  void keep_used_lines() {
    std::set<StartKey> used;
    for (const auto& record : consumed_) used.emplace(record.trace, record.start_state);
    std::erase_if(lines_, [&](const TraceLine& line) {
      return line.start_state > 0 && !used.contains({line.trace->number, line.start_state});
    });
    std::stable_sort(lines_.begin(), lines_.end(), [](const TraceLine& a, const TraceLine& b) {
      return std::pair(a.trace->number, a.start_state) < std::pair(b.trace->number, b.start_state);
    });
  }

  /// Keeps the result of the search for traces, whatever ended the simulations.
  void note_exploration() {
    if (result_.failed || family_.exploration() == "stopped" || !family_.all_given()) return;
    result_.exploration = family_.exploration();
    result_.bounds = traces_.bounds();
  }

  /// Describes the traces of the model that were not simulated.
  std::string other_traces_text(std::int64_t simulated) const {
    const auto all = result_.spending->traces().value_or(simulated);
    const std::string_view found = family_.exploration();
    std::string text;
    if (simulated < all) {
      text = fmt::format("{} of {} traces {} not simulated; ", all - simulated, all,
                         base::agreed(all - simulated, "was", "were"));
    }
    if (found == "all traces explored") return text + "the solver finds no other trace";
    if (found == "complete up to bound") {
      const auto left_out = traces_.reservation();
      return text + fmt::format("the solver finds no other trace up to the horizon of {}{}",
                                scenario_.horizon,
                                left_out.empty() ? "" : fmt::format(" ({})", left_out));
    }
    return text + "the model may have other traces";
  }

  /// States the claim about all traces together.
  void claim_family() {
    result_.spending = family_.rule();
    if (!result_.spending) return;
    std::vector<FamilyMember> members;
    for (const auto& trace : result_.traces) {
      members.push_back(
          {trace.clean, trace.lost, trace.simulations,
           trace.verdict == CampaignVerdict::kDiscrepancy, trace.rejected > 0, trace.stated,
           trace.shared,
           drawn_starts(trace, {trace.law ? trace.law->text() : std::string(), trace.left_out})});
    }
    FamilyScope scope;
    scope.split_initial = options_.split_initial;
    scope.completeness = other_traces_text(std::ssize(members));
    if (!result_.repetition.holds()) return;
    result_.claim = family_claim(members, scenario_.criterion, scenario_.comparison(), scope);
  }

  const Scenario& scenario_;
  RunFolder folder_;      // until the journal takes it over
  JournalText recorded_;  // likewise
  TraceFeed& traces_;
  TraceFamily family_;
  const CampaignOptions& options_;
  base::SourceFiles& files_;
  base::DiagnosticSink& sink_;
  Clock::time_point started_ = Clock::now();
  std::unique_ptr<Journal> journal_;
  CampaignResult result_;
  std::vector<TraceLine> lines_;
  std::vector<SampleRecord> consumed_;
  std::optional<CleanSample> clean_;  // the first of a trace without discrepancy
  bool is_repeating_ = false;         // set before workers repeat it
  CampaignResult::Timing sampled_;    // what samples took, before it was repeated
  bool lost_too_often_ = false;
  bool limited_ = false;  // by max_traces
  RunRecorder recorder_;
  TrialBench bench_;  // last, so that its threads end before what they use
};

}  // namespace

base::Result<CampaignResult> run_campaign(const Scenario& scenario, TraceFeed& traces,
                                          const SimulatorFactory& make_simulator,
                                          const CampaignOptions& options, base::SourceFiles& files,
                                          base::DiagnosticSink& sink) {
  PARALLAX_REQUIRE(scenario.mapping.has_value(), "a scenario that was loaded without errors");
  auto claimed = claim_run(scenario, options, files, sink);
  if (!claimed) return sink.already_reported();
  return Campaign(scenario, std::move(claimed->folder), std::move(claimed->recorded), traces,
                  make_simulator, options, files, sink)
      .run();
}

std::string hash_of_sources(const base::SourceFiles& files, std::size_t first) {
  std::uint64_t low = base::kFnvStart, high = base::fnv1a64("high");
  for (std::size_t i = first; i < files.size(); ++i) {
    const auto text = files[base::FileId(static_cast<std::uint32_t>(i))].text();
    // The size separates the texts: moving a line from one file to the next must show.
    const auto size = std::to_string(text.size());
    low = base::fnv1a64(text, base::fnv1a64(size, low));
    high = mix64(base::fnv1a64(text, high ^ low));
  }
  return fmt::format("{:016x}{:016x}", high, low);
}

}  // namespace parallax::harness
