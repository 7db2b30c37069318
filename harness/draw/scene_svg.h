#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/draw/scene.h"
#include "harness/region/region.h"

namespace parallax::harness {

struct SvgOptions {
  std::string title;                   // above the pictures
  std::string subtitle;                // below the title
  const RegionMap* regions = nullptr;  // drawn in the view from above, unless null
  double pixels_per_m = 220.0;
};

/// What both views show: the box around every scene given, with a margin.
struct SceneFrame {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
};
SceneFrame frame_around(const Scene& scene);

/// An SVG picture with a view from above (x to the right, y up) and one from the side (looking
/// along +y: x to the right, z up). Boxes nearer to the viewer cover those behind them. Regions of
/// moving frames are not drawn.
std::string scene_svg(const Scene& scene, const SceneFrame& frame, const SvgOptions& options);

}  // namespace parallax::harness
