#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/start_states.h"
#include "harness/geometry_proof/proof_assumptions.h"
#include "harness/geometry_proof/trace_proof.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/cli/command.h"

namespace parallax::tools {

/// A trace from one of its initial states, and what can be proved of it.
struct ProofTask {
  std::shared_ptr<const harness::TracePlan> plan;
  std::string holds;  // what tells the state from the others; empty where there is one only
  harness::WorldLayout layout;
  harness::ProofAssumptions assumptions;
  std::vector<harness::ProofAction> calls;
  std::vector<harness::ProvableAction> actions;  // refer to the layout and the start

  std::int64_t state() const { return plan->start_state; }  // 0: the only one
  const harness::StartCuboid& start() const { return plan->sampler.cuboid(); }
};

/// A trace of a scenario whose geometry can be proved, with its initial states.
class ProofTrace {
 public:
  /// At most so many initial states are proved by one command.
  static constexpr std::size_t kMostStates = 64;

  /// The trace of this number. Null: there is none, or nothing to prove, which was reported, or the
  /// search was stopped. `loaded` and `invocation` outlive the object.
  static std::unique_ptr<ProofTrace> find(const ScenarioModel& loaded, std::int64_t number,
                                          Invocation& invocation);

  std::string events() const { return starts_->first().trace->events(); }
  bool is_single() const { return starts_->is_single(); }
  /// The numbers of the initial states, the first kMostStates of them; drawn ones where they are
  /// too many to list. None: stopped, or it was reported.
  std::optional<std::vector<std::int64_t>> states();
  bool has(std::int64_t state) const { return starts_->has(state); }
  std::string text(std::int64_t state) const { return starts_->text(state); }
  /// How many there are, and what no start realises.
  harness::StartResult about() const;

  /// The task from one of its states; `assume` as the option has it. None: stopped, or it was
  /// reported.
  std::optional<ProofTask> task(std::int64_t state, const std::vector<std::string>& assume);

 private:
  ProofTrace(const ScenarioModel& loaded, Invocation& invocation);
  std::optional<harness::CampaignTrace> trace_of(std::int64_t number);

  const ScenarioModel& loaded_;
  Invocation& invocation_;
  EnumeratedTraces traces_;
  harness::ModelFluents fluents_;
  harness::SimulatorInfo simulator_;
  std::optional<harness::StartStates> starts_;
};

}  // namespace parallax::tools
