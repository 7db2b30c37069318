#pragma once

#include <cstddef>
#include <string>

#include "tools/repair/verification.h"

namespace parallax::tools {

/// What a model says without a word about what events do and when they happen.
struct Declarations {
  std::string states;       // declarations, and formulas about states and predicates
  std::string start;        // formulas that name a timepoint
  std::size_t dropped = 0;  // statements about events that were left out
};

/// The statements of the model's files in their order, without their comments. Left out is every
/// formula that mentions an event at a time (`Happens`, `Initiates`, `Terminates`, `Releases`,
/// trajectories), and every statement about them (`completion`, `mutex`, `xor`).
Declarations declarations_of(const DomainModel& model);

}  // namespace parallax::tools
