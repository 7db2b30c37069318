#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "compiler/base/contract.h"
#include "harness/geometry_proof/flat_shapes.h"
#include "harness/geometry_proof/second_evaluation.h"
#include "harness/robot/mobile_robot.h"

namespace parallax::harness {
namespace {

constexpr double kRounding_m = 1e-9;
constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// A shape as the second evaluation sees it.
struct FlatShape {
  enum class Frame { kWorld, kBase, kBody, kHand };
  Frame frame = Frame::kWorld;
  std::size_t body = 0;                            // of kBody, and of what a hand holds
  Eigen::Vector2d hand = Eigen::Vector2d::Zero();  // in the frame of the base
  Polygon corners;  // in the frame, round everywhere that it may be but for `slack_m`
  double slack_m = 0.0;
  Bounds1 bottom, top;
  // Where it certainly is, if its place is known.
  bool is_exact = true;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero(), half = Eigen::Vector2d::Zero();
  double heading_rad = 0.0;
  double shrink_m = 0.0;
  // A circle round the corners, in the frame.
  Eigen::Vector2d hub = Eigen::Vector2d::Zero();
  double radius_m = 0.0;
};

void add_circle(FlatShape& shape) {
  shape.hub = centroid_of(shape.corners);
  for (const Eigen::Vector2d& corner : shape.corners) {
    shape.radius_m = std::max(shape.radius_m, (corner - shape.hub).norm());
  }
}

double distance_to_way(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                       const Eigen::Vector2d& b) {
  const Eigen::Vector2d way = b - a;
  const double length = way.squaredNorm();
  const double share = length > 0.0 ? std::clamp((p - a).dot(way) / length, 0.0, 1.0) : 0.0;
  return (p - a - share * way).norm();
}

Polygon corners_of(const BoxShape& shape) {
  Polygon out;
  const double c = std::cos(shape.yaw_rad), s = std::sin(shape.yaw_rad);
  for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
    const Eigen::Vector2d v(0.5 * x * shape.size_m.x(), 0.5 * y * shape.size_m.y());
    out.push_back(shape.p_BS.head<2>() +
                  Eigen::Vector2d(c * v.x() - s * v.y(), s * v.x() + c * v.y()));
  }
  return out;
}

double reach_of(const Polygon& corners) {
  double most = 0.0;
  for (const Eigen::Vector2d& corner : corners) most = std::max(most, corner.norm());
  return most;
}

/// Round a disc.
Polygon ring(const Eigen::Vector2d& middle, double radius_m) {
  constexpr int kCorners = 16;
  Polygon out;
  const double outer = radius_m / std::cos(std::numbers::pi / kCorners);
  for (int i = 0; i < kCorners; ++i) {
    const double angle = kTurn_rad * i / kCorners;
    out.push_back(middle + outer * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return out;
}

/// A part and an obstacle, by their numbers.
using FlatPair = std::pair<std::size_t, std::size_t>;

Bounds1 hull(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

class SecondDrive final : public SecondEvaluation {
 public:
  SecondDrive(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
              const KnownState& state, const KnownPoint& target, double yaw_rad, double step_m)
      : spec_(spec),
        layout_(layout),
        region_(region),
        state_(state),
        yaw_rad_(yaw_rad),
        step_m_(step_m) {
    goal_.x = {target.low.x(), target.high.x()};
    goal_.y = {target.low.y(), target.high.y()};
    for (const auto& [name, interval] : region.dimensions) {
      reference_[name] = 0.5 * (interval.lower + interval.upper);
    }
    const StartState start = read_start_state(spec, layout, reference_);
    PARALLAX_REQUIRE(start.status == SimStatus::kOk, "a start region that the world takes");
    for (std::size_t i = 0; i < layout.bodies.size(); ++i) add_body(i, start.placements);
    for (FlatShape& part : parts_) add_circle(part);
    for (FlatShape& obstacle : obstacles_) add_circle(obstacle);
  }

  bool confirms(std::span<const Bounds1> box, BoxVerdict verdict, int effort) const override {
    if (verdict == BoxVerdict::kOpen) return true;
    const StartBox all(box.begin(), box.end());
    if (verdict == BoxVerdict::kRefuted) return surely_refused(all, effort);
    std::vector<FlatPair> pairs;
    for (std::size_t a = 0; a < parts_.size(); ++a) {
      if (parts_[a].bottom.lower <= 0.0) return false;  // the floor
      for (std::size_t b = 0; b < obstacles_.size(); ++b) {
        if (meet_in_height(parts_[a], obstacles_[b])) pairs.emplace_back(a, b);
      }
    }
    return surely_clear(all, std::move(pairs), effort);
  }

  bool refuses_at(std::span<const double> start) const override {
    StartBox box;
    for (const double value : start) box.push_back({value, value});
    const PlanarRange base = base_range(box);
    const Eigen::Vector2d goal = goal_.middle();
    const double yaw = base.middle_yaw();
    const double turn = std::remainder(yaw_rad_ - yaw, kTurn_rad);
    for (const FlatShape& part : parts_) {
      if (part.bottom.lower <= 0.0) return true;
      for (const FlatShape& obstacle : obstacles_) {
        if (!meet_in_height(part, obstacle)) continue;
        const Polygon there = at_middle(obstacle, box);
        if (!far_from_way(part, obstacle, base, box) && overlap(swept(part, base, box), there)) {
          return true;
        }
        if (part.frame != FlatShape::Frame::kBase || far_from_turn(part, obstacle, box)) continue;
        const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / kTurnStep_rad)));
        for (int i = 0; i <= steps; ++i) {
          if (overlap(moved(part.corners, goal, yaw + turn * i / steps), there)) return true;
        }
      }
    }
    return false;
  }

 private:
  static bool overlap(const Polygon& a, const Polygon& b) {
    return area_of(common_part(a, b)) > 1e-12;
  }
  static bool meet_in_height(const FlatShape& a, const FlatShape& b) {
    return a.top.upper >= b.bottom.lower && b.top.upper >= a.bottom.lower;
  }
  static bool surely_meet_in_height(const FlatShape& a, const FlatShape& b) {
    return a.top.lower > b.bottom.upper + kRounding_m && b.top.lower > a.bottom.upper + kRounding_m;
  }

  std::size_t arm_of(std::size_t body) const {
    const auto& arms = spec_.mobile->arms;
    for (std::size_t a = 0; a < arms.size(); ++a) {
      for (const std::string& name :
           {arms[a].palm_body, arms[a].near_pad_body, arms[a].far_pad_body}) {
        const auto id = layout_.find_body(name);
        if (id && layout_.link_of[id->index()] == layout_.link_of[body]) return a;
      }
    }
    return arms.size();
  }

  void add_body(std::size_t i, const std::vector<Placement>& placements) {
    const BodySpec& body = layout_.bodies[layout_.bodies.id_at(i)];
    if (!body.collides) return;
    const std::size_t base = layout_.find_body(spec_.mobile->base_body)->index();
    const bool on_base = layout_.assembly_of[i] == layout_.assembly_of[base];
    const KnownBody& known = state_.bodies[i];
    for (const BoxShape& shape : body.shapes) {
      FlatShape flat;
      flat.corners = corners_of(shape);
      flat.middle = shape.p_BS.head<2>();
      flat.half = 0.5 * shape.size_m.head<2>();
      flat.heading_rad = shape.yaw_rad;
      const double z = placements[i].p_WB.z() + shape.p_BS.z(), half_z = 0.5 * shape.size_m.z();
      flat.bottom = {z - half_z, z - half_z};
      flat.top = {z + half_z, z + half_z};
      if (known.where == KnownBody::Where::kHeld) {
        add_held(i, body, shape, flat);
        continue;
      }
      if (on_base) {
        add_part(i, body, shape, placements[i], placements[base], flat);
        continue;
      }
      if (layout_.is_free[i]) {
        add_free(i, body, flat);
      } else {
        flat.corners = moved(flat.corners, placements[i].p_WB.head<2>(), placements[i].yaw_rad);
        flat.middle = moved({flat.middle}, placements[i].p_WB.head<2>(), placements[i].yaw_rad)[0];
        flat.heading_rad += placements[i].yaw_rad;
        add_slider(i, flat);
      }
      obstacles_.push_back(std::move(flat));
    }
  }

  /// Corners at both ends of the slider's way hold all that lies between.
  void add_slider(std::size_t i, FlatShape& flat) const {
    for (std::size_t k = 0; k < layout_.sliders.size(); ++k) {
      const JointSpec& joint = layout_.sliders[layout_.sliders.id_at(k)];
      const auto child = layout_.find_body(joint.child);
      if (!layout_.link_of[i] || layout_.link_of[child->index()] != layout_.link_of[i]) continue;
      const Bounds1 q{state_.slider_m[k].lower - state_.slack.drift_m,
                      state_.slider_m[k].upper + state_.slack.drift_m};
      const Eigen::Vector3d axis = joint.axis_W.normalized();
      Polygon both;
      for (const Eigen::Vector2d& corner : flat.corners) {
        both.push_back(corner + q.lower * axis.head<2>());
        both.push_back(corner + q.upper * axis.head<2>());
      }
      flat.corners = hull_of(both);
      flat.middle += 0.5 * (q.lower + q.upper) * axis.head<2>();
      flat.shrink_m = 0.5 * (q.upper - q.lower) * axis.head<2>().norm();
      const Bounds1 rise = hull(q.lower * axis.z(), q.upper * axis.z());
      flat.bottom = {flat.bottom.lower + rise.lower, flat.bottom.upper + rise.upper};
      flat.top = {flat.top.lower + rise.lower, flat.top.upper + rise.upper};
    }
  }

  void add_free(std::size_t i, const BodySpec& body, FlatShape& flat) const {
    flat.frame = FlatShape::Frame::kBody;
    flat.body = i;
    const KnownBody& known = state_.bodies[i];
    double move = state_.slack.drift_m, turn = state_.slack.drift_rad;
    if (known.carrier && !state_.is_start) {
      const Bounds1 q = state_.slider_m[known.carrier->index()];
      if (q.lower != 0.0 || q.upper != 0.0) {
        move += state_.slack.sliding_m + 0.5 * (q.upper - q.lower);
        turn += state_.slack.sliding_rad;
      }
    }
    flat.slack_m = std::sqrt(2.0) * move + turn * reach_of(flat.corners);
    flat.shrink_m = flat.slack_m;
    // Heights are drawn, too: where they may be, seen from the middle.
    for (const auto& [name, interval] : region_.dimensions) {
      if (name != body.name + ".bottom" && name != body.name + ".z") continue;
      const double half = 0.5 * (interval.upper - interval.lower);
      flat.bottom = {flat.bottom.lower - half, flat.bottom.upper + half};
      flat.top = {flat.top.lower - half, flat.top.upper + half};
    }
    flat.bottom = {flat.bottom.lower - state_.slack.drift_m,
                   flat.bottom.upper + state_.slack.drift_m};
    flat.top = {flat.top.lower - state_.slack.drift_m, flat.top.upper + state_.slack.drift_m};
  }

  void raise(FlatShape& flat, double slack_m) const {
    flat.bottom = {flat.bottom.lower + state_.lift_m.lower - slack_m,
                   flat.bottom.upper + state_.lift_m.upper + slack_m};
    flat.top = {flat.top.lower + state_.lift_m.lower - slack_m,
                flat.top.upper + state_.lift_m.upper + slack_m};
  }

  void add_part(std::size_t i, const BodySpec& body, const BoxShape& shape,
                const Placement& placement, const Placement& base, FlatShape flat) {
    flat.frame = FlatShape::Frame::kBase;
    const Eigen::Vector2d p = placement.p_WB.head<2>() - base.p_WB.head<2>();
    const Eigen::Vector2d in_base = moved({p}, Eigen::Vector2d::Zero(), -base.yaw_rad)[0];
    const double turn = placement.yaw_rad - base.yaw_rad;
    const std::size_t arm = arm_of(i);
    const double slack = state_.relief_m + state_.slack.drift_m;
    const bool is_base = body.name == spec_.mobile->base_body;
    if (arm < state_.arms.size() && state_.arms[arm] == KnownArm::kParked) {
      const ArmSpec& own = spec_.mobile->arms[arm];
      // From the middle between the pads, about which all turns and opens.
      const Eigen::Vector3d near = pad_middle(own.near_pad_body),
                            far = pad_middle(own.far_pad_body);
      const Eigen::Vector3d tool = 0.5 * (near + far);
      const JointSpec& finger = layout_.sliders[*layout_.find_slider(own.finger_joint)];
      const Eigen::Vector3d there =
          body.p_WB + Eigen::AngleAxisd(body.yaw_rad, Eigen::Vector3d::UnitZ()) * shape.p_BS;
      double off = (there - tool).head<2>().norm();
      const auto far_body = layout_.find_body(own.far_pad_body);
      if (layout_.link_of[i] == layout_.link_of[far_body->index()]) {
        const Eigen::Vector2d axis = finger.axis_W.normalized().head<2>();
        for (const double q : {finger.low_m.value_or(0.0), finger.high_m.value_or(0.0)}) {
          off = std::max(off, ((there - tool).head<2>() + q * axis).norm());
        }
      }
      const double radius = off + flat.half.norm();
      flat.corners = ring(own.carry_B.head<2>(), radius);
      flat.slack_m = state_.slack.parked_m + state_.slack.drift_m;
      flat.is_exact = false;
      const double z = base.p_WB.z() + there.z() - tool.z() + own.carry_B.z(),
                   half_z = 0.5 * shape.size_m.z();
      flat.bottom = {z - half_z, z - half_z};
      flat.top = {z + half_z, z + half_z};
      raise(flat, slack + state_.slack.parked_m);
    } else {
      flat.corners = moved(flat.corners, in_base, turn);
      flat.middle = moved({flat.middle}, in_base, turn)[0];
      flat.heading_rad += turn;
      if (!is_base) flat.slack_m = flat.shrink_m = std::sqrt(2.0) * state_.slack.drift_m;
      if (is_base) {
        flat.bottom = {flat.bottom.lower - slack, flat.bottom.upper + slack};
        flat.top = {flat.top.lower - slack, flat.top.upper + slack};
      } else {
        raise(flat, slack);
      }
    }
    parts_.push_back(std::move(flat));
  }

  Eigen::Vector3d pad_middle(const std::string& name) const {
    const BodySpec& body = layout_.bodies[*layout_.find_body(name)];
    return body.p_WB +
           Eigen::AngleAxisd(body.yaw_rad, Eigen::Vector3d::UnitZ()) * body.shapes.front().p_BS;
  }

  /// Turned against the world as when it was gripped, at the hand.
  void add_held(std::size_t i, const BodySpec& body, const BoxShape& shape, FlatShape flat) {
    flat.frame = FlatShape::Frame::kHand;
    flat.body = i;
    flat.is_exact = false;
    const GraspSpec grasp = body.grasp.value_or(GraspSpec{});
    const Eigen::Vector2d grip = grasp.p_BG.head<2>();
    const ProofAssumptions& slack = state_.slack;
    const double far = (shape.p_BS - grasp.p_BG).norm() + 0.5 * shape.size_m.norm();
    flat.slack_m = std::sqrt(2.0) * (slack.held_m + slack.parked_m + slack.held_rad * far);
    for (const ArmSpec& arm : spec_.mobile->arms) {
      if (arm.name != state_.bodies[i].arm) continue;
      flat.hand = arm.carry_B.head<2>();
      if (!grasp.follows_body) flat.hand -= grip;
      const BodyId base = *layout_.find_body(spec_.mobile->base_body);
      const double z =
          layout_.bodies[base].p_WB.z() + arm.carry_B.z() + shape.p_BS.z() - grasp.p_BG.z();
      const double half_z = 0.5 * shape.size_m.z();
      flat.bottom = {z - half_z, z - half_z};
      flat.top = {z + half_z, z + half_z};
    }
    if (grasp.follows_body) {
      for (Eigen::Vector2d& corner : flat.corners) corner -= grip;
    }
    raise(flat,
          state_.relief_m + slack.drift_m + slack.held_m + slack.parked_m + slack.held_rad * far);
    parts_.push_back(std::move(flat));
  }

  Bounds1 variable(const StartBox& box, const std::string& name, double fallback) const {
    std::size_t drawn = 0;
    for (const auto& [variable, interval] : region_.dimensions) {
      const bool is_drawn = interval.lower < interval.upper;
      if (variable == name) return is_drawn ? box[drawn] : Bounds1{interval.lower, interval.lower};
      drawn += is_drawn ? 1 : 0;
    }
    return {fallback, fallback};
  }

  PlanarRange base_range(const StartBox& box) const {
    PlanarRange at;
    if (state_.base_at) {
      const auto& goal = *state_.base_at;
      at.x = {goal.p.x() - goal.within_m, goal.p.x() + goal.within_m};
      at.y = {goal.p.y() - goal.within_m, goal.p.y() + goal.within_m};
      at.yaw = {goal.yaw_rad - goal.within_rad, goal.yaw_rad + goal.within_rad};
    } else {
      const BodySpec& body = layout_.bodies[*layout_.find_body(spec_.mobile->base_body)];
      at.x = variable(box, "robot.x", body.p_WB.x());
      at.y = variable(box, "robot.y", body.p_WB.y());
      at.yaw = variable(box, "robot.yaw", body.yaw_rad);
    }
    for (Bounds1* one : {&at.x, &at.y})
      one->lower -= state_.slack.drift_m, one->upper += state_.slack.drift_m;
    at.yaw.lower -= state_.slack.drift_rad, at.yaw.upper += state_.slack.drift_rad;
    return at;
  }

  /// Where the frame of a part is once the base is at `base`.
  PlanarRange carried(const FlatShape& part, const PlanarRange& base, const StartBox& box) const {
    if (part.frame == FlatShape::Frame::kBase) return base;
    PlanarRange at = range_of(part, box);
    at.yaw.lower -= state_.slack.drift_rad + sliding_rad(part);
    at.yaw.upper += state_.slack.drift_rad + sliding_rad(part);
    const double reach = part.hand.norm(), turn = std::atan2(part.hand.y(), part.hand.x());
    const Bounds1 c = cosine_range(base.yaw.lower + turn, base.yaw.upper + turn);
    const double quarter = 0.5 * std::numbers::pi;
    const Bounds1 s =
        cosine_range(base.yaw.lower + turn - quarter, base.yaw.upper + turn - quarter);
    at.x = {base.x.lower + reach * c.lower, base.x.upper + reach * c.upper};
    at.y = {base.y.lower + reach * s.lower, base.y.upper + reach * s.upper};
    return at;
  }

  double sliding_rad(const FlatShape& part) const {
    return state_.bodies[part.body].carrier ? state_.slack.sliding_rad : 0.0;
  }

  /// What a turn about the base's middle makes of a part: anything held is a disc then.
  Polygon turning_corners(const FlatShape& part) const {
    if (part.frame == FlatShape::Frame::kBase) return part.corners;
    return ring(Eigen::Vector2d::Zero(), part.hand.norm() + reach_of(part.corners));
  }

  PlanarRange range_of(const FlatShape& shape, const StartBox& box) const {
    if (shape.frame == FlatShape::Frame::kWorld) return {};
    if (shape.frame == FlatShape::Frame::kBase) return base_range(box);
    const BodySpec& body = layout_.bodies[layout_.bodies.id_at(shape.body)];
    PlanarRange at{variable(box, body.name + ".x", body.p_WB.x()),
                   variable(box, body.name + ".y", body.p_WB.y()),
                   variable(box, body.name + ".yaw", body.yaw_rad)};
    const KnownBody& known = state_.bodies[shape.body];
    if (known.carrier && !state_.is_start) {
      const Bounds1 q = state_.slider_m[known.carrier->index()];
      const Eigen::Vector3d axis = layout_.sliders[*known.carrier].axis_W.normalized();
      const double middle = 0.5 * (q.lower + q.upper);
      at.x.lower += middle * axis.x(), at.x.upper += middle * axis.x();
      at.y.lower += middle * axis.y(), at.y.upper += middle * axis.y();
    }
    return at;
  }

  Polygon at_middle(const FlatShape& shape, const StartBox& box) const {
    const PlanarRange at = range_of(shape, box);
    return moved(shape.corners, at.middle(), at.middle_yaw());
  }

  /// The direction in which two polygons are farthest apart, of the normals of their sides and of
  /// some others.
  static double best_direction(const Polygon& a, const Polygon& b) {
    constexpr int kOthers = 16;
    double best = 0.0, most = -1e300;
    const auto attempt = [&](double angle) {
      const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
      double a_most = -1e300, b_least = 1e300;
      for (const Eigen::Vector2d& p : a) a_most = std::max(a_most, n.dot(p));
      for (const Eigen::Vector2d& p : b) b_least = std::min(b_least, n.dot(p));
      if (b_least - a_most > most) most = b_least - a_most, best = angle;
    };
    for (const Polygon* polygon : {&a, &b}) {
      for (std::size_t i = 0; i < polygon->size(); ++i) {
        const Eigen::Vector2d side = (*polygon)[(i + 1) % polygon->size()] - (*polygon)[i];
        const double normal = std::atan2(-side.x(), side.y());
        attempt(normal);
        attempt(normal + std::numbers::pi);
      }
    }
    for (int i = 0; i < kOthers; ++i) attempt(kTurn_rad * i / kOthers);
    return best;
  }

  bool apart(const FlatShape& part, const Polygon& corners, const std::vector<PlanarRange>& frames,
             const Polygon& middle, const FlatShape& obstacle, const StartBox& box) const {
    const double angle = best_direction(middle, at_middle(obstacle, box));
    double reach = -1e300;
    for (const PlanarRange& frame : frames) {
      reach = std::max(reach, farthest(corners, frame, angle));
    }
    const double begin =
        -farthest(obstacle.corners, range_of(obstacle, box), angle + std::numbers::pi);
    return begin - reach - part.slack_m - obstacle.slack_m > kRounding_m;
  }

  /// The part on its whole way, seen from the middle of the box.
  Polygon swept(const FlatShape& part, const PlanarRange& from, const StartBox& box) const {
    PlanarRange to = goal_;
    to.yaw = from.yaw;
    const PlanarRange first = carried(part, from, box), last = carried(part, to, box);
    Polygon both = moved(part.corners, first.middle(), first.middle_yaw());
    const Polygon end = moved(part.corners, last.middle(), last.middle_yaw());
    both.insert(both.end(), end.begin(), end.end());
    return hull_of(both);
  }

  struct Circle {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double radius_m = 0.0;
  };
  /// Round the shape wherever its frame is in the range.
  static Circle circle_of(const FlatShape& shape, const PlanarRange& frame) {
    const double wide =
        0.5 * std::hypot(frame.x.upper - frame.x.lower, frame.y.upper - frame.y.lower);
    const double swing = 0.5 * (frame.yaw.upper - frame.yaw.lower) * shape.hub.norm();
    return {moved({shape.hub}, frame.middle(), frame.middle_yaw())[0],
            shape.radius_m + shape.slack_m + wide + swing + kRounding_m};
  }

  /// So far apart that circles tell.
  bool far_from_way(const FlatShape& part, const FlatShape& obstacle, const PlanarRange& from,
                    const StartBox& box) const {
    PlanarRange to = goal_;
    to.yaw = from.yaw;
    const Circle first = circle_of(part, carried(part, from, box));
    const Circle last = circle_of(part, carried(part, to, box));
    const Circle there = circle_of(obstacle, range_of(obstacle, box));
    return distance_to_way(there.middle, first.middle, last.middle) >
           there.radius_m + std::max(first.radius_m, last.radius_m);
  }
  bool far_from_turn(const FlatShape& part, const FlatShape& obstacle, const StartBox& box) const {
    const Circle there = circle_of(obstacle, range_of(obstacle, box));
    const double wide =
        0.5 * std::hypot(goal_.x.upper - goal_.x.lower, goal_.y.upper - goal_.y.lower);
    const double reach = part.hand.norm() + reach_of(part.corners) + part.slack_m + wide;
    return (there.middle - goal_.middle()).norm() > there.radius_m + reach + kRounding_m;
  }

  bool clear_on_way(const FlatShape& part, const FlatShape& obstacle, const StartBox& box) const {
    const PlanarRange from = base_range(box);
    if (far_from_way(part, obstacle, from, box)) return true;
    PlanarRange to = goal_;
    to.yaw = from.yaw;
    return apart(part, part.corners, {carried(part, from, box), carried(part, to, box)},
                 swept(part, from, box), obstacle, box);
  }

  /// The headings that a turn may go through from anywhere in `yaw`.
  Bounds1 turned(const Bounds1& yaw) const {
    const double one = std::remainder(yaw_rad_ - yaw.lower, kTurn_rad);
    const double other = std::remainder(yaw_rad_ - yaw.upper, kTurn_rad);
    // Where the way round changes, both are possible.
    const bool jumps = std::abs((one - other) - (yaw.upper - yaw.lower)) > 1e-9;
    const bool is_near = std::numbers::pi - std::max(std::abs(one), std::abs(other)) < 1e-9;
    if (jumps || is_near) return {yaw_rad_ - std::numbers::pi, yaw_rad_ + std::numbers::pi};
    return {yaw.lower + std::min(other, 0.0), yaw.upper + std::max(one, 0.0)};
  }

  bool clear_in_turn(const FlatShape& part, const Polygon& corners, const FlatShape& obstacle,
                     const StartBox& box, const Bounds1& yaw, int depth) const {
    PlanarRange at = goal_;
    at.yaw = yaw;
    if (yaw.upper - yaw.lower < 0.5) {
      const Polygon middle_of_turn = moved(corners, at.middle(), at.middle_yaw());
      if (apart(part, corners, {at}, middle_of_turn, obstacle, box)) {
        return true;
      }
      if (depth >= 14) return false;
    }
    const double middle = at.middle_yaw();
    return clear_in_turn(part, corners, obstacle, box, {yaw.lower, middle}, depth + 1) &&
           clear_in_turn(part, corners, obstacle, box, {middle, yaw.upper}, depth + 1);
  }

  static std::pair<StartBox, StartBox> cut(const StartBox& box, std::size_t axis) {
    StartBox low = box, high = box;
    const double middle = 0.5 * (box[axis].lower + box[axis].upper);
    low[axis].upper = high[axis].lower = middle;
    return {low, high};
  }
  static std::size_t widest_of(const StartBox& box) {
    std::size_t axis = 0;
    for (std::size_t i = 1; i < box.size(); ++i) {
      if (box[i].upper - box[i].lower > box[axis].upper - box[axis].lower) axis = i;
    }
    return axis;
  }

  bool surely_clear(const StartBox& box, std::vector<FlatPair> pairs, int effort) const {
    const Bounds1 yaw = turned(base_range(box).yaw);
    std::erase_if(pairs, [&](const auto& pair) {
      const FlatShape& part = parts_[pair.first];
      const FlatShape& obstacle = obstacles_[pair.second];
      return clear_on_way(part, obstacle, box) &&
             (far_from_turn(part, obstacle, box) ||
              clear_in_turn(part, turning_corners(part), obstacle, box, yaw, 0));
    });
    if (pairs.empty()) return true;
    if (effort < 2 || box.empty()) return false;
    const auto [low, high] = cut(box, cut_axis(box, pairs.front()));
    return surely_clear(low, pairs, effort / 2) && surely_clear(high, pairs, effort / 2);
  }

  /// The variable, of those that move the pair, that is widest.
  std::size_t cut_axis(const StartBox& box, const FlatPair& pair) const {
    const FlatShape& part = parts_[pair.first];
    const FlatShape& obstacle = obstacles_[pair.second];
    const auto name_of = [&](std::size_t body) {
      return layout_.bodies[layout_.bodies.id_at(body)].name;
    };
    std::string own, held;
    if (obstacle.frame == FlatShape::Frame::kBody) own = name_of(obstacle.body) + ".";
    if (part.frame == FlatShape::Frame::kHand) held = name_of(part.body) + ".yaw";
    std::optional<std::size_t> best;
    std::size_t drawn = 0;
    for (const auto& [name, interval] : region_.dimensions) {
      if (!(interval.lower < interval.upper)) continue;
      const bool matters =
          name.starts_with("robot.") || name == held || (!own.empty() && name.starts_with(own));
      const double width = box[drawn].upper - box[drawn].lower;
      if (matters && (!best || width > box[*best].upper - box[*best].lower)) best = drawn;
      ++drawn;
    }
    return best.value_or(widest_of(box));
  }

  /// A place that the controller tries: the share of the way, or of the turn behind it.
  struct Try {
    double way = 0.0, turn = 0.0;
  };

  PlanarRange at(const Try& one, const PlanarRange& from, double turn_low, double turn_high) const {
    const auto blend = [](const Bounds1& a, const Bounds1& b, double share) {
      return Bounds1{(1.0 - share) * a.lower + share * b.lower,
                     (1.0 - share) * a.upper + share * b.upper};
    };
    return {blend(from.x, goal_.x, one.way),
            blend(from.y, goal_.y, one.way),
            {from.yaw.lower + one.turn * turn_low, from.yaw.upper + one.turn * turn_high}};
  }

  bool surely_refused(const StartBox& box, int effort) const {
    std::optional<FlatPair> nearest;
    if (refused_throughout(box, nearest)) return true;
    if (effort < 2 || box.empty()) return false;
    const auto [low, high] = cut(box, nearest ? cut_axis(box, *nearest) : widest_of(box));
    return surely_refused(low, effort / 2) && surely_refused(high, effort / 2);
  }

  /// `nearest`: a pair that meets in the middle of the box.
  bool refused_throughout(const StartBox& box, std::optional<FlatPair>& nearest) const {
    const PlanarRange from = base_range(box);
    // All numbers of steps that the length of the way may ask for.
    double shortest = 0.0, longest = 0.0;
    for (int i = 0; i < 2; ++i) {
      const Bounds1 a = i == 0 ? from.x : from.y, b = i == 0 ? goal_.x : goal_.y;
      const double least = std::max({0.0, b.lower - a.upper, a.lower - b.upper});
      const double most = std::max(std::abs(b.upper - a.lower), std::abs(a.upper - b.lower));
      shortest = std::hypot(shortest, least);
      longest = std::hypot(longest, most);
    }
    const int fewest = std::max(1, static_cast<int>(std::ceil(shortest / step_m_ - 1e-9)));
    const int most = std::max(1, static_cast<int>(std::ceil(longest / step_m_ + 1e-9)));
    if (most - fewest > 8) return false;
    for (int steps = fewest; steps <= most; ++steps) {
      if (!refused_in(box, from, steps, nearest)) return false;
    }
    return true;
  }

  bool refused_in(const StartBox& box, const PlanarRange& from, int steps,
                  std::optional<FlatPair>& nearest) const {
    const double low = std::remainder(yaw_rad_ - from.yaw.lower, kTurn_rad);
    const double high = std::remainder(yaw_rad_ - from.yaw.upper, kTurn_rad);
    const bool one_way = std::abs((low - high) - (from.yaw.upper - from.yaw.lower)) < 1e-9;
    for (std::size_t a = 0; a < parts_.size(); ++a) {
      const FlatShape& part = parts_[a];
      if (part.is_exact && part.bottom.upper < 0.0) return true;
      for (std::size_t b = 0; b < obstacles_.size(); ++b) {
        const FlatShape& obstacle = obstacles_[b];
        if (!part.is_exact || !obstacle.is_exact || !surely_meet_in_height(part, obstacle))
          continue;
        const auto refused = pair_refused(part, obstacle, box, from, steps, one_way, low, high);
        if (refused) nearest = FlatPair{a, b};
        if (refused.value_or(false)) return true;
      }
    }
    return false;
  }

  /// Is there one place that the controller tries from everywhere in the box, and a point that both
  /// shapes contain then? None: they do not even meet in its middle.
  std::optional<bool> pair_refused(const FlatShape& part, const FlatShape& obstacle,
                                   const StartBox& box, const PlanarRange& from, int steps,
                                   bool one_way, double low, double high) const {
    const Polygon there = at_middle(obstacle, box);
    std::vector<Try> tries;
    if (far_from_way(part, obstacle, from, box) && far_from_turn(part, obstacle, box)) {
      return std::nullopt;
    }
    if (overlap(swept(part, from, box), there)) {
      for (int i = 0; i <= steps; ++i) tries.push_back({static_cast<double>(i) / steps, 0.0});
    }
    if (tries.empty()) {
      tries.push_back({1.0, 1.0});
      const double turn = 0.5 * (low + high);
      const int turns = std::max(1, static_cast<int>(std::ceil(std::abs(turn) / kTurnStep_rad)));
      const bool same =
          std::ceil(std::abs(low) / kTurnStep_rad) == std::ceil(std::abs(high) / kTurnStep_rad);
      for (int i = 0; one_way && same && i < turns; ++i) {
        tries.push_back({1.0, static_cast<double>(i) / turns});
      }
    }
    Try best;
    double most = 0.0;
    Eigen::Vector2d point = Eigen::Vector2d::Zero();
    for (const Try& one : tries) {
      const PlanarRange frame = at(one, from, one_way ? low : 0.0, one_way ? high : 0.0);
      const double yaw = one.turn == 1.0 ? yaw_rad_ : frame.middle_yaw();
      const Polygon both = common_part(moved(part.corners, frame.middle(), yaw), there);
      if (both.size() < 3 || area_of(both) <= most) continue;
      most = area_of(both);
      best = one;
      point = centroid_of(both);
    }
    if (most <= 0.0) return std::nullopt;
    PlanarRange frame = at(best, from, one_way ? low : 0.0, one_way ? high : 0.0);
    if (best.turn == 1.0) frame.yaw = {yaw_rad_, yaw_rad_};
    return surely_inside(point, frame, part.middle, part.heading_rad, part.half,
                         part.shrink_m + kRounding_m) &&
           surely_inside(point, range_of(obstacle, box), obstacle.middle, obstacle.heading_rad,
                         obstacle.half, obstacle.shrink_m + kRounding_m);
  }

  const WorldSpec& spec_;
  const WorldLayout& layout_;
  const StartCuboid& region_;
  const KnownState& state_;
  PlanarRange goal_;
  double yaw_rad_, step_m_;
  State reference_;
  std::vector<FlatShape> parts_, obstacles_;
};

}  // namespace

std::unique_ptr<SecondEvaluation> make_second_drive(
    const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
    const KnownState& state, const KnownPoint& target, double yaw_rad, double sweep_step_m) {
  return std::make_unique<SecondDrive>(spec, layout, region, state, target, yaw_rad, sweep_step_m);
}

}  // namespace parallax::harness
