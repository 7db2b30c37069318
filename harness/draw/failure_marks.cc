#include "harness/draw/failure_marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "harness/world/arguments.h"

namespace parallax::harness {
namespace {

std::string word_of(const State& values, std::string_view name) {
  const auto found = values.find(name);
  const auto* text = found == values.end() ? nullptr : std::get_if<std::string>(&found->second);
  return text == nullptr ? std::string() : *text;
}

std::optional<double> value_of(const State& values, std::string_view name) {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : as_number(found->second);
}

/// The target of a hand action: its object, else the place or point that it names.
std::optional<Eigen::Vector3d> aim_of(const Scene& scene, const WorldSpec& spec,
                                      const State& arguments, std::string& name) {
  name = word_of(arguments, "object");
  if (const auto there = origin_of(scene, name)) return there;
  const auto x = value_of(arguments, "target.x");
  if (!spec.mobile && x) {
    auto there = hand_of(scene, spec, {});
    if (!there) return std::nullopt;
    name = "the target";
    there->x() = *x;
    return there;
  }
  name = word_of(arguments, "place");
  for (const PlaceSpec& place : spec.places) {
    if (place.frame.empty() && place.name == name) return place.p_FP;
  }
  return std::nullopt;
}

/// A point out of reach, and by how much: a margin below 0.
struct ShortReach {
  std::string name;
  Eigen::Vector3d there_W = Eigen::Vector3d::Zero();
  double margin_m = 0.0;
};

/// Marks the reach of an arm that moves along x alone. The missing length begins at its end.
void mark_line(const Scene& scene, const WorldSpec& spec, const ShortReach& missed,
               SceneAction& action) {
  const auto base = origin_of(scene, base_body(spec));
  if (!base) return;
  Eigen::Vector3d end = missed.there_W, shoulder = missed.there_W;
  end.x() += end.x() > base->x() ? missed.margin_m : -missed.margin_m;
  shoulder.x() = base->x();
  action.reach = SceneReach{shoulder, std::abs(end.x() - base->x())};
  action.measures.push_back(
      {end, missed.there_W,
       fmt::format("`{}` {} out of reach", missed.name, length_text(-missed.margin_m))});
  action.notes.emplace_back("red dots: as far as the arm reaches");
}

/// A chain has no reach that is one number.
void mark_chain(const Scene& scene, const ArmSpec& arm, const ShortReach& missed,
                SceneAction& action) {
  const auto hand = origin_of(scene, arm.palm_body);
  if (!hand) return;
  action.measures.push_back({*hand, missed.there_W,
                             fmt::format("`{}`: the joints end {} short of it", missed.name,
                                         length_text(-missed.margin_m))});
}

void mark_gantry(const SceneArm& shown, const ArmSpec& arm, const ShortReach& missed,
                 SceneAction& action) {
  const bool far = (missed.there_W - shown.from_W).norm() > arm.min_reach_m;
  const double limit_m = far ? arm.max_reach_m : arm.min_reach_m;
  const double distance_m = far ? limit_m - missed.margin_m : limit_m + missed.margin_m;
  action.reach = SceneReach{shown.from_W, arm.max_reach_m};
  action.measures.push_back({shown.from_W, missed.there_W,
                             fmt::format("`{}` {} from the shoulder, {} {} reach ({})", missed.name,
                                         length_text(distance_m), length_text(-missed.margin_m),
                                         far ? "out of" : "too near for", length_text(limit_m))});
  action.notes.push_back(
      fmt::format("red dots: reach of the {} arm, {:g} m", arm.name, arm.max_reach_m));
}

void add_reach(const Scene& scene, const WorldSpec& spec, const State& arguments, double margin_m,
               SceneAction& action) {
  ShortReach missed;
  const auto there = aim_of(scene, spec, arguments, missed.name);
  if (!there) return;
  missed.there_W = *there;
  missed.margin_m = margin_m;
  if (!spec.mobile) return mark_line(scene, spec, missed, action);
  const auto wanted = word_of(arguments, "arm");
  for (const ArmSpec& arm : spec.mobile->arms) {
    if (arm.name != wanted) continue;
    if (!arm.chain.empty()) mark_chain(scene, arm, missed, action);
    for (const SceneArm& shown : scene.arms) {
      if (shown.name == wanted) mark_gantry(shown, arm, missed, action);
    }
  }
}

/// The names in backticks, in order.
std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t begin = text.find('`'); begin != std::string::npos;) {
    const auto end = text.find('`', begin + 1);
    if (end == std::string::npos) break;
    out.push_back(text.substr(begin + 1, end - begin - 1));
    begin = text.find('`', end + 1);
  }
  return out;
}

/// The point of a body that lies nearest.
std::optional<Eigen::Vector3d> nearest_point(const Scene& scene, const std::string& body,
                                             const Eigen::Vector3d& p_W) {
  std::optional<Eigen::Vector3d> out;
  for (const SceneBox& item : scene.boxes) {
    if (item.body != body) continue;
    const Eigen::Vector3d half = 0.5 * item.box.size_m;
    const Eigen::Vector3d inside =
        (item.box.R_WS.transpose() * (p_W - item.box.p_WS)).cwiseMax(-half).cwiseMin(half);
    const Eigen::Vector3d there = item.box.p_WS + item.box.R_WS * inside;
    if (!out || (there - p_W).norm() < (*out - p_W).norm()) out = there;
  }
  return out;
}

/// The hand as if it were at the object, turned as it is now.
void add_hand_at(const Scene& scene, const WorldSpec& spec, const State& arguments,
                 SceneAction& action) {
  const auto object = word_of(arguments, "object"), arm_name = word_of(arguments, "arm");
  const auto there = origin_of(scene, object), hand = hand_of(scene, spec, arm_name);
  if (!there || !hand || !spec.mobile || !action.meeting.boxes.empty()) return;
  for (const ArmSpec& arm : spec.mobile->arms) {
    if (arm.name != arm_name) continue;
    for (SceneBox box : scene.boxes) {
      if (box.body != arm.palm_body && box.body != arm.near_pad_body &&
          box.body != arm.far_pad_body) {
        continue;
      }
      box.box.p_WS += *there - *hand;
      action.meeting.boxes.push_back(std::move(box));
    }
  }
  if (!action.meeting.boxes.empty()) {
    action.notes.push_back(fmt::format("red dashes: the hand at `{}`", object));
  }
}

void add_clearance(const Scene& scene, const Outcome& outcome, double clearance_m,
                   SceneAction& action) {
  const auto names = names_in(outcome.reason);
  if (names.size() < 2 || action.meeting.boxes.empty() || clearance_m >= 0.0) return;
  const auto &part = names[names.size() - 2], &obstacle = names.back();
  Eigen::Vector3d middle = action.meeting.boxes.front().box.p_WS;
  for (const SceneBox& box : action.meeting.boxes) {
    if (box.body == part) middle = box.box.p_WS;
  }
  const auto there = nearest_point(scene, obstacle, middle);
  if (!there) return;
  // Across the way, from the obstacle to where it would have to end.
  Eigen::Vector3d across = middle - *there;
  if (action.goal) {
    const Eigen::Vector3d way = action.goal->to_W - action.goal->from_W;
    if (way.norm() > 0.0) across -= across.dot(way) / way.squaredNorm() * way;
  }
  across.z() = 0.0;
  if (across.norm() < 1e-6) across = Eigen::Vector3d::UnitY();
  action.measures.push_back({*there, *there - clearance_m * across.normalized(),
                             fmt::format("`{}` and `{}`: {} too little room", part, obstacle,
                                         length_text(-clearance_m))});
}

}  // namespace

std::string length_text(double length_m) {
  const double size_m = std::abs(length_m);
  if (size_m >= 0.9995) return fmt::format("{:.2f} m", length_m);
  return size_m < 0.01 ? fmt::format("{:.1f} mm", 1000.0 * length_m)
                       : fmt::format("{:.0f} mm", 1000.0 * length_m);
}

std::optional<Eigen::Vector3d> origin_of(const Scene& scene, const std::string& body) {
  for (const SceneBox& item : scene.boxes) {
    if (item.body == body) return item.origin_W;
  }
  return std::nullopt;
}

std::optional<Eigen::Vector3d> hand_of(const Scene& scene, const WorldSpec& spec,
                                       const std::string& arm) {
  std::string near = spec.robot.near_pad_body, far = spec.robot.far_pad_body;
  if (spec.mobile) {
    const auto& arms = spec.mobile->arms;
    const auto found =
        std::find_if(arms.begin(), arms.end(), [&](const ArmSpec& one) { return one.name == arm; });
    if (found == arms.end()) return std::nullopt;
    near = found->near_pad_body;
    far = found->far_pad_body;
  }
  const auto a = origin_of(scene, near), b = origin_of(scene, far);
  if (!a || !b) return std::nullopt;
  return Eigen::Vector3d(0.5 * (*a + *b));
}

void add_failure_marks(const Scene& scene, const WorldSpec& spec, const State& arguments,
                       const Outcome& outcome, SceneAction& action) {
  if (outcome.status == SimStatus::kOk) return;
  const auto reach_m = value_of(outcome.margins, "reach");
  if (reach_m && *reach_m < 0.0) add_reach(scene, spec, arguments, *reach_m, action);
  const auto clearance_m = value_of(outcome.margins, "clearance");
  if (!clearance_m) return;
  add_hand_at(scene, spec, arguments, action);
  add_clearance(scene, outcome, *clearance_m, action);
}

}  // namespace parallax::harness
