#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "harness/geometry_proof/geometric_check.h"

namespace parallax::harness {

struct SubdivisionLimits {
  std::int64_t boxes = 20'000;  // that may be examined
  double open_share = 0.001;    // less need not be decided
  double finest = 1e-4;         // share of a variable's range below which it is not halved
  const std::atomic<bool>* stop = nullptr;
  /// Told now and then: boxes examined so far, and the share that is open.
  std::function<void(std::int64_t, double)> progress = {};
};

/// A box of starts and what is known of it.
struct DecidedBox {
  StartBox bounds;
  BoxVerdict verdict = BoxVerdict::kOpen;
  std::string culprit;  // of a box that is not safe: what would be met, or may be
};

/// The first box that holds the start; null if none does.
const DecidedBox* box_of(const std::vector<DecidedBox>& boxes, const std::vector<double>& start);

/// The whole start region as boxes that fill it without overlapping.
struct ProofResult {
  std::vector<DecidedBox> boxes;  // in lexicographic order of their lower corners
  std::int64_t examined = 0;
  double safe = 0.0, refuted = 0.0, open = 0.0;  // shares of the region's volume
  bool stopped = false;                          // by the flag
};

/// Halves boxes, the largest first, along the variable that matters most, until all but a share of
/// the region is decided or the limits are met. The same input gives the same boxes. Boxes are
/// halved in their middles only, so that a list of them can be checked to fill the region.
ProofResult prove(const GeometricCheck& check, const StartBox& whole,
                  const SubdivisionLimits& limits);

}  // namespace parallax::harness
