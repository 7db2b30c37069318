#include "compiler/plan/pose_locator.h"

#include <cmath>

namespace parallax::compiler {

double yaw_rad(const Pose& p) {
  return std::atan2(2.0 * (p.qw * p.qz + p.qx * p.qy), 1.0 - 2.0 * (p.qy * p.qy + p.qz * p.qz));
}

std::optional<std::string> PoseLocator::region_of_object(std::string_view /*function*/,
                                                         std::string_view /*relation*/,
                                                         std::string_view object) const {
  return std::string(object);
}

}  // namespace parallax::compiler
