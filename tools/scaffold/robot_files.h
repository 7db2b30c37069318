#pragma once

#include <map>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/result.h"
#include "tools/scaffold/scaffold.h"

namespace parallax::tools {

/// A robot description, and where the packages that it names lie.
struct RobotRequest {
  std::string file;
  std::map<std::string, std::string> packages;  // folders by name
};

/// The description and the meshes that it collides with, as files of a scenario's folder, and where
/// the description is among them.
struct RobotFiles {
  std::vector<ScaffoldFile> files;
  std::string description;                // "robot/urdf/arm.urdf"
  std::map<std::string, double> efforts;  // of joints, by plain name [N or Nm]
  std::map<std::string, double> lows;     // lower stops of joints, as the file says [m or rad]
};

/// Reads what the description is made of. A package that `packages` does not name is looked for in
/// the folders above the description, as a folder of that name. Meshes that are not found are left
/// to the import, which warns of them. Reports a file that cannot be read or is no URDF.
base::Result<RobotFiles> robot_files(const RobotRequest& request, base::DiagnosticSink& sink);

}  // namespace parallax::tools
