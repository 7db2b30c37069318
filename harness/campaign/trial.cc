#include "harness/campaign/trial.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/contract.h"
#include "compiler/base/hash.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/start_check.h"
#include "harness/simulator/protocol_check.h"
#include "harness/simulator/units.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

TrialBench::TrialBench(const Scenario& scenario, TraceFeed& feed,
                       const SimulatorFactory& make_simulator, const TrialOptions& options,
                       std::function<void(const SampleRecord&)> finished,
                       base::DiagnosticSink& sink)
    : SimulatorBench(scenario, *feed.symbols(), make_simulator, options, std::move(finished), sink),
      feed_(feed) {}

SimulatorBench::SimulatorBench(const Scenario& scenario, const compiler::SymbolTable& symbols,
                               const SimulatorFactory& make_simulator, const TrialOptions& options,
                               std::function<void(const SampleRecord&)> finished,
                               base::DiagnosticSink& sink)
    : scenario_(scenario),
      options_(options),
      sink_(sink),
      fluents_(symbols),
      make_simulator_(make_simulator),
      pool_(options.jobs, make_simulator, std::move(finished), options.stop, options.moved) {
  PARALLAX_REQUIRE(scenario.mapping.has_value(), "a scenario that was loaded without errors");
}

std::optional<SampleRecord> SimulatorBench::repeat(const std::shared_ptr<const SampleMaker>& maker,
                                                   const SampleRecord& record) {
  pool_.abandon();
  pool_.submit_repeat(maker, record);
  return pool_.wait(record.sample, DrawPhase::kConfirm);
}

std::optional<SampleRecord> SimulatorBench::repeat_fresh(
    const std::shared_ptr<const SampleMaker>& maker, const SampleRecord& record) {
  pool_.close();
  WorkerPool fresh(
      1, make_simulator_, [](const SampleRecord&) {}, options_.stop);
  fresh.submit_repeat(maker, record);
  auto again = fresh.wait(record.sample, DrawPhase::kConfirm);
  fresh.close();
  fresh_runs_ += fresh.runs_made();
  fresh_simulated_s_ += fresh.simulated_s();
  return again;
}

bool SimulatorBench::lost_too_often(const SampleRecord& record, bool on_record) {
  if (++lost_in_a_row_ < scenario_.limits.max_lost_in_a_row) return false;
  if (on_record) {
    lost_in_a_row_ = 0;  // such a row on record has ended a run, which somebody continues
    return false;
  }
  sink_.error(codes::kSimulatorLost, scenario_.simulator.source, lost_in_a_row_, record.reason);
  return true;
}

namespace {

/// Tells what a simulator of another program says of itself that is odd.
void warn_of_simulator(const Scenario& scenario, const SimulatorInfo& info,
                       base::DiagnosticSink& sink) {
  if (scenario.simulator.is_built_in()) return;
  auto odd = info_oddities(info);
  for (auto& finding : unit_findings(info, {})) odd.push_back(std::move(finding.text));
  for (const auto& text : odd) sink.warning(codes::kOddSimulator, scenario.simulator.source, text);
}

}  // namespace

base::Result<bool> SimulatorBench::start() {
  auto info = pool_.info();
  if (!info) return false;
  if (info->name.empty()) {
    return sink_.error(codes::kSimulatorNotStarted, scenario_.simulator.source, info->version);
  }
  simulator_ = *std::move(info);
  warn_of_simulator(scenario_, simulator_, sink_);
  if (!check_against_simulator(scenario_, fluents_.ground(), simulator_, sink_))
    return sink_.already_reported();
  return true;
}

SampleRow judged_row(const TrialSample& sample, Comparison comparison, const Cause* cause) {
  const char* outcome = "lost";
  if (sample.verdict == SampleVerdict::kAsPredicted) outcome = "clean";
  if (sample.verdict == SampleVerdict::kAdmitted) outcome = "admitted";
  if (sample.verdict == SampleVerdict::kDiscrepancy) outcome = "discrepancy";
  auto row = sample_row(sample.record, outcome);
  if (cause == nullptr) return row;
  row.event = event_of(sample.judgement, comparison);
  row.cause = cause->text;
  row.reason = cause->reason;
  return row;
}

base::Result<Trial> Trial::prepare(TrialBench& bench, CampaignTrace trace) {
  PARALLAX_REQUIRE(trace.points.size() == trace.event_count() + 1,
                   "a trace has one state more than it has events");
  auto starts = StartStates::make({bench.scenario_, bench.fluents_, bench.simulator_, bench.feed_,
                                   bench.sink_, bench.options_.seed},
                                  std::move(trace));
  if (!starts) return bench.sink_.already_reported();
  return Trial(bench, *std::move(starts));
}

/// The start in a state, which is announced. None: stopped.
base::Result<std::optional<PreparedStart>> Trial::begin_in(std::int64_t state) {
  auto start = starts_.prepared(state);
  if (!start) return bench_->sink_.already_reported();
  if (!*start || state <= 1 || announced_.contains(state)) return start;
  if (announce_ && !announce_(*(*start)->plan)) return bench_->sink_.already_reported();
  announced_.insert(state);
  return start;
}

/// The start of a drawn sample. None: as StartStates::state_of.
base::Result<std::optional<PreparedStart>> Trial::begin_of(std::int64_t sample) {
  const auto state = starts_.state_of(sample, independent_);
  if (!state) return bench_->sink_.already_reported();
  if (!*state) return std::optional<PreparedStart>();
  return begin_in(**state);
}

/// Gives the workers the sample after the last one that they have. False when stopped, or where
/// drawing of initial states ended.
base::Result<bool> Trial::submit_one() {
  auto start = begin_of(submitted_ + 1);
  if (!start) return bench_->sink_.already_reported();
  if (!*start) return false;
  const auto* known = recorded(++submitted_, DrawPhase::kCertify);
  // One that ran ahead of a loss, after which states are drawn otherwise, is made anew.
  if (known != nullptr && known->start_state == (*start)->state) return true;
  bench_->pool_.submit((*start)->samples, submitted_);
  return true;
}

void Trial::submit_to(std::int64_t last) {
  while (submitted_ < last && submitted_ + 1 != blocked_) {
    // An earlier sample may end the trial, so it is too early to report what is wrong here.
    const auto before = bench_->sink_;
    const auto done = submit_one();
    if (done && *done) continue;
    bench_->sink_ = before;
    blocked_ = submitted_ + 1;
  }
}

void Trial::draw_independently() {
  if (independent_ || starts_.is_single()) return;
  bench_->pool_.abandon();
  submitted_ = next_ - 1;
  blocked_ = 0;
  independent_ = true;
}

const SampleRecord* Trial::recorded(std::int64_t sample, DrawPhase phase) const {
  return journal_ == nullptr ? nullptr : journal_->find(plan().trace->number, sample, phase);
}

std::optional<SampleRecord> Trial::result_of(std::int64_t sample, DrawPhase phase,
                                             std::int64_t state) {
  const auto* known = recorded(sample, phase);
  if (known != nullptr && known->start_state == state) {
    if (bench_->stopped()) return std::nullopt;
    return *known;
  }
  return bench_->pool_.wait(sample, phase);
}

base::Result<std::optional<TrialSample>> Trial::next() {
  if (submitted_ < next_) {
    const auto submitted = submit_one();
    if (!submitted) return bench_->sink_.already_reported();
    if (!*submitted) return std::optional<TrialSample>();
  }
  const auto state = starts_.state_of(next_, independent_);
  if (!state) return bench_->sink_.already_reported();
  if (!*state) return std::optional<TrialSample>();
  auto record = result_of(next_, DrawPhase::kCertify, **state);
  if (!record) return std::optional<TrialSample>();
  ++next_;
  return judged(*std::move(record));
}

base::Result<std::optional<TrialSample>> Trial::visit(std::int64_t state) {
  bench_->pool_.abandon();
  auto start = begin_in(state);
  if (!start) return bench_->sink_.already_reported();
  if (!*start) return std::optional<TrialSample>();
  const auto* known = recorded(next_, DrawPhase::kCertify);
  if (known == nullptr || known->start_state != state || !known->visit) {
    bench_->pool_.submit(std::make_shared<const TraceSamples>((*start)->plan, true), next_);
  }
  auto record = result_of(next_, DrawPhase::kCertify, state);
  if (!record) return std::optional<TrialSample>();
  submitted_ = next_++;
  return judged(*std::move(record));
}

base::Result<std::optional<TrialSample>> Trial::judged(SampleRecord record) {
  switch (record.status) {
    case SampleStatus::kRejected:
      return report_rejected(bench_->scenario_, *plan_of(record).trace, record.rejected,
                             record.sample, record.reason, bench_->sink_);
    case SampleStatus::kRefused:
      return report_refused(record);
    case SampleStatus::kLost:
      return std::optional(lost(std::move(record)));
    case SampleStatus::kOk:
      break;
  }
  return observed(std::move(record));
}

namespace {

/// Simulates a start that is given.
class ChosenSample final : public SampleMaker {
 public:
  ChosenSample(std::shared_ptr<const TracePlan> plan, State start)
      : plan_(std::move(plan)), start_(std::move(start)) {}

  std::optional<SampleRecord> make(std::int64_t sample, Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override {
    return run_chosen(*plan_, sample, start_, simulator, abandoned);
  }
  std::optional<SampleRecord> repeat(const SampleRecord& record, Simulator& simulator,
                                     const std::function<bool()>& abandoned) const override {
    return repeat_sample(plan_->calls, plan_->repeats_losses, record, simulator, abandoned);
  }

 private:
  std::shared_ptr<const TracePlan> plan_;
  State start_;
};

}  // namespace

base::Result<std::optional<std::vector<TrialSample>>> Trial::try_starts(
    std::int64_t first, std::vector<std::optional<ChosenStart>> starts) {
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (!starts[i]) continue;
    const auto start = begin_in(starts[i]->state);
    if (!start) return bench_->sink_.already_reported();
    if (!*start) return std::optional<std::vector<TrialSample>>();
    const auto number = first + static_cast<std::int64_t>(i);
    const auto* known = recorded(number, DrawPhase::kCertify);
    if (known == nullptr) {
      bench_->pool_.submit(
          std::make_shared<const ChosenSample>((*start)->plan, std::move(starts[i]->point)),
          number);
    } else if (!known->searched || known->initial != starts[i]->point ||
               known->start_state != starts[i]->state) {
      return bench_->sink_.error(
          codes::kForeignJournalLine,
          journal_->recorded().places.at({known->trace, number, DrawPhase::kCertify}),
          "its start is not the one that the search proposes");
    }
  }
  std::vector<TrialSample> out;
  for (std::size_t i = 0; i < starts.size(); ++i) {
    if (!starts[i]) {
      TrialSample none;
      none.record.trace = plan().trace->number;
      none.record.sample = first + static_cast<std::int64_t>(i);
      none.record.searched = true;
      none.record.status = SampleStatus::kRejected;
      none.record.start_state = starts_.is_single() ? 0 : 1;
      none.verdict = SampleVerdict::kLost;
      out.push_back(std::move(none));
      continue;
    }
    auto record =
        result_of(first + static_cast<std::int64_t>(i), DrawPhase::kCertify, starts[i]->state);
    if (!record) return std::optional<std::vector<TrialSample>>();
    if (record->status == SampleStatus::kRefused) return report_refused(*record);
    if (record->status == SampleStatus::kRejected) {
      out.push_back({*std::move(record), SampleVerdict::kLost, {}});
    } else if (record->status == SampleStatus::kLost) {
      out.push_back(lost(*std::move(record)));
      if (out.back().verdict == SampleVerdict::kLostTooOften) {
        bench_->pool_.abandon();
        return std::optional(std::move(out));
      }
    } else {
      auto sample = observed(*std::move(record));
      if (!sample) return bench_->sink_.already_reported();
      if (!*sample) return std::optional<std::vector<TrialSample>>();
      out.push_back(**std::move(sample));
    }
  }
  return std::optional(std::move(out));
}

void Trial::begin_after(std::int64_t sample) {
  PARALLAX_REQUIRE(next_ == 1, "nothing was drawn yet");
  next_ = sample + 1;
  submitted_ = sample;
  starts_.begin_after(sample);
}

TrialSample Trial::lost(SampleRecord record) {
  TrialSample sample{std::move(record), SampleVerdict::kLost, {}};
  const bool on_record = recorded(sample.record.sample, sample.record.phase) != nullptr;
  if (bench_->lost_too_often(sample.record, on_record)) {
    sample.verdict = SampleVerdict::kLostTooOften;
  }
  return sample;
}

namespace {

/// The states that the model is asked to admit, by timepoint. None if a compared state is not a
/// state of any model.
std::optional<std::vector<std::map<compiler::FluentId, bool>>> compared_states(
    const Judgement& judgement, Comparison comparison) {
  std::vector<std::map<compiler::FluentId, bool>> out(judgement.states.size());
  const std::size_t first = comparison == Comparison::kFinal ? out.size() - 1 : 0;
  for (std::size_t t = first; t < out.size(); ++t) {
    if (judgement.states[t].in_no_state) return std::nullopt;
    out[t] = judgement.states[t].holds;
  }
  return out;
}

}  // namespace

base::Known admitted_by_model(const Scenario& scenario, TraceFeed& feed, const CampaignTrace& trace,
                              const Judgement& judgement) {
  const auto observed = compared_states(judgement, scenario.comparison());
  const bool open =
      scenario.match_model && observed.has_value() && trace.other_outcomes == base::Known::kYes;
  return open ? feed.admits(trace, *observed) : base::Known::kNo;
}

base::Result<std::optional<TrialSample>> Trial::observed(SampleRecord record) {
  const auto& scenario = bench_->scenario_;
  TrialSample sample;
  const auto& trace = *plan_of(record).trace;
  sample.judgement = judge(*scenario.mapping, bench_->fluents_, trace, record.observations);
  const auto& judgement = sample.judgement;
  if (!judgement.missing.empty()) {
    return report_missing(record, *judgement.missing.begin());
  }
  if (judgement.first_divergence == 0) {
    return report_other_start(scenario, record, judgement.first.front(), bench_->sink_);
  }
  bench_->lost_in_a_row_ = 0;
  sample.record = std::move(record);
  sample.verdict = SampleVerdict::kAsPredicted;
  const auto comparison = scenario.comparison();
  if (!judgement.matches(comparison)) {
    const auto admitted = admitted_by_model(scenario, bench_->feed_, trace, judgement);
    if (admitted == base::Known::kUndecided || bench_->stopped()) {
      return std::optional<TrialSample>();
    }
    sample.verdict =
        admitted == base::Known::kYes ? SampleVerdict::kAdmitted : SampleVerdict::kDiscrepancy;
  }
  return std::optional(std::move(sample));
}

/// Up to the refusal there is one observation for the reset and one for each action.
base::DiagnosticBuilder Trial::report_refused(const SampleRecord& record) const {
  const auto& scenario = bench_->scenario_;
  const auto in = fmt::format("in simulation {} of trace {}", record.sample, record.trace);
  const auto code = codes::kSimulatorRefused;
  if (record.observations.empty()) {
    return bench_->sink_.error(code, scenario.sampling_source,
                               fmt::format("refused the start {}", in), record.reason);
  }
  const auto event = ground_fluent(plan().trace->event(record.outcomes.size()));
  const auto action =
      std::find_if(scenario.actions.begin(), scenario.actions.end(),
                   [&](const auto& binding) { return binding.event == event.symbol; });
  return bench_->sink_.error(
      code, action != scenario.actions.end() ? action->source : scenario.actions_source,
      fmt::format("refused `{}` {}", event.text, in), record.reason);
}

/// Reports a missing variable. A record of the journal is itself at fault: the current simulator is
/// not consulted.
base::DiagnosticBuilder Trial::report_missing(const SampleRecord& record,
                                              const std::string& variable) const {
  const auto& scenario = bench_->scenario_;
  if (journal_ != nullptr && recorded(record.sample, record.phase) != nullptr) {
    const auto& places = journal_->recorded().places;
    return bench_->sink_.error(codes::kForeignJournalLine,
                               places.at({record.trace, record.sample, record.phase}),
                               fmt::format("its observations lack `{}`", variable));
  }
  const auto& mapping = *scenario.mapping;
  auto place = scenario.mapping_source;
  for (const auto& fluent : bench_->fluents_.ground()) {
    const auto* binding = mapping.find(fluent.symbol);
    if (binding == nullptr) continue;
    const auto read = binding->variables(fluent, mapping.regions());
    if (std::find(read.begin(), read.end(), variable) == read.end()) continue;
    place = binding->source;
    break;
  }
  return bench_->sink_.error(
      codes::kSimulatorRefused, place,
      fmt::format("does not show what is compared in simulation {} of trace {}", record.sample,
                  record.trace),
      fmt::format("its observations lack `{}`", variable));
}

CleanSample Trial::clean_sample(const SampleRecord& record) const {
  const auto& start = starts_.known(record.start_state);
  const auto is_clean = [bench = bench_, plan = start.plan](const SampleRecord& again) {
    const auto& scenario = bench->scenario_;
    const auto judgement =
        judge(*scenario.mapping, bench->fluents_, *plan->trace, again.observations);
    if (!judgement.missing.empty() || judgement.first_divergence == 0) return std::optional(false);
    if (judgement.matches(scenario.comparison())) return std::optional(true);
    const auto admitted = admitted_by_model(scenario, bench->feed_, *plan->trace, judgement);
    if (admitted == base::Known::kUndecided || bench->stopped()) return std::optional<bool>();
    return std::optional(admitted == base::Known::kYes);
  };
  return {record, start.samples, is_clean};
}

std::optional<SampleRecord> Trial::repeat(const SampleRecord& record) {
  const auto* known = recorded(record.sample, DrawPhase::kConfirm);
  if (known == nullptr || known->start_state != record.start_state) {
    bench_->pool_.abandon();  // nothing that ran ahead is needed any more
    submitted_ = record.sample;
    bench_->pool_.submit_repeat(starts_.known(record.start_state).samples, record);
  }
  return result_of(record.sample, DrawPhase::kConfirm, record.start_state);
}

}  // namespace parallax::harness
