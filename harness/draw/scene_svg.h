#pragma once

#include <string>
#include <vector>

#include "harness/draw/scene_frame.h"

namespace parallax::harness {

struct SvgOptions {
  std::string title = {};                     // above the pictures
  std::string subtitle = {};                  // below the title, two lines at most
  bool warns = false;                         // the subtitle tells of something that went wrong
  std::vector<std::string> differences = {};  // what was predicted and observed, a line each
  const RegionMap* regions = nullptr;         // drawn in the view from above, unless null
  double pixels_per_m = 220.0;  // at most; less where the picture would be wider than 6000 pixels
  /// Does the picture show an action? Then it is as large as a view has room for, with uninvolved
  /// bodies faint and a small map of the world that shows where it is.
  bool is_of_action = false;
  bool has_style = true;  // else the document around it has scene_style
};

/// An SVG picture with a view from above (x to the right, y up) and one from the side (looking
/// along +y: x to the right, z up; or along -x: y to the right), axes and a scale. Boxes nearer to
/// the viewer cover those behind them, whose outlines are dotted there. Regions of moving frames
/// are not drawn. Its element has the class `scene`.
std::string scene_svg(const Picture& picture, const SceneFrame& frame, const SvgOptions& options);

/// Style that turns the colours of pictures dark for readers who prefer that.
std::string scene_style();

}  // namespace parallax::harness
