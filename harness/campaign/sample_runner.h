#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "harness/campaign/sample_maker.h"
#include "harness/campaign/sample_record.h"
#include "harness/campaign/trace_input.h"
#include "harness/config/scenario.h"
#include "harness/sampling/sampler.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// Makes the simulator of one worker. Called in the worker's thread, at most once a worker.
using SimulatorFactory = std::function<std::unique_ptr<Simulator>()>;

/// The data of a trace that a worker needs to simulate any sample of it; shared and never changed.
struct TracePlan {
  std::shared_ptr<const CampaignTrace> trace;
  std::vector<ActionCall> calls;  // per event
  Sampler sampler;
  std::uint64_t campaign_seed = 0;
  std::uint64_t trace_key = 0;  // hash of the trace's key
  std::int64_t max_rejected_starts = 100;
  bool repeats_losses = false;   // see may_repeat_losses
  std::int64_t start_state = 0;  // number of its initial state (SampleRecord)
};

/// May a lost simulation be made again with the same start and seed? Only if that gives the same
/// run to the last bit, which the simulator has to promise. Otherwise the second attempt is another
/// draw: where a simulator tends to crash when the model is wrong, taking the attempt that survives
/// would hide the very runs that are looked for. The first loss counts then.
bool may_repeat_losses(const SimulatorInfo& simulator);

/// The samples of a trace.
class TraceSamples final : public SampleMaker {
 public:
  /// `visits`: they are made for the sake of their initial state (SampleRecord::visit).
  explicit TraceSamples(std::shared_ptr<const TracePlan> plan, bool visits = false)
      : plan_(std::move(plan)), visits_(visits) {}
  std::optional<SampleRecord> make(std::int64_t sample, Simulator& simulator,
                                   const std::function<bool()>& abandoned) const override;
  std::optional<SampleRecord> repeat(const SampleRecord& record, Simulator& simulator,
                                     const std::function<bool()>& abandoned) const override;

 private:
  std::shared_ptr<const TracePlan> plan_;
  bool visits_;
};

/// Draws sample `sample` and simulates it: reset, observe, then act and observe per event. A failed
/// action does not end the sequence: the plan does not know. Invalid starts are drawn again; a
/// simulator that is lost gets the same start and seed once more if the plan says so. None when
/// `abandoned` says so before the end.
std::optional<SampleRecord> run_sample(const TracePlan& plan, std::int64_t sample,
                                       Simulator& simulator,
                                       const std::function<bool()>& abandoned);

/// Simulates a start that was chosen, as the sample of this number. An invalid one is not replaced.
std::optional<SampleRecord> run_chosen(const TracePlan& plan, std::int64_t sample, State start,
                                       Simulator& simulator,
                                       const std::function<bool()>& abandoned);

/// A record counts as a sample only if its number is what its start and seed were drawn from: what
/// is wrong with them, or empty.
std::string wrong_draw(const SampleRecord& record, const Sampler& sampler,
                       std::uint64_t campaign_seed, std::uint64_t trace_key);

/// Simulates the start and seed of `record` again, with nothing drawn; once more when it is lost
/// and `repeats_losses` says so.
std::optional<SampleRecord> repeat_sample(const std::vector<ActionCall>& calls, bool repeats_losses,
                                          const SampleRecord& record, Simulator& simulator,
                                          const std::function<bool()>& abandoned);

/// The controller call for one event of the scenario's actions; none if no action is of that event.
std::optional<ActionCall> call_of(const Scenario& scenario, const GroundFluent& event,
                                  const State& planned);

/// The calls for the events of a trace: each action's own arguments, with "{0}" replaced by the
/// event's argument 0, and what the plan says laid over them. Reports kMissingArgument and
/// kBadWorld for the built-in simulator's controllers.
base::Result<std::vector<ActionCall>> action_calls(const Scenario& scenario,
                                                   const CampaignTrace& trace,
                                                   base::DiagnosticSink& sink);

}  // namespace parallax::harness
