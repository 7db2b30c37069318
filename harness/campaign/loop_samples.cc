#include "harness/campaign/loop_samples.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "compiler/base/contract.h"
#include "compiler/base/hash.h"
#include "harness/campaign/start_draw.h"

namespace parallax::harness {
namespace {

// Names of random streams, used instead of a trace's key in the draws of executions.
constexpr std::string_view kStartStream = "closed loop: start";
constexpr std::string_view kStateStream = "closed loop: initial state";
constexpr std::string_view kChoiceStream = "closed loop: choices of the plan";

/// Asks the plan for one perform after the other and tells it what came of each.
class LoopActions final : public ActionSource {
 public:
  struct Bounds {
    std::int64_t performs;
    double simulated_s;
  };
  LoopActions(const Scenario& scenario, const ExecutablePlan& plan, const DrawKey& choices,
              const Bounds& bounds)
      : scenario_(scenario), plan_(plan), choices_(choices), bounds_(bounds) {}

  void begin(SampleRecord& record) override {
    record.path->steps.clear();
    record.path->end = PathEnd::kDone;
    record.path->detail.clear();
    execution_ = plan_.begin(choices_);
    simulated_s_ = 0.0;
  }

  const ActionCall* next(SampleRecord& record) override {
    auto& path = *record.path;
    if (!path.steps.empty() && !tell(record)) return nullptr;
    const auto perform = execution_->next(record.observations.back());
    if (!perform) {
      path.end = execution_->end(path.detail);
      return nullptr;
    }
    if (std::ssize(path.steps) >= bounds_.performs) {
      path.end = PathEnd::kPerformLimit;
      return nullptr;
    }
    if (simulated_s_ >= bounds_.simulated_s) {
      path.end = PathEnd::kTimeLimit;
      return nullptr;
    }
    auto call = call_of(scenario_, ground_fluent(perform->event), perform->arguments);
    PARALLAX_REQUIRE(call.has_value(), "every perform was held against the scenario's actions");
    path.steps.push_back(
        {perform->step, perform->event, perform->source, *std::move(call), false, {}, {}});
    return &path.steps.back().call;
  }

 private:
  bool tell(SampleRecord& record) {
    auto& path = *record.path;
    const auto& after = record.observations.back();
    const auto& before = record.observations[record.observations.size() - 2];
    simulated_s_ += record.outcomes.back().sim_time_s;
    const auto end = execution_->tell(record.outcomes.back(), before, after, path.steps.back());
    if (end) path.end = *end;
    return !end;
  }

  const Scenario& scenario_;
  const ExecutablePlan& plan_;
  DrawKey choices_;
  Bounds bounds_;
  std::unique_ptr<PlanExecution> execution_;
  double simulated_s_ = 0.0;
};

/// An execution ended so; a plan that does not know what became of a perform has been refused.
void end_as(SimStatus status, SampleRecord& record) {
  record.status = sample_status(status);
  const auto end = record.path->end;
  const bool is_error = end == PathEnd::kUnboundReason || end == PathEnd::kUnnamedObject;
  if (record.status != SampleStatus::kOk || !is_error) return;
  record.status = SampleStatus::kRefused;
  record.reason = reason_word(record.outcomes.back());
}

/// The same, wherever the plan's file lies.
bool is_same(const PathStep& a, const PathStep& b) {
  return a.step == b.step && a.event == b.event && a.call == b.call && a.succeeded == b.succeeded &&
         a.object == b.object && a.condition == b.condition;
}

}  // namespace

std::string wrong_path(const Scenario& scenario, const ExecutablePlan& plan,
                       const LoopBounds& bounds, const SampleRecord& record) {
  // A repetition does what the first simulation did, which the reader of journals has compared.
  if (record.phase != DrawPhase::kCertify) return {};
  const auto& path = *record.path;
  const bool was_lost = record.status == SampleStatus::kLost;
  if (was_lost && record.observations.empty()) return {};  // before the plan could begin
  // One that was lost ends with a perform of which the outcome or the observation is missing.
  const auto told = record.observations.size() - (record.observations.empty() ? 0 : 1);
  const bool fits = was_lost ? path.steps.size() == told + 1 && (record.outcomes.size() == told ||
                                                                 record.outcomes.size() == told + 1)
                             : path.steps.size() == told && record.outcomes.size() == told &&
                                   !record.observations.empty();
  if (!fits) return "its observations are not those of its path";
  SampleRecord again;
  again.path.emplace();
  LoopActions source(scenario, plan, LoopSamples::choices_key(bounds.campaign_seed, record.sample),
                     {bounds.max_performs, scenario.limits.max_simulated_s});
  source.begin(again);
  again.observations = {record.observations.front()};
  while (source.next(again) != nullptr) {
    const auto next = again.outcomes.size();
    if (next == told) break;
    again.outcomes.push_back(record.outcomes[next]);
    again.observations.push_back(record.observations[next + 1]);
  }
  const auto& steps = again.path->steps;
  for (std::size_t i = 0; i < std::max(steps.size(), path.steps.size()); ++i) {
    if (i < steps.size() && i < path.steps.size() && is_same(steps[i], path.steps[i])) continue;
    return fmt::format("perform {} is not what the plan makes of what was seen and reported",
                       i + 1);
  }
  if (again.path->end == path.end && again.path->detail == path.detail) return {};
  return "the plan does not end like that after what was seen and reported";
}

LoopSamples::LoopSamples(const Scenario& scenario, const ExecutablePlan& plan,
                         std::vector<LoopStart> starts, std::vector<double> weights,
                         std::uint64_t campaign_seed, std::int64_t max_performs,
                         bool repeats_losses)
    : scenario_(scenario),
      plan_(plan),
      starts_(std::move(starts)),
      weights_(std::move(weights)),
      campaign_seed_(campaign_seed),
      max_performs_(max_performs),
      repeats_losses_(repeats_losses) {
  PARALLAX_REQUIRE(!starts_.empty(), "a model can begin somewhere");
}

DrawKey LoopSamples::key_of(std::int64_t sample) const {
  return {campaign_seed_, loop_start_stream(), DrawPhase::kCertify,
          static_cast<std::uint64_t>(sample), 0};
}

DrawKey LoopSamples::choices_key(std::uint64_t campaign_seed, std::int64_t sample) {
  return {campaign_seed, base::fnv1a64(kChoiceStream), DrawPhase::kCertify,
          static_cast<std::uint64_t>(sample), 0};
}

std::int64_t drawn_state(std::uint64_t campaign_seed, std::int64_t sample, std::size_t states,
                         std::span<const double> weights) {
  const DrawKey key{campaign_seed, base::fnv1a64(kStateStream), DrawPhase::kCertify,
                    static_cast<std::uint64_t>(sample), 0};
  return state_at(CounterRng(key).uniform(0), states, weights);
}

std::uint64_t loop_start_stream() { return base::fnv1a64(kStartStream); }

const LoopStart& LoopSamples::start_of(const SampleRecord& record) const {
  return starts_[static_cast<std::size_t>(record.path->start - 1)];
}

std::optional<SampleRecord> LoopSamples::make(std::int64_t sample, Simulator& simulator,
                                              const std::function<bool()>& abandoned) const {
  return make_from(sample, std::nullopt, simulator, abandoned);
}

std::optional<SampleRecord> LoopSamples::make_from(std::int64_t sample,
                                                   const std::optional<GuidedStart>& guided,
                                                   Simulator& simulator,
                                                   const std::function<bool()>& abandoned) const {
  SampleRecord record;
  record.trace = 1;
  record.sample = sample;
  record.path.emplace();
  record.path->start = guided ? guided->start : draw_state(sample);
  if (guided) record.path->target = guided->target;
  auto key = key_of(sample);
  const auto choices = choices_key(campaign_seed_, sample);
  LoopActions actions(scenario_, plan_, choices, {max_performs_, scenario_.limits.max_simulated_s});
  for (;; ++record.attempt, ++key.attempt) {
    auto drawn = start_of(record).sampler.draw_counting(key, nullptr);
    record.initial = std::move(drawn.start);
    record.redrawn += drawn.refused;
    record.seed = simulator_seed(key);
    const auto status = simulate_start(actions, repeats_losses_, simulator, record, abandoned);
    if (!status) return std::nullopt;
    end_as(*status, record);
    if (record.status != SampleStatus::kRejected) return record;
    if (++record.rejected >= scenario_.limits.max_rejected_starts) return record;
    if (abandoned()) return std::nullopt;
  }
}

std::optional<SampleRecord> LoopSamples::make_at(const SampleRecord& like, std::int64_t sample,
                                                 State start, Simulator& simulator,
                                                 const std::function<bool()>& abandoned) const {
  SampleRecord record;
  record.trace = 1;
  record.sample = sample;
  record.searched = true;
  record.path.emplace();
  record.path->start = like.path->start;
  record.initial = std::move(start);
  record.seed = like.seed;
  const auto choices = choices_key(campaign_seed_, like.sample);
  LoopActions actions(scenario_, plan_, choices, {max_performs_, scenario_.limits.max_simulated_s});
  const auto status = simulate_start(actions, repeats_losses_, simulator, record, abandoned);
  if (!status) return std::nullopt;
  end_as(*status, record);
  return record;
}

std::optional<SampleRecord> LoopSamples::repeat(const SampleRecord& record, Simulator& simulator,
                                                const std::function<bool()>& abandoned) const {
  std::vector<ActionCall> calls;
  for (const auto& step : record.path->steps) calls.push_back(step.call);
  return repeat_sample(calls, repeats_losses_, record, simulator, abandoned);
}

std::string LoopSamples::wrong_draw(const SampleRecord& record) const {
  // The reader of journals has held a repetition against what it repeats.
  const bool drawn = record.phase == DrawPhase::kCertify && is_drawn(record);
  if (!record.path || record.path->start > std::ssize(starts_) ||
      (drawn && record.path->start != draw_state(record.sample))) {
    return "its initial state is not that of its number";
  }
  const auto key = key_of(record.sample);
  auto why = harness::wrong_draw(record, start_of(record).sampler, campaign_seed_, key.trace_key);
  if (why.empty()) why = wrong_path(scenario_, plan_, {campaign_seed_, max_performs_}, record);
  return why;
}

}  // namespace parallax::harness
