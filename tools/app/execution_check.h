#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "harness/sampling/sampler.h"
#include "tools/app/closed_loop.h"

namespace parallax::tools {

/// Could a run of the scenario, in closed loop with this seed, have come to a recorded execution?
/// Every command that reads journals asks here; `run --resume` asks the same of its own samples.
class ExecutionCheck {
 public:
  /// `loaded` and `context` outlive the object. Reports what ClosedLoop reports. Null if it was
  /// stopped.
  static base::Result<std::unique_ptr<ExecutionCheck>> make(const ScenarioModel& loaded,
                                                            std::uint64_t seed, Context& context);

  /// What is wrong with it: the state that it began in, its start and seed, or what the plan makes
  /// of what was seen. Empty: nothing. A state that was chosen (`starts: guided`) may be any.
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
