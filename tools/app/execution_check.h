#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "compiler/base/result.h"
#include "harness/sampling/sampler.h"
#include "tools/app/closed_loop.h"

namespace parallax::tools {

/// Could a run of the scenario, in closed loop with this seed, have led to a recorded execution?
/// Used by every command that reads journals, and by `run --resume` for its own samples.
class ExecutionCheck {
 public:
  /// `loaded` and `context` outlive the object. Reports what ClosedLoop reports. Null if it was
  /// stopped.
  static base::Result<std::unique_ptr<ExecutionCheck>> make(const ScenarioModel& loaded,
                                                            std::uint64_t seed, Context& context);

  /// Describes why a record cannot be an execution of the plan: its initial state, its start and
  /// seed, or what the plan makes of the observations. Empty: nothing is wrong. A chosen initial
  /// state (`starts: guided`) may be any.
  std::string wrong(const harness::SampleRecord& record) const;

 private:
  ExecutionCheck(const ScenarioModel& loaded, std::uint64_t seed, std::unique_ptr<ClosedLoop> loop)
      : loaded_(loaded), seed_(seed), loop_(std::move(loop)) {}

  const ScenarioModel& loaded_;
  std::uint64_t seed_;
  std::unique_ptr<ClosedLoop> loop_;
  harness::LoopStates states_;
};

}  // namespace parallax::tools
