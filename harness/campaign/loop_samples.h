#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/campaign/loop_input.h"
#include "harness/campaign/sample_maker.h"
#include "harness/campaign/sample_runner.h"
#include "harness/campaign/start_guide.h"
#include "harness/config/scenario.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {

/// The number, from 1, of the initial state that a sample begins in: drawn by these weights, or
/// each of `states` equally likely if there are none.
std::int64_t drawn_state(std::uint64_t campaign_seed, std::int64_t sample, std::size_t states,
                         std::span<const double> weights);
/// The stream key that replaces a trace's key when starts of executions are drawn.
std::uint64_t loop_start_stream();

/// An initial state of the model as executions begin in it.
struct LoopStart {
  std::shared_ptr<const CampaignTrace> state;  // one timepoint, no events
  Sampler sampler;
};

/// The limit of one execution of a plan, and the seed of its open choices.
struct LoopBounds {
  std::uint64_t campaign_seed = 0;
  std::int64_t max_performs = 0;
};

/// Why the plan did not do what is on record, told what the record says became of its performs and
/// was seen; empty: it did, or the simulation did not come to its end. What the simulator said is
/// believed.
std::string wrong_path(const Scenario& scenario, const ExecutablePlan& plan,
                       const LoopBounds& bounds, const SampleRecord& record);

/// Executions of a plan. Sample n begins in an initial state that its number draws, each equally
/// likely or by weights, at a point drawn uniformly from that state's cuboid; a start that is not
/// valid is drawn again in the same state. Then each perform of the plan runs its controller, and
/// the plan goes on by what came of it, until it ends or a limit ends it.
class LoopSamples final : public SampleMaker {
 public:
  /// `scenario` and `plan` outlive the object; `starts` is not empty. `weights`: as LoopStates.
  LoopSamples(const Scenario& scenario, const ExecutablePlan& plan, std::vector<LoopStart> starts,
              std::vector<double> weights, std::uint64_t campaign_seed, std::int64_t max_performs,
              bool repeats_losses);

  std::optional<SampleRecord> make(std::int64_t sample, Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override;
  /// The same from a state that was chosen.
  std::optional<SampleRecord> make_from(std::int64_t sample,
                                        const std::optional<GuidedStart>& guided,
                                        Simulator& simulator,
                                        const std::function<bool()>& abandoned) const;
  /// The execution of `like`, with its seed and what the plan leaves open, from another start of
  /// its initial state. An invalid one is not replaced.
  std::optional<SampleRecord> make_at(const SampleRecord& like, std::int64_t sample, State start,
                                      Simulator& simulator,
                                      const std::function<bool()>& abandoned) const;
  /// The recorded actions, one after the other; the plan is not asked again.
  std::optional<SampleRecord> repeat(const SampleRecord& record, Simulator& simulator,
                                     const std::function<bool()>& abandoned) const override;

  /// The key of the random stream for the choices that the plan leaves open in the sample.
  static DrawKey choices_key(std::uint64_t campaign_seed, std::int64_t sample);

  const std::vector<LoopStart>& starts() const { return starts_; }
  const LoopStart& start_of(const SampleRecord& record) const;
  /// The counterpart of wrong_draw of traces; also reports what wrong_path finds.
  std::string wrong_draw(const SampleRecord& record) const;

 private:
  DrawKey key_of(std::int64_t sample) const;
  std::int64_t draw_state(std::int64_t sample) const {
    return drawn_state(campaign_seed_, sample, starts_.size(), weights_);
  }

  const Scenario& scenario_;
  const ExecutablePlan& plan_;
  std::vector<LoopStart> starts_;
  std::vector<double> weights_;
  std::uint64_t campaign_seed_;
  std::int64_t max_performs_;
  bool repeats_losses_;
};

/// One execution from a start that was chosen. `visits`: because no drawn one had tried it.
class GuidedSample final : public SampleMaker {
 public:
  GuidedSample(std::shared_ptr<const LoopSamples> samples, GuidedStart start, bool visits = false)
      : samples_(std::move(samples)), start_(std::move(start)), visits_(visits) {}

  std::optional<SampleRecord> make(std::int64_t sample, Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override {
    auto record = samples_->make_from(sample, start_, simulator, abandoned);
    if (record) record->visit = visits_;
    return record;
  }
  std::optional<SampleRecord> repeat(const SampleRecord& record, Simulator& simulator,
                                     const std::function<bool()>& abandoned) const override {
    return samples_->repeat(record, simulator, abandoned);
  }

 private:
  std::shared_ptr<const LoopSamples> samples_;
  GuidedStart start_;
  bool visits_;
};

/// The plan executed once more from the start and seed of a record, with the same choices.
class RepeatedExecution final : public SampleMaker {
 public:
  explicit RepeatedExecution(std::shared_ptr<const LoopSamples> samples)
      : samples_(std::move(samples)) {}
  std::optional<SampleRecord> make(std::int64_t sample, Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override {
    return samples_->make(sample, simulator, abandoned);
  }
  std::optional<SampleRecord> repeat(const SampleRecord& record, Simulator& simulator,
                                     const std::function<bool()>& abandoned) const override {
    auto again = samples_->make_at(record, record.sample, record.initial, simulator, abandoned);
    if (again) again->phase = DrawPhase::kConfirm;
    return again;
  }

 private:
  std::shared_ptr<const LoopSamples> samples_;
};

}  // namespace parallax::harness
