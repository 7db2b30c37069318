#pragma once

#include <optional>
#include <string>

#include "tools/repair/patch.h"
#include "tools/repair/repair_input.h"

namespace parallax::tools {

/// A failure as the plan is told of it, and the change of the binding table that this needs.
struct BoundFailure {
  std::string words;                // a sentence
  std::optional<ChangedFile> file;  // none: the table knows the reason already
};

/// A step that the world refused: `on REASON CLASS` goes behind the other reasons of the first
/// entry for its event, with the class of its `else`. An entry without reasons raises that for all.
/// None where no entry is about the event.
std::optional<BoundFailure> bound_failure(const RepairInput& input, const Evidence::Step& step);

}  // namespace parallax::tools
