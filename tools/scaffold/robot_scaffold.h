#pragma once

#include <string>
#include <vector>

#include "tools/scaffold/robot_files.h"

namespace parallax::tools {

/// The files of a scenario in which the arm of a robot description carries a box over a table; they
/// run as they are. What had to be guessed is said in `robot.yaml`. Reports kBadImport for a
/// robot that cannot be taken over, or has no arm with a gripper of two sliding fingers.
base::Result<std::vector<ScaffoldFile>> robot_scaffold(std::string_view name,
                                                       const RobotRequest& request,
                                                       base::DiagnosticSink& sink);

}  // namespace parallax::tools
