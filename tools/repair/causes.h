#pragma once

#include <string>
#include <vector>

#include "tools/repair/repair_input.h"

namespace parallax::tools {

/// Why runs that went the same way ended differently, as far as their starts tell.
struct RepairCause {
  std::string kind;   // harness::CauseKind
  std::string words;  // one or two sentences
};

/// One for each step at which runs contradict each other; none where the runs do not tell.
std::vector<RepairCause> causes_of(const RepairInput& input);

}  // namespace parallax::tools
