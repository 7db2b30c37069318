#pragma once

#include "harness/world/structure_check.h"

namespace parallax::harness {

/// What is wrong with the robot on a line, or with the mobile one, if there is one: the roles that
/// its parts play. Bodies and joints are right.
void check_line_robot(const WorldSpec& spec, ProblemList& problems);
void check_mobile_robot(const WorldSpec& spec, ProblemList& problems);

}  // namespace parallax::harness
