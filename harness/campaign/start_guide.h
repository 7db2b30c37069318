#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "harness/campaign/sample_record.h"

namespace parallax::harness {

/// A start that was chosen, not drawn.
struct GuidedStart {
  std::int64_t start = 0;  // number of the initial state, from 1
  std::string target;      // what it is to lead to, for people
};

/// Chooses initial states of executions by what became of earlier ones.
class StartGuide {
 public:
  virtual ~StartGuide() = default;
  /// Chooses the start of the execution with this number. Called once for each, in order. None: its
  /// state is drawn.
  virtual std::optional<GuidedStart> next(std::int64_t sample) = 0;
  /// Reports the result of an execution, in order of their numbers.
  virtual void tell(const SampleRecord& record) = 0;
};

}  // namespace parallax::harness
