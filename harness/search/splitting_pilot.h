#pragma once

#include <optional>
#include <vector>

#include "harness/search/rare_event_batches.h"
#include "harness/search/start_population.h"

namespace parallax::harness {

/// A level of margins, and starts below it that show roughly where these are.
struct PilotLevel {
  double level = 0.0;
  std::vector<UnitPoint> points;
};

/// A population that shows the others which steps lead from start to start below each level, and is
/// not counted itself. Again and again its better half stays, and the rest become moved copies of
/// these, until all are discrepancies. Levels fall; the first is that of all starts. With `most`
/// runs at the most; none: the batches ended.
std::optional<std::vector<PilotLevel>> run_pilot(std::size_t dimensions, std::int64_t most,
                                                 SearchRng& rng, RareEventBatches& batches);

}  // namespace parallax::harness
