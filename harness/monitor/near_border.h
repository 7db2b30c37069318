#pragma once

#include <cstdint>

#include "harness/monitor/observation_reader.h"
#include "harness/region/region.h"

namespace parallax::harness {

/// Where the points lie that differ from a given one by no more than a tolerance.
enum class Nearness : std::uint8_t {
  kInside,   // all of them in the region
  kOutside,  // none of them in the region
  kBorder,   // some of them, or it is not certain
};

/// `point` is in the frame of the region. Linear in the corners of the region's area.
Nearness nearness_of(const Region& region, const Point& point, const ReadingTolerance& tolerance);

}  // namespace parallax::harness
