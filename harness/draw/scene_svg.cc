#include "harness/draw/scene_svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/base/utf8.h"
#include "compiler/base/xml_text.h"
#include "harness/draw/scene_view.h"

namespace parallax::harness {
namespace {

constexpr double kMargin_m = 0.1;
constexpr double kGap_px = 30.0;    // between the views
constexpr double kHead_px = 112.0;  // for the title and the notes
constexpr double kFoot_px = 44.0;   // for the scale
constexpr double kMaxWidth_px = 6000.0;
constexpr double kSmallFont_px = 12.0, kNoteFont_px = 11.0;

/// The greatest of 1, 2 and 5 times a power of ten that is not longer.
double round_length_m(double longest_m) {
  const double power = std::pow(10.0, std::floor(std::log10(longest_m)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= longest_m) return digit * power;
  }
  return power;
}

/// A bar of a round length, a tenth to a third of the view.
std::string scale_bar(const Projection& view, double right_px, double px_per_m) {
  const double length_m = round_length_m(0.3 * view.width_px() / px_per_m);
  const double y = view.area().high.y() + 20.0, left = right_px - length_m * px_per_m;
  return fmt::format(
      "<path d=\"M{0:.1f} {2:.1f}v8m0 -4H{1:.1f}m0 -4v8\" fill=\"none\" stroke=\"#444\"/>\n"
      "<text x=\"{3:.1f}\" y=\"{4:.1f}\" font-size=\"10\" text-anchor=\"middle\" "
      "fill=\"#444\">{5:g} m</text>\n",
      left, right_px, y, 0.5 * (left + right_px), y + 18.0, length_m);
}

/// At most `lines` lines of about `width` characters; what does not fit gives way to an ellipsis.
std::vector<std::string> wrapped(std::string text, std::size_t width, std::size_t lines) {
  std::vector<std::string> out;
  while (!text.empty() && out.size() < lines) {
    std::size_t cut = text.size();
    if (text.size() > width) {
      cut = text.rfind(' ', width);
      if (cut == std::string::npos || cut == 0) cut = width;
    }
    // Never inside a character.
    while (cut < text.size() && base::continues_code_point(text[cut])) ++cut;
    out.push_back(text.substr(0, cut));
    text.erase(0, text.find_first_not_of(' ', cut));
  }
  if (!text.empty() && !out.empty()) out.back() += " \xE2\x80\xA6";
  return out;
}

std::string text_line(const std::string& text, double y_px, double font_px, const char* colour) {
  return fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" font-size=\"{:g}\" fill=\"{}\">{}</text>\n",
                     kGap_px, y_px, font_px, colour, base::xml_escaped(text));
}

std::string head(const SvgOptions& options, const std::vector<std::string>& notes,
                 double width_px) {
  const auto characters = [&](double font_px) {
    return static_cast<std::size_t>(std::max(10.0, (width_px - 2.0 * kGap_px) / (0.58 * font_px)));
  };
  std::string out;
  for (const auto& line : wrapped(options.title, characters(16.0), 1)) {
    out += text_line(line, 24.0, 16.0, "#000");
  }
  double y = 42.0;
  for (const auto& line : wrapped(options.subtitle, characters(kSmallFont_px), 2)) {
    out += text_line(line, y, kSmallFont_px, options.warns ? kWarningColour : "#444");
    y += 16.0;
  }
  std::string all;
  for (const auto& note : notes) all += note + "; ";
  all += "dotted: behind what is nearer";
  y += 4.0;
  for (const auto& line : wrapped(all, characters(kNoteFont_px), 2)) {
    out += text_line(line, y, kNoteFont_px, "#444");
    y += 14.0;
  }
  return out;
}

std::string caption(const char* text, double left_px) {
  return fmt::format(
      "<text x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"11\" fill=\"#444\" "
      "font-style=\"italic\">{}</text>\n",
      left_px, kHead_px - 6.0, text);
}

constexpr const char* kGoodColour = "#1d7a2c";
constexpr const char* kGazeColour = "#b08a00";

std::string group(const char* kind, const std::string& title, const std::string& content) {
  if (content.empty()) return {};
  return fmt::format("<g class=\"{}\"><title>{}</title>\n{}</g>\n", kind, base::xml_escaped(title),
                     content);
}

std::string polyline(const std::vector<Eigen::Vector2d>& points, const char* colour,
                     const char* more) {
  return fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" {}/>\n",
                     point_list(points), colour, more);
}

std::string circle(const Eigen::Vector2d& p, double radius_px, const char* colour,
                   const char* fill) {
  return fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:g}\" fill=\"{}\" stroke=\"{}\" "
      "stroke-width=\"2\"/>\n",
      p.x(), p.y(), radius_px, fill, colour);
}

std::string gaze_mark(const SceneGaze& gaze, const Projection& projection) {
  const Eigen::Vector2d camera = projection.pixel(gaze.camera_W);
  const auto border = projection.pixels(gaze.border_W);
  auto silhouette = border;
  silhouette.push_back(camera);
  std::string out = fmt::format(
      "<polygon points=\"{}\" fill=\"#ffd633\" fill-opacity=\"0.22\"><title>camera</title>"
      "</polygon>\n",
      point_list(hull(silhouette)));
  out += polyline(closed(border), kGazeColour, "stroke-width=\"1\"");
  out += polyline({camera, projection.pixel(gaze.point_W)}, kGazeColour,
                  "stroke-width=\"1.2\" stroke-dasharray=\"8 2 2 2\"");
  return group("gaze", "camera", out + circle(camera, 4.0, kGazeColour, "white"));
}

/// In the colours of the kinds, or all in one.
std::string ghost_mark(const Scene& scene, const Projection& projection, const char* title,
                       const char* colour = nullptr) {
  const auto colour_of = [&](SceneKind kind) { return colour ? colour : line_colour(kind); };
  std::string out;
  for (const SceneBox& item : scene.boxes) {
    out += polyline(closed(projection.outline(item.box)), colour_of(item.kind),
                    "stroke-width=\"1\" stroke-dasharray=\"4 2\" stroke-opacity=\"0.8\"");
  }
  for (const SceneArm& arm : scene.arms) {
    out += polyline({projection.pixel(arm.from_W), projection.pixel(arm.to_W)},
                    colour_of(SceneKind::kRobot),
                    "stroke-width=\"2\" stroke-dasharray=\"4 2\" stroke-opacity=\"0.6\"");
  }
  return group("ghost", title, out);
}

/// A line with a dot where it begins.
std::string track_mark(const SceneTrack& track, const Projection& projection) {
  const auto points = projection.pixels(track.points_W);
  const char* colour = track.kind == SceneKind::kItem ? "#d8604c" : "#2b6cb8";
  return group("track", track.name,
               polyline(points, colour, "stroke-width=\"1.6\" stroke-linejoin=\"round\"") +
                   circle(points.front(), 2.0, colour, colour));
}

std::string goal_mark(const SceneGoal& goal, const Projection& projection) {
  const Eigen::Vector2d from = projection.pixel(goal.from_W), to = projection.pixel(goal.to_W);
  const char* colour = goal.reached ? kGoodColour : kWarningColour;
  const Eigen::Vector2d a(5.0, 5.0), b(5.0, -5.0);
  std::string out;
  if (!goal.reached) {
    out = polyline({from, to}, colour, "stroke-width=\"1.6\" stroke-dasharray=\"7 4\"");
  }
  out += polyline({to - a, to + a}, colour, "stroke-width=\"2\"");
  return group("goal", "goal", out + polyline({to - b, to + b}, colour, "stroke-width=\"2\""));
}

std::string sought_mark(const SceneSought& sought, const std::optional<SceneGaze>& gaze,
                        const Projection& projection) {
  const Eigen::Vector2d there = projection.pixel(sought.p_W);
  const char* colour = sought.seen ? kGoodColour : kWarningColour;
  std::string out = circle(there, 12.0, colour, "none");
  if (gaze) {
    const Eigen::Vector2d camera = projection.pixel(gaze->camera_W);
    const double length = (there - camera).norm();
    const Eigen::Vector2d end =
        length > 12.0 ? Eigen::Vector2d(there + 12.0 / length * (camera - there)) : there;
    out += polyline(
        {camera, end}, colour,
        sought.seen ? "stroke-width=\"1.2\"" : "stroke-width=\"1.2\" stroke-dasharray=\"3 3\"");
  }
  return group("sought", fmt::format("{}: {}", sought.body, sought.seen ? "seen" : "not seen"),
               out);
}

std::string met_mark(const std::string& name, const Scene& scene, const Projection& projection) {
  std::string out;
  for (const SceneBox& item : scene.boxes) {
    if (item.body != name) continue;
    out += polyline(closed(projection.outline(item.box)), kWarningColour, "stroke-width=\"1.8\"");
  }
  return group("met", name, out);
}

/// SVG of what an action did, in one view, over the world as it stands at its end: groups of the
/// classes `gaze`, `ghost`, `track`, `goal`, `sought` and `met`, those that there are.
std::string marks(const SceneAction& action, const Scene& scene, const Projection& projection) {
  std::string out;
  if (action.gaze) out += gaze_mark(*action.gaze, projection);
  out += ghost_mark(action.ghost, projection, "earlier");
  out += ghost_mark(action.meeting, projection, "where it would meet", kWarningColour);
  for (const auto& name : action.met) out += met_mark(name, scene, projection);
  for (const auto& one : action.tracks) out += track_mark(one, projection);
  if (action.goal) out += goal_mark(*action.goal, projection);
  for (const auto& one : action.sought) out += sought_mark(one, action.gaze, projection);
  return out;
}

/// Takes in regions and goals, as far as the frame's own size beyond it.
void widen(SceneFrame& frame, const std::vector<Picture>& pictures, const RegionMap* regions) {
  const Eigen::Vector3d size = frame.high - frame.low;
  const SceneFrame limit{frame.low - size, frame.high + size};
  const auto include = [&](Eigen::Index i, double value) {
    frame.low[i] = std::min(frame.low[i], std::max(value, limit.low[i]));
    frame.high[i] = std::max(frame.high[i], std::min(value, limit.high[i]));
  };
  for (const Picture& picture : pictures) {
    if (!picture.action.goal) continue;
    for (const Eigen::Index i : {0, 1}) include(i, picture.action.goal->to_W[i]);
  }
  if (regions == nullptr) return;
  for (const Region& region : regions->regions()) {
    if (!region.frame.empty()) continue;
    for (const RegionAxis axis : {RegionAxis::kX, RegionAxis::kY}) {
      if (!region.on(axis)) continue;
      include(static_cast<Eigen::Index>(axis), region.on(axis)->lower);
      include(static_cast<Eigen::Index>(axis), region.on(axis)->upper);
    }
  }
}

}  // namespace

SceneFrame frame_around(const std::vector<Picture>& pictures, const RegionMap* regions) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  SceneFrame frame{Eigen::Vector3d::Constant(kInfinity), Eigen::Vector3d::Constant(-kInfinity)};
  const auto include = [&frame](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    frame = {frame.low.cwiseMin(low), frame.high.cwiseMax(high)};
  };
  const auto include_scene = [&](const Scene& scene) {
    for (const SceneBox& item : scene.boxes) {
      const Eigen::Vector3d half = 0.5 * item.box.R_WS.cwiseAbs() * item.box.size_m;
      include(item.box.p_WS - half, item.box.p_WS + half);
    }
    for (const SceneArm& arm : scene.arms) include(arm.from_W, arm.from_W);
  };
  for (const Picture& picture : pictures) {
    include_scene(picture.scene);
    include_scene(picture.action.ghost);
    include_scene(picture.action.meeting);
    for (const SceneTrack& track : picture.action.tracks) {
      for (const Eigen::Vector3d& p : track.points_W) include(p, p);
    }
  }
  if (frame.low.x() > frame.high.x()) frame = SceneFrame{};  // no bodies
  include({frame.low.x(), frame.low.y(), 0.0}, {frame.high.x(), frame.high.y(), 0.0});
  widen(frame, pictures, regions);
  frame.low -= kMargin_m * Eigen::Vector3d::Ones();
  frame.high += kMargin_m * Eigen::Vector3d::Ones();
  return frame;
}

std::string scene_svg(const Picture& picture, const SceneFrame& frame, const SvgOptions& options) {
  const Eigen::Vector3d size = frame.high - frame.low;
  const double longest_m = std::max({2.0 * size.x(), size.y(), size.z()});
  const double px_per_m = std::min(options.pixels_per_m, kMaxWidth_px / longest_m);
  const double side_px = 2.0 * kGap_px + px_per_m * size.x();
  const Projection from_above(frame, ViewKind::kAbove, kGap_px, kHead_px, px_per_m);
  const Projection from_side(frame, ViewKind::kSide, side_px, kHead_px, px_per_m);
  SceneView above(from_above, picture.scene), side(from_side, picture.scene);
  const double width = 3.0 * kGap_px + 2.0 * from_above.width_px();
  const double height =
      kHead_px + kFoot_px + std::max(from_above.height_px(), from_side.height_px());
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      std::ceil(width), std::ceil(height));
  out += head(options, picture.action.notes, width);
  out += caption("from above", kGap_px) + caption("from the side, along y", side_px);
  out += above.bodies();
  if (options.regions != nullptr) out += above.regions(*options.regions);
  out += marks(picture.action, picture.scene, from_above);
  out += above.body_names(picture.action.met);
  if (options.regions != nullptr) out += above.region_names(*options.regions);
  out += side.floor() + side.bodies() + marks(picture.action, picture.scene, from_side);
  out += side.body_names(picture.action.met);
  out += above.axes() + side.axes();
  out += scale_bar(from_above, kGap_px + from_above.width_px(), px_per_m);
  return out + "</svg>\n";
}

}  // namespace parallax::harness
