#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "harness/campaign/sample_record.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// Makes the simulations of one stream of samples: those of a trace, or executions of a plan.
/// Shared by the workers' threads and never changed.
class SampleMaker {
 public:
  virtual ~SampleMaker() = default;
  /// Draws and simulates the sample of this number. None when `abandoned` says so before the end.
  virtual std::optional<SampleRecord> make(std::int64_t sample, Simulator& simulator,
                                           const std::function<bool()>& abandoned) const = 0;
  /// Simulates the start, seed and actions of `record` once more.
  virtual std::optional<SampleRecord> repeat(const SampleRecord& record, Simulator& simulator,
                                             const std::function<bool()>& abandoned) const = 0;
};

/// The source of the next actions in a simulation.
class ActionSource {
 public:
  virtual ~ActionSource() = default;
  /// A simulation begins, perhaps not the first one.
  virtual void begin(SampleRecord& record) = 0;
  /// Returns the next action, given the outcomes and observations in `record`; null: there is no
  /// further action. The pointer is valid until the next call.
  virtual const ActionCall* next(SampleRecord& record) = 0;
  /// All actions, where they are known before anything was seen; null: they are not.
  virtual const std::vector<ActionCall>* known() const { return nullptr; }
};

/// Puts the simulator into the record's start and takes one action after the other: reset, observe,
/// then act and observe. A start that is lost gets a second chance with `repeats_losses`. kOk,
/// kInvalidStart, kLost or kUnsupported; none when abandoned.
std::optional<SimStatus> simulate_start(ActionSource& actions, bool repeats_losses,
                                        Simulator& simulator, SampleRecord& record,
                                        const std::function<bool()>& abandoned);

/// The status of a sample whose simulation ended with `status`.
SampleStatus sample_status(SimStatus status);

}  // namespace parallax::harness
