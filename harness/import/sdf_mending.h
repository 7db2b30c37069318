#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

#include "harness/import/description.h"

namespace parallax::harness {

/// A description that libsdformat reads although it refuses the file as it is.
struct MendedSdf {
  std::string text;
  /// Moments that the library refuses, by model and link; the text has others in their place.
  std::map<std::pair<std::string, std::string>, Eigen::Matrix3d> inertias;
  std::size_t visuals = 0, sensors = 0;  // elements that were cut out, which nothing is taken from
};

/// Cuts out visuals and sensors, whose faults are no matter here, and takes back inertias that no
/// body has. The text has passed `outline_of`.
MendedSdf mended_sdf(const std::string& text, const XmlOutline& outline);

}  // namespace parallax::harness
