#include "harness/draw/scene_marks.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "harness/draw/shown_text.h"

namespace parallax::harness {
namespace {

constexpr const char* kGoodColour = "#1d7a2c";
constexpr const char* kGazeColour = "#b08a00";

std::string group(const char* kind, const std::string& title, const std::string& content) {
  if (content.empty()) return {};
  return fmt::format("<g class=\"{}\"><title>{}</title>\n{}</g>\n", kind, shown_in_full(title),
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
                       const char* colour = nullptr, const char* kind = "ghost") {
  const auto colour_of = [&](SceneKind one) { return colour ? colour : line_colour(one); };
  std::string out;
  for (const SceneBox& item : scene.boxes) {
    const auto outline = closed(projection.outline(item.box));
    if (outline.empty()) continue;
    out += polyline(outline, colour_of(item.kind),
                    "stroke-width=\"1.2\" stroke-dasharray=\"4 2\" stroke-opacity=\"0.9\"");
  }
  for (const SceneArm& arm : scene.arms) {
    out += polyline({projection.pixel(arm.from_W), projection.pixel(arm.to_W)},
                    colour_of(SceneKind::kRobot),
                    "stroke-width=\"2\" stroke-dasharray=\"4 2\" stroke-opacity=\"0.6\"");
  }
  return group(kind, title, out);
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

/// The body as it stands, in red.
std::string red_mark(const char* kind, const std::string& name, const Scene& scene,
                     const Projection& projection, const char* more) {
  std::string out;
  for (const SceneBox& item : scene.boxes) {
    if (item.body != name) continue;
    const auto outline = closed(projection.outline(item.box));
    if (!outline.empty()) out += polyline(outline, kWarningColour, more);
  }
  return group(kind, name, out);
}

std::string reach_mark(const SceneReach& reach, const Projection& projection) {
  const Eigen::Vector2d middle = projection.pixel(reach.shoulder_W);
  // An arc of it at least lies within the view; what does not is cut off with the view.
  std::string out = circle(middle, 3.0, kWarningColour, "white");
  std::vector<std::vector<Eigen::Vector2d>> arcs(1);
  constexpr int kSides = 180;
  const Rectangle area = projection.area();
  for (int i = 0; i <= kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSides;
    const Eigen::Vector2d p = middle + projection.px_per_m() * reach.max_m *
                                           Eigen::Vector2d(std::cos(angle), std::sin(angle));
    if (area.holds({p, p})) {
      arcs.back().push_back(p);
    } else if (!arcs.back().empty()) {
      arcs.emplace_back();
    }
  }
  for (const auto& arc : arcs) {
    if (arc.size() > 1) {
      out += polyline(arc, kWarningColour, "stroke-width=\"1.2\" stroke-dasharray=\"1 3\"");
    }
  }
  return group("reach", "reach", out);
}

/// A line with a bar at both ends.
std::string measure_mark(const SceneMeasure& measure, const Projection& projection) {
  const Eigen::Vector2d a = projection.pixel(measure.from_W), b = projection.pixel(measure.to_W);
  std::string out = polyline({a, b}, kWarningColour, "stroke-width=\"1.4\"");
  const double length = (b - a).norm();
  if (length > 1.0) {
    const Eigen::Vector2d along = (b - a) / length, bar(-5.0 * along.y(), 5.0 * along.x());
    for (const Eigen::Vector2d& end : {a, b}) {
      out += polyline({Eigen::Vector2d(end - bar), Eigen::Vector2d(end + bar)}, kWarningColour,
                      "stroke-width=\"1.4\"");
    }
  }
  return group("measure", measure.label, out);
}

}  // namespace

std::string scene_marks(const SceneAction& action, const Scene& scene,
                        const Projection& projection) {
  std::string out;
  if (action.gaze) out += gaze_mark(*action.gaze, projection);
  out += ghost_mark(action.ghost, projection, "earlier");
  out += ghost_mark(action.predicted, projection, "predicted", kPredictedColour, "predicted");
  out += ghost_mark(action.meeting, projection, "where it would meet", kWarningColour);
  for (const auto& name : action.met) {
    out += red_mark("met", name, scene, projection, "stroke-width=\"1.8\"");
  }
  for (const auto& name : action.differing) {
    out += red_mark("differs", name, scene, projection, "stroke-width=\"2.4\"");
  }
  for (const auto& one : action.tracks) out += track_mark(one, projection);
  if (action.goal) out += goal_mark(*action.goal, projection);
  for (const auto& one : action.sought) out += sought_mark(one, action.gaze, projection);
  if (action.reach) out += reach_mark(*action.reach, projection);
  for (const auto& one : action.measures) out += measure_mark(one, projection);
  return out;
}

std::string mark_labels(const SceneAction& action, SceneView& view) {
  std::string out;
  for (const auto& one : action.measures) {
    const Rectangle named = around(view.projection().pixels({one.from_W, one.to_W}));
    view.keep_free(named);
    out += view.label(one.label, kWarningColour, named);
  }
  std::vector<Eigen::Vector2d> predicted;
  for (const SceneBox& item : action.predicted.boxes) {
    const auto outline = view.projection().outline(item.box);
    predicted.insert(predicted.end(), outline.begin(), outline.end());
  }
  if (!predicted.empty()) out += view.label("predicted", kPredictedColour, around(predicted));
  return out;
}

}  // namespace parallax::harness
