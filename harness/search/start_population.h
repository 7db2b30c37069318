#pragma once

#include <optional>
#include <vector>

#include "harness/search/search_history.h"
#include "harness/search/search_rng.h"

namespace parallax::harness {

/// A start with its margin.
struct Particle {
  UnitPoint point;
  double margin = 0.0;
};

UnitPoint uniform_start(SearchRng& rng, std::size_t dimensions);

/// Proposes where a start might go: symmetric, so that accepting what is valid and below a level
/// keeps the law of starts below that level. Steps are along differences of two guides (ter Braak
/// 2006), which gives them the shape of where these are, along some or all coordinates; some are
/// random steps of any length, and some draw a coordinate anew. None: out of the cube, a move that
/// is not made and need not be simulated, but counts as one. Guides must not depend on the start:
/// with others of its own population the law would not be kept, as a copy and what it was copied
/// from are not independent.
std::optional<UnitPoint> moved(const UnitPoint& from, const std::vector<UnitPoint>& guides,
                               SearchRng& rng);

}  // namespace parallax::harness
