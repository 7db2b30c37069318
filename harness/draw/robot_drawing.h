#pragma once

#include <string>

#include "harness/world/world_spec.h"

namespace parallax::harness {

/// The robot of a world at its default placement, from the side and from above, as an SVG: its
/// shapes to scale, the frames B of the base and P of each palm, the tool points, and the names and
/// numbers that `robot` and its joints have in the file. Labels stand in columns beside the views,
/// one under the other. `spec` must pass check_world and have a robot.
std::string robot_svg(const WorldSpec& spec, const std::string& title);

}  // namespace parallax::harness
