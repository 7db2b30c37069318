#include "harness/campaign/loop_stream.h"

#include <set>
#include <string>
#include <utility>

#include "compiler/base/diagnostic_codes.h"

namespace parallax::harness {

using base::DiagnosticCode;

std::shared_ptr<const CampaignTrace> LoopStream::start_state(
    const LoopFeed& feed, std::vector<compiler::FluentId> holds) {
  auto state = std::make_shared<CampaignTrace>();
  state->number = 1;
  state->symbols = feed.symbols();
  state->points.resize(1);
  state->points.front().holds = std::move(holds);
  return state;
}

base::Status LoopStream::check_performs() {
  const auto errors_before = sink_.error_count();
  std::set<std::pair<std::string, State>> known;
  for (const auto& perform : feed_.plan().performs()) {
    if (!known.emplace(perform.event, perform.arguments).second) continue;
    CampaignTrace one;
    auto symbols = std::make_shared<compiler::SymbolTable>();
    one.points.resize(2);
    one.points.front().happens = {symbols->add_event(perform.event)};
    one.symbols = std::move(symbols);
    one.plan = {{perform.source, perform.arguments}};
    (void)action_calls(scenario_, one, sink_);
  }
  if (sink_.error_count() != errors_before) return sink_.already_reported();
  return base::Unit{};
}

base::Result<bool> LoopStream::prepare() {
  if (!check_performs()) return sink_.already_reported();
  std::vector<compiler::FluentId> compared;
  const auto& ground = bench_.fluents().ground();
  for (std::size_t i = 0; i < ground.size(); ++i) {
    const auto* binding = scenario_.mapping->find(ground[i].symbol);
    if (binding != nullptr && !binding->is_ignored()) compared.push_back(bench_.fluents().id(i));
  }
  auto states = feed_.initial_states(compared);
  if (!states) return sink_.already_reported();
  if (!*states) return false;
  std::vector<LoopStart> starts;
  for (auto& holds : **states) {
    auto state = start_state(feed_, std::move(holds));
    auto parts = prepare_trace(scenario_, ground, bench_.simulator(), *state, sink_);
    if (!parts) return sink_.already_reported();
    starts.push_back({std::move(state), std::move(parts->sampler)});
  }
  samples_ = std::make_shared<const LoopSamples>(scenario_, feed_.plan(), std::move(starts), seed_,
                                                 feed_.max_performs(),
                                                 may_repeat_losses(bench_.simulator()));
  return true;
}

base::Status LoopStream::continue_from(const Journal& journal) {
  journal_ = &journal;
  for (const auto& [key, record] : journal.recorded().samples) {
    const auto why = samples_->wrong_draw(record);
    if (why.empty()) continue;
    return sink_.error(DiagnosticCode::kForeignJournalLine, journal.recorded().places.at(key), why);
  }
  return base::Unit{};
}

void LoopStream::submit_to(std::int64_t last) {
  while (submitted_ < last) {
    if (recorded(++submitted_, DrawPhase::kCertify) == nullptr) {
      bench_.pool().submit(samples_, submitted_);
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

std::optional<SampleRecord> LoopStream::next() {
  submit_to(next_);
  auto record = result_of(next_, DrawPhase::kCertify);
  if (record) ++next_;
  return record;
}

std::optional<SampleRecord> LoopStream::repeat(const SampleRecord& record, bool goes_on) {
  if (recorded(record.sample, DrawPhase::kConfirm) == nullptr) {
    if (!goes_on) bench_.pool().abandon();
    bench_.pool().submit_repeat(samples_, record);
  }
  return result_of(record.sample, DrawPhase::kConfirm);
}

}  // namespace parallax::harness
