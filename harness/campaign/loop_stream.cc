#include "harness/campaign/loop_stream.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/loop_counts.h"
#include "harness/campaign/loop_judge.h"

namespace parallax::harness {

namespace {

/// Number of executions whose starts are chosen ahead. A choice takes into account all executions
/// but these last ones, so that some can be simulated at the same time. It must not depend on the
/// number of workers.
constexpr std::int64_t kChosenAhead = 4;

}  // namespace

std::vector<compiler::FluentId> compared_fluents(const Scenario& scenario,
                                                 const ModelFluents& fluents) {
  std::vector<compiler::FluentId> out;
  const auto& ground = fluents.ground();
  for (std::size_t i = 0; i < ground.size(); ++i) {
    const auto* binding = scenario.mapping->find(ground[i].symbol);
    if (binding != nullptr && !binding->is_ignored()) out.push_back(fluents.id(i));
  }
  return out;
}

std::shared_ptr<const CampaignTrace> LoopStream::start_state(
    const LoopFeed& feed, std::vector<compiler::FluentId> holds) {
  auto state = std::make_shared<CampaignTrace>();
  state->number = 1;
  state->symbols = feed.symbols();
  state->points.resize(1);
  state->points.front().holds = std::move(holds);
  return state;
}

base::Status check_performs(const Scenario& scenario, const ExecutablePlan& plan,
                            base::DiagnosticSink& sink) {
  const auto errors_before = sink.error_count();
  std::set<std::pair<std::string, State>> known;
  for (const auto& perform : plan.performs()) {
    if (!known.emplace(perform.event, perform.arguments).second) continue;
    CampaignTrace one;
    auto symbols = std::make_shared<compiler::SymbolTable>();
    one.points.resize(2);
    one.points.front().happens = {symbols->add_event(perform.event)};
    one.symbols = std::move(symbols);
    one.plan = {{perform.source, perform.arguments}};
    (void)action_calls(scenario, one, sink);
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return base::Unit{};
}

void LoopStream::describe_unrealisable(const LoopStates& states) {
  auto all = states.holds;
  for (const auto& state : states.without_start) all.push_back(state.holds);
  const auto common = common_fluents(all);
  for (const auto& state : states.without_start) {
    unrealisable_.push_back(
        fmt::format("{}: {}", state_text(state.holds, common, *feed_.symbols()), state.reason));
  }
}

base::Result<bool> LoopStream::prepare() {
  if (!check_performs(scenario_, feed_.plan(), sink_)) return sink_.already_reported();
  const auto& ground = bench_.fluents().ground();
  auto states = feed_.initial_states(compared_fluents(scenario_, bench_.fluents()));
  if (!states) return sink_.already_reported();
  if (!*states) return false;
  std::vector<LoopStart> starts;
  has_weights_ = !(*states)->weights.empty();
  describe_unrealisable(**states);
  common_ = common_fluents((*states)->holds);
  for (auto& holds : (*states)->holds) {
    auto state = start_state(feed_, std::move(holds));
    auto parts = prepare_trace(scenario_, ground, bench_.simulator(), *state, sink_);
    if (!parts) return sink_.already_reported();
    starts.push_back({std::move(state), std::move(parts->sampler)});
  }
  samples_ = std::make_shared<const LoopSamples>(
      scenario_, feed_.plan(), std::move(starts), std::move((*states)->weights), seed_,
      feed_.max_performs(), may_repeat_losses(bench_.simulator()));
  guide_ = feed_.guide(seed_);
  for (std::int64_t i = 0; i < kChosenAhead; ++i) choose();
  return true;
}

void LoopStream::choose() {
  ++decided_;
  if (guide_ == nullptr) return;
  if (auto start = guide_->next(decided_)) chosen_.emplace(decided_, *std::move(start));
}

base::Status LoopStream::continue_from(const Journal& journal) {
  journal_ = &journal;
  for (const auto& [key, record] : journal.recorded().samples) {
    const auto why = samples_->wrong_draw(record);
    if (why.empty()) continue;
    return sink_.error(codes::kForeignJournalLine, journal.recorded().places.at(key), why);
  }
  return base::Unit{};
}

void LoopStream::submit_to(std::int64_t last) {
  if (guide_ != nullptr) last = std::min(last, decided_);
  while (submitted_ < last) {
    if (recorded(++submitted_, DrawPhase::kCertify) != nullptr) continue;
    const auto chosen = chosen_.find(submitted_);
    if (chosen == chosen_.end()) {
      bench_.pool().submit(samples_, submitted_);
    } else {
      bench_.pool().submit(std::make_shared<const GuidedSample>(samples_, chosen->second),
                           submitted_);
    }
  }
}

std::optional<SampleRecord> LoopStream::result_of(std::int64_t sample, DrawPhase phase) {
  if (const auto* known = recorded(sample, phase)) {
    if (bench_.stopped()) return std::nullopt;
    return *known;
  }
  return bench_.pool().wait(sample, phase);
}

base::Result<std::optional<SampleRecord>> LoopStream::next() {
  submit_to(next_);
  auto record = result_of(next_, DrawPhase::kCertify);
  if (!record) return record;
  const auto chosen = chosen_.find(next_);
  const bool is_chosen = chosen != chosen_.end();
  if (record->path->target != (is_chosen ? chosen->second.target : std::string()) ||
      (is_chosen && record->path->start != chosen->second.start)) {
    const SampleKey key(1, next_, DrawPhase::kCertify);
    return sink_.error(codes::kForeignJournalLine, journal_->recorded().places.at(key),
                       "its initial state is not the one that was chosen for its number");
  }
  ++next_;
  if (guide_ != nullptr) guide_->tell(*record);
  choose();
  return record;
}

std::optional<SampleRecord> LoopStream::visit(std::int64_t state) {
  bench_.pool().abandon();
  const auto sample = next_;
  submitted_ = next_++;
  const auto* known = recorded(sample, DrawPhase::kCertify);
  if (known != nullptr && known->visit && known->path->start == state) {
    return bench_.stopped() ? std::nullopt : std::optional(*known);
  }
  const GuidedStart start{state, {}};
  bench_.pool().submit(std::make_shared<const GuidedSample>(samples_, start, true), sample);
  return bench_.pool().wait(sample, DrawPhase::kCertify);
}

std::optional<SampleRecord> LoopStream::repeat(const SampleRecord& record, bool goes_on) {
  if (recorded(record.sample, DrawPhase::kConfirm) == nullptr) {
    if (!goes_on) bench_.pool().abandon();
    bench_.pool().submit_repeat(samples_, record);
  }
  return result_of(record.sample, DrawPhase::kConfirm);
}

std::string LoopStream::text(std::int64_t state) const {
  const auto& start = samples_->starts()[static_cast<std::size_t>(state) - 1];
  return state_text(start.state->points.front().holds, common_, *start.state->symbols);
}

CleanSample LoopStream::clean_sample(const SampleRecord& record) const {
  const auto is_clean = [&scenario = scenario_, &feed = feed_,
                         &bench = bench_](const SampleRecord& again) -> std::optional<bool> {
    const auto judgement =
        judge_path(*scenario.mapping, bench.fluents(), feed, again, scenario.comparison());
    if (!judgement.missing.empty()) return false;
    if (judgement.admitted == base::Known::kUndecided || bench.stopped()) return std::nullopt;
    return judgement.admitted == base::Known::kYes && why_unfinished(*again.path, scenario).empty();
  };
  return {record, std::make_shared<const RepeatedExecution>(samples_), is_clean};
}

base::DiagnosticBuilder LoopStream::report_refused(const SampleRecord& record) const {
  const auto& path = *record.path;
  if (path.end == PathEnd::kUnboundReason || path.end == PathEnd::kUnnamedObject) {
    return feed_.report_end(path, record.reason);
  }
  const auto in = fmt::format("in simulation {}.{}", record.trace, record.sample);
  const auto code = codes::kSimulatorRefused;
  if (record.observations.empty() || path.steps.empty()) {
    return sink_.error(code, scenario_.sampling_source, fmt::format("refused the start {}", in),
                       record.reason);
  }
  const auto event = ground_fluent(path.steps.back().event);
  const auto action =
      std::find_if(scenario_.actions.begin(), scenario_.actions.end(),
                   [&](const auto& binding) { return binding.event == event.symbol; });
  return sink_.error(code, action->source,
                     fmt::format("refused the action of `{}` {}", event.text, in), record.reason);
}

}  // namespace parallax::harness
