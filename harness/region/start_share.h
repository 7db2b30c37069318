#pragma once

#include <set>
#include <string>
#include <vector>

#include "harness/region/state_mapping.h"

namespace parallax::harness {

/// The share of a body's start cell that its starts are drawn from.
struct StartShare {
  struct Axis {
    std::string axis;                 // "x"
    double drawn = 0.0, whole = 0.0;  // widths [m or rad]
  };
  std::string body, region;
  /// Volume drawn from over volume of the cell, on the axes that are drawn.
  double share = 1.0;
  std::vector<Axis> axes;          // those that are drawn
  std::vector<std::string> fixed;  // bounded axes on which all starts have one value
};

/// The shares of all bodies that a fluent of `true_fluents` puts into a region, sorted by body.
/// `start` is their start_cuboid, of whose intervals the ends are not drawn, `inset` [m, rad] wide.
std::vector<StartShare> start_shares(const StateMapping& mapping,
                                     const std::set<std::string>& true_fluents, StartCuboid start,
                                     double inset = 0.0);

}  // namespace parallax::harness
