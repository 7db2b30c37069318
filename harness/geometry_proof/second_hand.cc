// The test of a grasp from above once more, without sharing code with hand_check.cc.
//
// The hand is a set of polygons in the frame of the body as it is believed to lie, for both ways
// round, measured from the pads as the world describes them. Safe: every part is apart from
// every obstacle that may be level with it, by circles or by one direction for the box. Refused:
// for each way round that is possible some point lies in a part and an obstacle throughout, at a
// height that is tried. A box that does not show it is cut along the widest variable of the body
// or the base's heading. At most `effort` pieces, each linear in the pairs.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "harness/geometry_proof/flat_scene.h"
#include "harness/geometry_proof/hand_shapes.h"
#include "harness/robot/mobile_robot.h"

namespace parallax::harness {
namespace {

/// The hand as corners in the frame of the believed body, measured from the pads as the world
/// describes them.
class SecondHand final : public SecondEvaluation, private FlatScene {
 public:
  SecondHand(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
             const KnownState& state, std::size_t arm, BodyId object, const HandDescent& descent)
      : FlatScene(spec, layout, region, state),
        object_(object.index()),
        error_m_(descent.error_m),
        error_rad_(descent.error_rad),
        rise_m_(descent.rise_m),
        seen_(descent.seen),
        heights_m_(descent.heights_m),
        clearance_m_(descent.clearance_m),
        wrist_rad_(layout.bodies[object].grasp->wrist_rad) {
    for (int way = 0; way < 2; ++way) add_hand(spec.mobile->arms[arm], way);
  }

  bool confirms(std::span<const Bounds1> box, BoxVerdict verdict, int effort) const override {
    if (verdict == BoxVerdict::kOpen) return true;
    return confirms_box(StartBox(box.begin(), box.end()), verdict, effort);
  }

  bool refuses_at(std::span<const double> start) const override {
    const StartBox box = box_at(start);
    const PlanarRange there = believed(box);
    const double wrist = std::remainder(
        there.middle_yaw() + wrist_rad_ - base_range(box).middle_yaw(), kFullTurn_rad);
    const std::size_t way = std::abs(wrist) > 0.5 * std::numbers::pi ? 1 : 0;
    for (const FlatShape& part : hand_[way]) {
      const Polygon at = moved(part.corners, there.middle(), there.middle_yaw());
      for (const FlatShape& obstacle : obstacles_) {
        if (is_own(obstacle) || !may_be_level(part, obstacle)) continue;
        if (overlap(at, at_middle(obstacle, box))) return true;
      }
    }
    return false;
  }

 private:
  bool is_own(const FlatShape& obstacle) const {
    return obstacle.frame == FlatShape::Frame::kBody && obstacle.body == object_;
  }
  bool may_be_level(const FlatShape& part, const FlatShape& obstacle) const {
    return part.bottom.lower <= obstacle.top.upper &&
           part.top.upper + rise_m_ >= obstacle.bottom.lower;
  }
  bool surely_level(const FlatShape& part, const FlatShape& obstacle) const {
    return std::any_of(heights_m_.begin(), heights_m_.end(), [&](double height) {
      return part.bottom.upper + height < obstacle.top.lower - kFlatRounding_m &&
             part.top.lower + height > obstacle.bottom.upper + kFlatRounding_m;
    });
  }

  /// A point of the plane turned by an angle, as a product of complex numbers.
  static Eigen::Vector2d rotated(const Eigen::Vector2d& p, double angle_rad) {
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    return {p.x() * c - p.y() * s, p.x() * s + p.y() * c};
  }

  void add_hand(const ArmSpec& arm, int way) {
    const BodySpec& near_pad = layout_.bodies[*layout_.find_body(arm.near_pad_body)];
    const BodySpec& far_pad = layout_.bodies[*layout_.find_body(arm.far_pad_body)];
    const auto middle_of = [](const BodySpec& body, const BodyShape& shape) {
      const Eigen::Vector2d p = rotated(shape.p_BS.head<2>(), body.yaw_rad);
      return Eigen::Vector3d(body.p_WB.x() + p.x(), body.p_WB.y() + p.y(),
                             body.p_WB.z() + shape.p_BS.z());
    };
    const Eigen::Vector3d at_near = middle_of(near_pad, near_pad.shapes.front());
    const Eigen::Vector3d at_far = middle_of(far_pad, far_pad.shapes.front());
    const Eigen::Vector3d tool = 0.5 * (at_near + at_far);
    const Eigen::Vector2d line = (at_near - at_far).head<2>().normalized();
    const auto thick = [&](const BodySpec& pad) {
      const BodyShape& shape = pad.shapes.front();
      const Eigen::Vector2d along = rotated(line, -pad.yaw_rad - shape.yaw_rad);
      return along.cwiseAbs().dot(shape.size_m.head<2>());
    };
    const double gap = (at_near - at_far).norm() - 0.5 * thick(near_pad) - 0.5 * thick(far_pad);
    const BodySpec& object = layout_.bodies[layout_.bodies.id_at(object_)];
    const GraspSpec& grasp = *object.grasp;
    const double room = 0.5 * (arm.opening_m - grasp.width_m);
    const double clearance = std::min(room, clearance_m_);
    const double opening = std::min(arm.opening_m, grasp.width_m + 2.0 * clearance);
    const BodyId base = *layout_.find_body(spec_.mobile->base_body);
    const double turn = grasp.wrist_rad - layout_.bodies[base].yaw_rad + std::numbers::pi * way;
    const Bounds1 height = height_of(object);
    for (std::size_t i = 0; i < layout_.bodies.size(); ++i) {
      const BodySpec& body = layout_.bodies[layout_.bodies.id_at(i)];
      const auto in_link_of = [&](const std::string& name) {
        return layout_.link_of[i] &&
               layout_.link_of[i] == layout_.link_of[layout_.find_body(name)->index()];
      };
      const bool is_far = in_link_of(arm.far_pad_body);
      if (!body.collides || !(is_far || in_link_of(arm.palm_body))) continue;
      for (const BodyShape& shape : body.shapes) {
        const Eigen::Vector3d from_tool = middle_of(body, shape) - tool;
        Eigen::Vector2d p = from_tool.head<2>() - line * (room - clearance);
        if (is_far) p += line * (gap - opening);
        FlatShape flat;
        flat.middle = grasp.p_BG.head<2>() + rotated(p, turn);
        flat.half = 0.5 * shape.size_m.head<2>();
        flat.heading_rad = turn + body.yaw_rad + shape.yaw_rad;
        for (const auto& [x, y] : {std::pair{1.0, 1.0}, {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}}) {
          const Eigen::Vector2d corner(x * flat.half.x(), y * flat.half.y());
          flat.corners.push_back(flat.middle + rotated(corner, flat.heading_rad));
        }
        const auto [move, turned] = free_slack(object_);
        const double opened = is_far ? kFingerTolerance_m + kJointRoom_m : kJointRoom_m;
        flat.slack_m = std::sqrt(2.0) * (error_m_ + opened + move) +
                       (error_rad_ + turned) * reach_of(flat.corners);
        flat.shrink_m = flat.slack_m;
        const double z = grasp.p_BG.z() + from_tool.z(), half = 0.5 * shape.size_m.z();
        const double loose = kJointRoom_m;
        flat.bottom = {height.lower + z - half - loose, height.upper + z - half + loose};
        flat.top = {height.lower + z + half - loose, height.upper + z + half + loose};
        add_circle(flat);
        hand_[static_cast<std::size_t>(way)].push_back(std::move(flat));
      }
    }
  }

  Bounds1 height_of(const BodySpec& object) const {
    double lowest = 1e300;
    for (const BodyShape& shape : object.shapes) {
      lowest = std::min(lowest, shape.p_BS.z() - 0.5 * shape.size_m.z());
    }
    Bounds1 z{object.p_WB.z(), object.p_WB.z()};
    for (const auto& [name, interval] : region_.dimensions) {
      if (name == object.name + ".z") z = {interval.lower, interval.upper};
      if (name == object.name + ".bottom") z = {interval.lower - lowest, interval.upper - lowest};
    }
    return {z.lower - state_.slack.drift_m, z.upper + state_.slack.drift_m};
  }

  PlanarRange believed(const StartBox& box) const {
    FlatShape own;
    own.frame = FlatShape::Frame::kBody;
    own.body = object_;
    return range_of(own, box);
  }

  std::array<bool, 2> ways(const StartBox& box, const PlanarRange& there) const {
    const PlanarRange base = base_range(box);
    const double turn = error_rad_ + free_slack(object_).second;
    const double middle =
        std::remainder(there.middle_yaw() + wrist_rad_ - base.middle_yaw(), kFullTurn_rad);
    const double half =
        0.5 * (there.yaw.upper - there.yaw.lower) + 0.5 * (base.yaw.upper - base.yaw.lower) + turn;
    const double quarter = 0.5 * std::numbers::pi;
    // Distance to the two headings at which the hand would turn the other way.
    const double to_border = std::abs(std::abs(middle) - quarter);
    if (to_border <= half + kFlatRounding_m) return {true, true};
    return {std::abs(middle) < quarter, std::abs(middle) > quarter};
  }

  bool confirms_box(const StartBox& box, BoxVerdict verdict, int effort) const {
    const PlanarRange there = believed(box);
    const auto possible = ways(box, there);
    bool is_so = true;
    for (std::size_t way = 0; way < 2 && is_so; ++way) {
      if (!possible[way]) continue;
      const auto hand = seen_from(box, way);
      is_so = verdict == BoxVerdict::kSafe ? clear(hand, box, there) : hit(hand, box, there);
    }
    if (is_so) return true;
    if (effort < 2) return false;
    const std::string own = layout_.bodies[layout_.bodies.id_at(object_)].name + ".";
    std::size_t drawn = 0, axis = box.size();
    double widest = 0.0;
    for (const auto& [name, interval] : region_.dimensions) {
      if (!(interval.lower < interval.upper)) continue;
      const double width = box[drawn].upper - box[drawn].lower;
      if ((name.starts_with(own) || name == "robot.yaw") && width > widest) {
        axis = drawn, widest = width;
      }
      ++drawn;
    }
    if (axis == box.size()) return false;
    const auto [low, high] = cut(box, axis);
    return confirms_box(low, verdict, effort / 2) && confirms_box(high, verdict, effort / 2);
  }

  /// With what the camera adds.
  std::vector<FlatShape> seen_from(const StartBox& box, std::size_t way) const {
    const SightError seen = seen_(box);
    std::vector<FlatShape> hand = hand_[way];
    for (FlatShape& part : hand) {
      part.slack_m += std::sqrt(2.0) * seen.level_m;
      part.shrink_m += std::sqrt(2.0) * seen.level_m;
      part.bottom = {part.bottom.lower - seen.height_m, part.bottom.upper + seen.height_m};
      part.top = {part.top.lower - seen.height_m, part.top.upper + seen.height_m};
    }
    return hand;
  }

  bool clear(const std::vector<FlatShape>& hand, const StartBox& box,
             const PlanarRange& there) const {
    for (const FlatShape& part : hand) {
      const Circle round = circle_of(part, there);
      const Polygon middle = moved(part.corners, there.middle(), there.middle_yaw());
      for (const FlatShape& obstacle : obstacles_) {
        if (is_own(obstacle) || !may_be_level(part, obstacle)) continue;
        const Circle other = circle_of(obstacle, range_of(obstacle, box));
        if ((other.middle - round.middle).norm() > other.radius_m + round.radius_m) continue;
        if (!apart(part, part.corners, {there}, middle, obstacle, box)) return false;
      }
    }
    return true;
  }

  bool hit(const std::vector<FlatShape>& hand, const StartBox& box,
           const PlanarRange& there) const {
    for (const FlatShape& part : hand) {
      const Polygon middle = moved(part.corners, there.middle(), there.middle_yaw());
      for (const FlatShape& obstacle : obstacles_) {
        if (is_own(obstacle) || !obstacle.is_exact || !surely_level(part, obstacle)) continue;
        const Polygon both = common_part(middle, at_middle(obstacle, box));
        if (both.size() < 3) continue;
        const Eigen::Vector2d point = centroid_of(both);
        if (surely_inside(point, there, part.middle, part.heading_rad, part.half,
                          part.shrink_m + kFlatRounding_m) &&
            surely_inside(point, range_of(obstacle, box), obstacle.middle, obstacle.heading_rad,
                          obstacle.half, obstacle.shrink_m + kFlatRounding_m)) {
          return true;
        }
      }
    }
    return false;
  }

  std::size_t object_;
  double error_m_, error_rad_, rise_m_;
  std::function<SightError(std::span<const Bounds1>)> seen_;
  std::vector<double> heights_m_;
  double clearance_m_, wrist_rad_;
  std::array<std::vector<FlatShape>, 2> hand_;
};

}  // namespace

std::unique_ptr<SecondEvaluation> make_second_hand(const WorldSpec& spec, const WorldLayout& layout,
                                                   const StartCuboid& region,
                                                   const KnownState& state, std::size_t arm,
                                                   BodyId object, const HandDescent& descent) {
  return std::make_unique<SecondHand>(spec, layout, region, state, arm, object, descent);
}

}  // namespace parallax::harness
