// The world of the second evaluation: shapes by their corners, in ranges of places.
//
// It shares no code with proof_scene.cc, so that a mistake of one does not confirm itself:
// places come from the code that starts simulations, shapes are polygons and not half widths,
// and a frame is a range of x, y and heading instead of an affine form. What is not exactly
// known is a polygon round everywhere that the shape may be, or a slack that is added to it. Two
// shapes are shown to be apart by one direction, chosen in the middle of the box: the farthest
// that one reaches in it, for all places of its frame, lies before the nearest of the other.
// Circles round the shapes decide most pairs.
//
// Cost: the corners of a pair for each direction; boxes are cut by the callers.

#include "harness/geometry_proof/flat_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

Polygon corners_of(const BodyShape& shape) {
  Polygon out;
  const double c = std::cos(shape.yaw_rad), s = std::sin(shape.yaw_rad);
  for (const auto& [x, y] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
    const Eigen::Vector2d v(0.5 * x * shape.size_m.x(), 0.5 * y * shape.size_m.y());
    out.push_back(shape.p_BS.head<2>() +
                  Eigen::Vector2d(c * v.x() - s * v.y(), s * v.x() + c * v.y()));
  }
  return out;
}

/// Round a disc.
Polygon ring(const Eigen::Vector2d& middle, double radius_m) {
  constexpr int kCorners = 16;
  Polygon out;
  const double outer = radius_m / std::cos(std::numbers::pi / kCorners);
  for (int i = 0; i < kCorners; ++i) {
    const double angle = kFullTurn_rad * i / kCorners;
    out.push_back(middle + outer * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return out;
}

Bounds1 hull(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace

void add_circle(FlatShape& shape) {
  shape.hub = centroid_of(shape.corners);
  for (const Eigen::Vector2d& corner : shape.corners) {
    shape.radius_m = std::max(shape.radius_m, (corner - shape.hub).norm());
  }
}

FlatScene::FlatScene(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
                     const KnownState& state)
    : spec_(spec), layout_(layout), region_(region), state_(state) {
  State reference;
  for (const auto& [name, interval] : region.dimensions) {
    reference[name] = 0.5 * (interval.lower + interval.upper);
  }
  const StartState start = read_start_state(spec, layout, reference);
  PARALLAX_REQUIRE(start.status == SimStatus::kOk, "a start region that the world takes");
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) add_body(i, start.placements);
  for (FlatShape& part : parts_) add_circle(part);
  for (FlatShape& obstacle : obstacles_) add_circle(obstacle);
}

double FlatScene::reach_of(const Polygon& corners) {
  double most = 0.0;
  for (const Eigen::Vector2d& corner : corners) most = std::max(most, corner.norm());
  return most;
}

std::size_t FlatScene::arm_of(std::size_t body) const {
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

void FlatScene::add_body(std::size_t i, const std::vector<Placement>& placements) {
  const BodySpec& body = layout_.bodies[layout_.bodies.id_at(i)];
  if (!body.collides) return;
  const std::size_t base = layout_.find_body(spec_.mobile->base_body)->index();
  const bool on_base = layout_.assembly_of[i] == layout_.assembly_of[base];
  const KnownBody& known = state_.bodies[i];
  for (const BodyShape& shape : body.shapes) {
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

void FlatScene::add_slider(std::size_t i, FlatShape& flat) const {
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

std::pair<double, double> FlatScene::free_slack(std::size_t i) const {
  const KnownBody& known = state_.bodies[i];
  double move = state_.slack.drift_m, turn = state_.slack.drift_rad;
  if (known.carrier && !state_.is_start) {
    const Bounds1 q = state_.slider_m[known.carrier->index()];
    if (q.lower != 0.0 || q.upper != 0.0) {
      move += state_.slack.sliding_m + 0.5 * (q.upper - q.lower);
      turn += state_.slack.sliding_rad;
    }
  }
  return {move, turn};
}

void FlatScene::add_free(std::size_t i, const BodySpec& body, FlatShape& flat) const {
  flat.frame = FlatShape::Frame::kBody;
  flat.body = i;
  const auto [move, turn] = free_slack(i);
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

void FlatScene::raise(FlatShape& flat, double slack_m) const {
  flat.bottom = {flat.bottom.lower + state_.lift_m.lower - slack_m,
                 flat.bottom.upper + state_.lift_m.upper + slack_m};
  flat.top = {flat.top.lower + state_.lift_m.lower - slack_m,
              flat.top.upper + state_.lift_m.upper + slack_m};
}

void FlatScene::add_part(std::size_t i, const BodySpec& body, const BodyShape& shape,
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
    const Eigen::Vector3d near = pad_middle(own.near_pad_body), far = pad_middle(own.far_pad_body);
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

Eigen::Vector3d FlatScene::pad_middle(const std::string& name) const {
  const BodySpec& body = layout_.bodies[*layout_.find_body(name)];
  return body.p_WB +
         Eigen::AngleAxisd(body.yaw_rad, Eigen::Vector3d::UnitZ()) * body.shapes.front().p_BS;
}

void FlatScene::add_held(std::size_t i, const BodySpec& body, const BodyShape& shape,
                         FlatShape flat) {
  flat.frame = FlatShape::Frame::kHand;
  flat.body = i;
  flat.is_exact = false;
  const GraspSpec grasp = body.grasp.value_or(GraspSpec{});
  const ProofAssumptions& slack = state_.slack;
  const double far = (shape.p_BS - grasp.p_BG).norm() + 0.5 * shape.size_m.norm();
  flat.slack_m =
      std::sqrt(2.0) * (slack.held_m + slack.parked_m + (slack.held_rad + slack.lean_rad) * far);
  const BodySpec& base = layout_.bodies[*layout_.find_body(spec_.mobile->base_body)];
  for (const ArmSpec& arm : spec_.mobile->arms) {
    if (arm.name != state_.bodies[i].arm) continue;
    flat.hand = arm.carry_B.head<2>();
    const double z = base.p_WB.z() + arm.carry_B.z() + shape.p_BS.z() - grasp.p_BG.z();
    const double half_z = 0.5 * shape.size_m.z();
    flat.bottom = {z - half_z, z - half_z};
    flat.top = {z + half_z, z + half_z};
    raise(flat, state_.relief_m + slack.drift_m + slack.held_height_m + slack.parked_m +
                    slack.lean_rad * far);
    // The near pad is where the body is, the tool half an opening beside it; the hand may be turned
    // either way.
    const Eigen::Vector3d line = pad_middle(arm.near_pad_body) - pad_middle(arm.far_pad_body);
    const Eigen::Vector2d beside =
        0.5 * (arm.opening_m - grasp.width_m) *
        moved({Eigen::Vector2d(line.head<2>().normalized())}, Eigen::Vector2d::Zero(),
              grasp.wrist_rad - base.yaw_rad)[0];
    for (const double side : {1.0, -1.0}) {
      FlatShape one = flat;
      for (Eigen::Vector2d& corner : one.corners) {
        corner += side * beside - Eigen::Vector2d(grasp.p_BG.head<2>());
      }
      parts_.push_back(std::move(one));
    }
  }
}

Bounds1 FlatScene::variable(const StartBox& box, const std::string& name, double fallback) const {
  std::size_t drawn = 0;
  for (const auto& [variable, interval] : region_.dimensions) {
    const bool is_drawn = interval.lower < interval.upper;
    if (variable == name) return is_drawn ? box[drawn] : Bounds1{interval.lower, interval.lower};
    drawn += is_drawn ? 1 : 0;
  }
  return {fallback, fallback};
}

PlanarRange FlatScene::base_range(const StartBox& box) const {
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

PlanarRange FlatScene::carried(const FlatShape& part, const PlanarRange& base,
                               const StartBox& box) const {
  if (part.frame == FlatShape::Frame::kBase) return base;
  PlanarRange at = range_of(part, box);
  at.yaw.lower -= state_.slack.drift_rad + sliding_rad(part);
  at.yaw.upper += state_.slack.drift_rad + sliding_rad(part);
  const double reach = part.hand.norm(), turn = std::atan2(part.hand.y(), part.hand.x());
  const Bounds1 c = cosine_range(base.yaw.lower + turn, base.yaw.upper + turn);
  const double quarter = 0.5 * std::numbers::pi;
  const Bounds1 s = cosine_range(base.yaw.lower + turn - quarter, base.yaw.upper + turn - quarter);
  at.x = {base.x.lower + reach * c.lower, base.x.upper + reach * c.upper};
  at.y = {base.y.lower + reach * s.lower, base.y.upper + reach * s.upper};
  return at;
}

double FlatScene::sliding_rad(const FlatShape& part) const {
  return state_.bodies[part.body].carrier ? state_.slack.sliding_rad : 0.0;
}

Polygon FlatScene::turning_corners(const FlatShape& part) const {
  if (part.frame == FlatShape::Frame::kBase) return part.corners;
  return ring(Eigen::Vector2d::Zero(), part.hand.norm() + reach_of(part.corners));
}

PlanarRange FlatScene::range_of(const FlatShape& shape, const StartBox& box) const {
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

Polygon FlatScene::at_middle(const FlatShape& shape, const StartBox& box) const {
  const PlanarRange at = range_of(shape, box);
  return moved(shape.corners, at.middle(), at.middle_yaw());
}
double FlatScene::best_direction(const Polygon& a, const Polygon& b) {
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
  for (int i = 0; i < kOthers; ++i) attempt(kFullTurn_rad * i / kOthers);
  return best;
}

bool FlatScene::apart(const FlatShape& part, const Polygon& corners,
                      const std::vector<PlanarRange>& frames, const Polygon& middle,
                      const FlatShape& obstacle, const StartBox& box) const {
  const double angle = best_direction(middle, at_middle(obstacle, box));
  double reach = -1e300;
  for (const PlanarRange& frame : frames) {
    reach = std::max(reach, farthest(corners, frame, angle));
  }
  const double begin =
      -farthest(obstacle.corners, range_of(obstacle, box), angle + std::numbers::pi);
  return begin - reach - part.slack_m - obstacle.slack_m > kFlatRounding_m;
}
FlatScene::Circle FlatScene::circle_of(const FlatShape& shape, const PlanarRange& frame) {
  const double wide =
      0.5 * std::hypot(frame.x.upper - frame.x.lower, frame.y.upper - frame.y.lower);
  const double swing = 0.5 * (frame.yaw.upper - frame.yaw.lower) * shape.hub.norm();
  return {moved({shape.hub}, frame.middle(), frame.middle_yaw())[0],
          shape.radius_m + shape.slack_m + wide + swing + kFlatRounding_m};
}
std::pair<StartBox, StartBox> FlatScene::cut(const StartBox& box, std::size_t axis) {
  StartBox low = box, high = box;
  const double middle = 0.5 * (box[axis].lower + box[axis].upper);
  low[axis].upper = high[axis].lower = middle;
  return {low, high};
}

std::size_t FlatScene::widest_of(const StartBox& box) {
  std::size_t axis = 0;
  for (std::size_t i = 1; i < box.size(); ++i) {
    if (box[i].upper - box[i].lower > box[axis].upper - box[axis].lower) axis = i;
  }
  return axis;
}
bool FlatScene::overlap(const Polygon& a, const Polygon& b) {
  return area_of(common_part(a, b)) > 1e-12;
}

bool FlatScene::meet_in_height(const FlatShape& a, const FlatShape& b) {
  return a.top.upper >= b.bottom.lower && b.top.upper >= a.bottom.lower;
}

bool FlatScene::surely_meet_in_height(const FlatShape& a, const FlatShape& b) {
  return a.top.lower > b.bottom.upper + kFlatRounding_m &&
         b.top.lower > a.bottom.upper + kFlatRounding_m;
}

}  // namespace parallax::harness
