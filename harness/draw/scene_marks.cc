#include "harness/draw/scene_marks.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/xml_text.h"
#include "harness/draw/scene_view.h"

namespace parallax::harness {
namespace {

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

std::string gaze(const SceneGaze& gaze, const Projection& projection) {
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
std::string ghost(const Scene& scene, const Projection& projection, const char* title,
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
std::string track(const SceneTrack& track, const Projection& projection) {
  const auto points = projection.pixels(track.points_W);
  const char* colour = track.kind == SceneKind::kItem ? "#d8604c" : "#2b6cb8";
  return group("track", track.name,
               polyline(points, colour, "stroke-width=\"1.6\" stroke-linejoin=\"round\"") +
                   circle(points.front(), 2.0, colour, colour));
}

std::string goal(const SceneGoal& goal, const Projection& projection) {
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

std::string sought(const SceneSought& sought, const std::optional<SceneGaze>& gaze,
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

std::string met(const std::string& name, const Scene& scene, const Projection& projection) {
  std::string out;
  for (const SceneBox& item : scene.boxes) {
    if (item.body != name) continue;
    out += polyline(closed(projection.outline(item.box)), kWarningColour, "stroke-width=\"1.8\"");
  }
  return group("met", name, out);
}

}  // namespace

std::vector<Eigen::Vector2d> closed(std::vector<Eigen::Vector2d> points) {
  if (!points.empty()) points.push_back(points.front());
  return points;
}

std::string marks(const SceneAction& action, const Scene& scene, const Projection& projection) {
  std::string out;
  if (action.gaze) out += gaze(*action.gaze, projection);
  out += ghost(action.ghost, projection, "earlier");
  out += ghost(action.meeting, projection, "where it would meet", kWarningColour);
  for (const auto& name : action.met) out += met(name, scene, projection);
  for (const auto& one : action.tracks) out += track(one, projection);
  if (action.goal) out += goal(*action.goal, projection);
  for (const auto& one : action.sought) out += sought(one, action.gaze, projection);
  return out;
}

}  // namespace parallax::harness
