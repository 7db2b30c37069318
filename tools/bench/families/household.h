#pragma once

#include <string>

namespace parallax::tools {

/// A model, a binding table and a plan that belong together.
struct Household {
  std::string model;
  std::string binding;
  std::string plan;
};

/// A robot with two arms carries `items` things of four kinds, one to a place, through `rooms`
/// rooms with places for them and one more each. The plan carries one thing after another to a free
/// place, eight performs each, `steps` / 8 times; the horizon is `steps`. All things are where the
/// plan looks for them. One trace.
Household household(int items, int rooms, int steps);

}  // namespace parallax::tools
