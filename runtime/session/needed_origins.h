#pragma once

#include <cstdint>
#include <vector>

#include "runtime/session/selected_origins.h"

namespace parallax::runtime {

struct NeededOrigins {
  std::vector<std::uint32_t> origins;  // ascending
  /// The solver was stopped: what was not tried until then counts as needed.
  bool stopped = false;
};

/// What of `candidates` contradicts itself (and what `selected` requires) so that none can be left
/// out. Deletion: the candidates are tried from the end; one that is not needed goes, together with
/// all that its absence frees. The candidates contradict each other. Cost: at most one solver call
/// for each.
NeededOrigins shrink_to_needed(SelectedOrigins& selected, std::vector<std::uint32_t> candidates);

}  // namespace parallax::runtime
