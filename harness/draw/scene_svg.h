#pragma once

#include <string>
#include <vector>

#include "harness/draw/scene.h"
#include "harness/draw/scene_view.h"
#include "harness/region/region.h"

namespace parallax::harness {

struct SvgOptions {
  std::string title;                   // above the pictures
  std::string subtitle;                // below the title, two lines at most
  bool warns = false;                  // the subtitle tells of something that went wrong
  const RegionMap* regions = nullptr;  // drawn in the view from above, unless null
  double pixels_per_m = 220.0;         // less where the picture would be wider than 6000 pixels
};

/// A world as it stands, with what led to it.
struct Picture {
  Scene scene;
  SceneAction action;
};

/// The box around all that the pictures show and the floor, with a margin; not empty. Regions
/// (null: none) and goals widen it at most to three times the size of the bodies.
SceneFrame frame_around(const std::vector<Picture>& pictures, const RegionMap* regions);

/// An SVG picture with a view from above (x to the right, y up) and one from the side (looking
/// along +y: x to the right, z up), axes and a scale. Boxes nearer to the viewer cover those behind
/// them, whose outlines are dotted there. Regions of moving frames are not drawn.
std::string scene_svg(const Picture& picture, const SceneFrame& frame, const SvgOptions& options);

}  // namespace parallax::harness
