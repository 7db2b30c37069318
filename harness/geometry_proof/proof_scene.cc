#include "harness/geometry_proof/proof_scene.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

#include "harness/engine/physics_world.h"
#include "harness/robot/mobile_robot.h"

namespace parallax::harness {
namespace {

Bounds1 plus(const Bounds1& a, const Bounds1& b) { return {a.lower + b.lower, a.upper + b.upper}; }
Bounds1 plus(const Bounds1& a, double b) { return {a.lower + b, a.upper + b}; }
Bounds1 widened(const Bounds1& a, double by) { return {a.lower - by, a.upper + by}; }

AffineForm of(const Bounds1& range) {
  const double middle = 0.5 * (range.lower + range.upper);
  const double radius = std::max(range.upper - middle, middle - range.lower);
  return AffineForm::within(middle, radius * (1.0 + 1e-12));
}

bool in_link_of(const WorldLayout& layout, BodyId body, const std::string& other) {
  const auto id = layout.find_body(other);
  return id && layout.link_of[id->index()].has_value() &&
         layout.link_of[id->index()] == layout.link_of[body.index()];
}

double lowest_m(const BodySpec& body) {
  double lowest = 1e300;
  for (const BodyShape& shape : body.shapes) {
    lowest = std::min(lowest, shape.p_BS.z() - 0.5 * shape.size_m.z());
  }
  return lowest;
}

Eigen::Vector2d turned(const Eigen::Vector2d& p, double yaw_rad) {
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y()};
}

}  // namespace

ProofScene::ProofScene(const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
                       const KnownState& state)
    : spec_(&spec), layout_(&layout), state_(&state), region_(region) {
  for (const auto& [name, interval] : region_.dimensions) {
    if (interval.lower < interval.upper) variables_.push_back(name);
  }
  const std::unique_ptr<PhysicsWorld> owned = make_world(spec);
  PhysicsWorld& world = *owned;
  MobileRobot robot(spec, world);
  for (const Arm& arm : robot.arms()) {
    const JointSpec& finger = layout.sliders[*layout.find_slider(arm.spec().finger_joint)];
    const Eigen::Vector3d axis = finger.axis_W.normalized();
    const BodyId palm = *layout.find_body(arm.spec().palm_body);
    arms_.push_back({arm.bodies(), arm.tool(), *layout.find_body(arm.spec().far_pad_body),
                     finger.low_m.value_or(0.0) * axis, finger.high_m.value_or(0.0) * axis,
                     arm.pad_line(arm.wrist_rad()), arm.palm_offset(), world.rotation(palm),
                     layout.bodies[palm].shapes.front().size_m});
  }
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const BodyId id = layout.bodies.id_at(i);
    const BodySpec& body = layout.bodies[id];
    if (!body.collides) continue;
    const KnownBody& known = state.bodies[i];
    if (known.where == KnownBody::Where::kAnywhere) {
      unknown_.push_back("`" + body.name + "`");
    } else if (known.where == KnownBody::Where::kHeld) {
      for (std::size_t a = 0; a < spec.mobile->arms.size(); ++a) {
        if (spec.mobile->arms[a].name == known.arm) add_held(id, a);
      }
    } else {
      for (const BodyShape& shape : body.shapes) add_piece(id, shape);
    }
  }
  for (std::size_t a = 0; a < state.arms.size(); ++a) {
    if (state.arms[a] == KnownArm::kAnywhere) {
      unknown_.push_back("the " + spec.mobile->arms[a].name + " arm");
    }
  }
}

void ProofScene::add_piece(BodyId id, const BodyShape& shape) {
  const BodySpec& body = layout_->bodies[id];
  const BodyId base = *layout_->find_body(spec_->mobile->base_body);
  const std::uint32_t assembly = layout_->assembly_of[id.index()];
  ScenePiece piece;
  piece.body = id;
  piece.half_x = 0.5 * shape.size_m.x();
  piece.half_y = 0.5 * shape.size_m.y();
  const double half_z = 0.5 * shape.size_m.z();
  if (layout_->is_free[id.index()]) {
    piece.carrier = ScenePiece::Carrier::kItself;
    piece.middle = shape.p_BS.head<2>();
    piece.yaw_rad = shape.yaw_rad;
    const Bounds1 middle = plus(free_height(id), shape.p_BS.z());
    piece.bottom = plus(middle, -half_z);
    piece.top = plus(middle, half_z);
    pieces_.push_back(piece);
    return;
  }
  const Eigen::Vector2d middle = body.p_WB.head<2>() + turned(shape.p_BS.head<2>(), body.yaw_rad);
  const double z = body.p_WB.z() + shape.p_BS.z();
  piece.middle = middle;
  piece.yaw_rad = body.yaw_rad + shape.yaw_rad;
  piece.bottom = {z - half_z, z - half_z};
  piece.top = {z + half_z, z + half_z};
  if (assembly != 0 && assembly == layout_->assembly_of[base.index()]) {
    for (std::size_t a = 0; a < arms_.size(); ++a) {
      const auto& own = arms_[a].bodies;
      if (std::find(own.begin(), own.end(), id) != own.end() &&
          state_->arms[a] != KnownArm::kAtStart) {
        if (state_->arms[a] == KnownArm::kParked) add_arm_pieces(id, shape, a);
        return;
      }
    }
    const BodySpec& base_body = layout_->bodies[base];
    piece.carrier = ScenePiece::Carrier::kBase;
    piece.moves_with_robot = true;
    piece.middle = turned(middle - base_body.p_WB.head<2>(), -base_body.yaw_rad);
    piece.yaw_rad -= base_body.yaw_rad;
    const bool is_base = in_link_of(*layout_, id, base_body.name);
    const auto joints = joints_below(id);
    bool on_torso = false;
    for (const JointSpec* joint : joints) {
      on_torso = on_torso || joint->name == spec_->mobile->torso_joint;
      const auto slider = layout_->find_slider(joint->name);
      if (slider && joint->name != spec_->mobile->torso_joint &&
          (state_->slider_m[slider->index()].lower != 0.0 ||
           state_->slider_m[slider->index()].upper != 0.0)) {
        unknown_.push_back("`" + body.name + "`");
        return;
      }
    }
    const Bounds1 lift = on_torso ? state_->lift_m : Bounds1{};
    piece.bottom = widened(plus(piece.bottom, lift), state_->relief_m + state_->slack.drift_m);
    piece.top = widened(plus(piece.top, lift), state_->relief_m + state_->slack.drift_m);
    if (!is_base) piece.slack_m.setConstant(state_->slack.drift_m);
    pieces_.push_back(piece);
    return;
  }
  if (layout_->link_of[id.index()].has_value()) {  // moves, and not with the robot
    std::optional<SliderId> slider;
    for (std::size_t k = 0; k < layout_->sliders.size(); ++k) {
      const SliderId one = layout_->sliders.id_at(k);
      if (in_link_of(*layout_, id, layout_->sliders[one].child)) slider = one;
    }
    const bool is_simple =
        slider &&
        (layout_->sliders[*slider].parent.empty() ||
         !layout_->link_of[layout_->find_body(layout_->sliders[*slider].parent)->index()]);
    if (!is_simple) {
      unknown_.push_back("`" + body.name + "`");
      return;
    }
    const Bounds1 q = widened(state_->slider_m[slider->index()], state_->slack.drift_m);
    const Eigen::Vector3d axis = layout_->sliders[*slider].axis_W.normalized();
    piece.carrier = ScenePiece::Carrier::kSlider;
    piece.middle += 0.5 * (q.lower + q.upper) * axis.head<2>();
    piece.slack_m = 0.5 * (q.upper - q.lower) * axis.head<2>().cwiseAbs();
    const Bounds1 rise{std::min(q.lower * axis.z(), q.upper * axis.z()),
                       std::max(q.lower * axis.z(), q.upper * axis.z())};
    piece.bottom = plus(piece.bottom, rise);
    piece.top = plus(piece.top, rise);
  }
  pieces_.push_back(piece);
}

/// The joints between the base and a body of the robot.
std::vector<const JointSpec*> ProofScene::joints_below(BodyId id) const {
  std::vector<const JointSpec*> found;
  BodyId at = id;
  for (std::size_t depth = 0; depth < spec_->joints.size(); ++depth) {
    if (in_link_of(*layout_, at, spec_->mobile->base_body)) break;
    const auto joint =
        std::find_if(spec_->joints.begin(), spec_->joints.end(), [&](const JointSpec& one) {
          return one.type != JointType::kFixed && in_link_of(*layout_, at, one.child);
        });
    if (joint == spec_->joints.end() || joint->parent.empty()) break;
    found.push_back(&*joint);
    at = *layout_->find_body(joint->parent);
  }
  return found;
}

/// The wrist may be turned and the gripper opened in any way: a box round all that.
void ProofScene::add_arm_pieces(BodyId id, const BodyShape& shape, std::size_t arm) {
  const BodySpec& body = layout_->bodies[id];
  const ArmSpec& spec = spec_->mobile->arms[arm];
  const Eigen::Vector3d tool = arms_[arm].tool_W;
  const Eigen::Vector2d middle = body.p_WB.head<2>() + turned(shape.p_BS.head<2>(), body.yaw_rad);
  const double z = body.p_WB.z() + shape.p_BS.z() - tool.z() + spec.carry_B.z() + base_z();
  double off = (middle - tool.head<2>()).norm();
  if (layout_->link_of[id.index()] == layout_->link_of[arms_[arm].far_pad.index()]) {
    off = std::max((middle + arms_[arm].closed.head<2>() - tool.head<2>()).norm(),
                   (middle + arms_[arm].opened.head<2>() - tool.head<2>()).norm());
  }
  const double radius = off + 0.5 * shape.size_m.head<2>().norm();
  ScenePiece piece;
  piece.body = id;
  piece.carrier = ScenePiece::Carrier::kBase;
  piece.moves_with_robot = true;
  piece.is_exact = false;
  piece.middle = spec.carry_B.head<2>();
  piece.half_x = piece.half_y = radius + state_->slack.parked_m + state_->slack.drift_m;
  const double slack = state_->slack.parked_m + state_->relief_m + state_->slack.drift_m;
  const double half_z = 0.5 * shape.size_m.z();
  piece.bottom = widened(plus(state_->lift_m, z - half_z), slack);
  piece.top = widened(plus(state_->lift_m, z + half_z), slack);
  pieces_.push_back(piece);
}

/// As it was gripped, where the tool is carried.
void ProofScene::add_held(BodyId id, std::size_t arm) {
  if (state_->arms[arm] != KnownArm::kParked) return;  // the arm is reported
  const BodySpec& body = layout_->bodies[id];
  const KnownBody& known = state_->bodies[id.index()];
  const ArmSpec& spec = spec_->mobile->arms[arm];
  const GraspSpec grasp = body.grasp.value_or(GraspSpec{});
  const ProofAssumptions& slack = state_->slack;
  // The base has turned since, or the grasp goes by the robot's heading.
  if (known.drives != state_->drives || !grasp.follows_body) {
    unknown_.push_back("`" + body.name + "`");
    return;
  }
  for (const BodyShape& shape : body.shapes) {
    for (const double side : {1.0, -1.0}) {  // the hand may be turned either way
      const Eigen::Vector3d grip = gripped_at(grasp, arm, side);
      const double reach = (shape.p_BS - grasp.p_BG).norm() + 0.5 * shape.size_m.norm();
      ScenePiece piece;
      piece.body = id;
      piece.carrier = ScenePiece::Carrier::kHand;
      piece.moves_with_robot = true;
      piece.is_exact = false;
      piece.hand = spec.carry_B.head<2>();
      piece.middle = shape.p_BS.head<2>() - grip.head<2>();
      piece.yaw_rad = shape.yaw_rad;
      const double carried = slack.parked_m + slack.drift_m + slack.lean_rad * reach;
      const double loose = carried + slack.held_m + slack.held_rad * reach;
      const double loose_z = carried + slack.held_height_m + state_->relief_m;
      piece.half_x = 0.5 * shape.size_m.x() + loose;
      piece.half_y = 0.5 * shape.size_m.y() + loose;
      piece.hand_radius_m = piece.hand.norm() + reach + (grip - grasp.p_BG).norm() + loose;
      const Bounds1 z =
          plus(state_->lift_m, base_z() + spec.carry_B.z() + shape.p_BS.z() - grasp.p_BG.z());
      const double half_z = 0.5 * shape.size_m.z();
      piece.bottom = widened(plus(z, -half_z), loose_z);
      piece.top = widened(plus(z, half_z), loose_z);
      pieces_.push_back(piece);
    }
  }
}

Eigen::Vector3d ProofScene::gripped_at(const GraspSpec& grasp, std::size_t arm, double side) const {
  const double off = 0.5 * spec_->mobile->arms[arm].opening_m - 0.5 * grasp.width_m;
  const Eigen::AngleAxisd turn(grasp.wrist_rad - base_yaw_rad(), Eigen::Vector3d::UnitZ());
  return grasp.p_BG - side * off * (turn * arms_[arm].pad_line_W);
}

double ProofScene::base_z() const {
  return layout_->bodies[*layout_->find_body(spec_->mobile->base_body)].p_WB.z();
}

double ProofScene::base_yaw_rad() const {
  return layout_->bodies[*layout_->find_body(spec_->mobile->base_body)].yaw_rad;
}

StartBox ProofScene::whole() const {
  StartBox box;
  for (const auto& [name, interval] : region_.dimensions) {
    if (interval.lower < interval.upper) box.push_back({interval.lower, interval.upper});
  }
  return box;
}

AffineForm ProofScene::variable(const std::string& name, std::span<const Bounds1> box,
                                double fallback) const {
  std::size_t index = 0;
  for (const auto& [variable, interval] : region_.dimensions) {
    const bool is_drawn = interval.lower < interval.upper;
    if (variable == name) {
      return is_drawn ? AffineForm::variable(index, box[index].lower, box[index].upper)
                      : AffineForm(interval.lower);
    }
    if (is_drawn) ++index;
  }
  return fallback;
}

ProofScene::Base ProofScene::base(std::span<const Bounds1> box) const {
  Base base;
  if (state_->base_at) {
    const auto& goal = *state_->base_at;
    base.x = AffineForm::within(goal.p.x(), goal.within_m + state_->slack.drift_m);
    base.y = AffineForm::within(goal.p.y(), goal.within_m + state_->slack.drift_m);
    base.yaw = AffineForm::within(goal.yaw_rad, goal.within_rad + state_->slack.drift_rad);
  } else {
    const BodySpec& body = layout_->bodies[*layout_->find_body(spec_->mobile->base_body)];
    base.x =
        variable("robot.x", box, body.p_WB.x()) + AffineForm::within(0.0, state_->slack.drift_m);
    base.y =
        variable("robot.y", box, body.p_WB.y()) + AffineForm::within(0.0, state_->slack.drift_m);
    base.yaw =
        variable("robot.yaw", box, body.yaw_rad) + AffineForm::within(0.0, state_->slack.drift_rad);
  }
  base.cosine = cosine(base.yaw);
  base.sine = sine(base.yaw);
  return base;
}

ProofScene::Point ProofScene::on_torso(const Eigen::Vector3d& p_B, const Base& base) const {
  const AffineForm px(p_B.x()), py(p_B.y());
  const Bounds1& lift = state_->lift_m;
  const double rise = 0.5 * (lift.lower + lift.upper);
  const double slack = 0.5 * (lift.upper - lift.lower) + state_->relief_m + state_->slack.drift_m;
  return {base.x + base.cosine * px - base.sine * py, base.y + base.sine * px + base.cosine * py,
          AffineForm(base_z() + p_B.z() + rise) + AffineForm::within(0.0, slack)};
}

ProofScene::Base ProofScene::free_body(BodyId id, std::span<const Bounds1> box) const {
  const BodySpec& body = layout_->bodies[id];
  const KnownBody& known = state_->bodies[id.index()];
  double move = state_->slack.drift_m, turn = state_->slack.drift_rad;
  Base at;
  at.x = variable(body.name + ".x", box, body.p_WB.x());
  at.y = variable(body.name + ".y", box, body.p_WB.y());
  if (known.carrier && !state_->is_start) {
    const Bounds1 q = state_->slider_m[known.carrier->index()];
    const Eigen::Vector3d axis = layout_->sliders[*known.carrier].axis_W.normalized();
    at.x += of({std::min(q.lower * axis.x(), q.upper * axis.x()),
                std::max(q.lower * axis.x(), q.upper * axis.x())});
    at.y += of({std::min(q.lower * axis.y(), q.upper * axis.y()),
                std::max(q.lower * axis.y(), q.upper * axis.y())});
    const bool moved = q.lower != 0.0 || q.upper != 0.0;
    if (moved) {
      move += state_->slack.sliding_m;
      turn += state_->slack.sliding_rad;
    }
  }
  at.x += AffineForm::within(0.0, move);
  at.y += AffineForm::within(0.0, move);
  at.yaw = variable(body.name + ".yaw", box, body.yaw_rad) + AffineForm::within(0.0, turn);
  at.cosine = cosine(at.yaw);
  at.sine = sine(at.yaw);
  return at;
}

Bounds1 ProofScene::free_height(BodyId id) const {
  const BodySpec& body = layout_->bodies[id];
  const StartBox all = whole();
  Bounds1 z = variable(body.name + ".z", all, body.p_WB.z()).bounds();
  for (const auto& dimension : region_.dimensions) {
    if (dimension.variable != body.name + ".bottom") continue;
    z = {dimension.interval.lower - lowest_m(body), dimension.interval.upper - lowest_m(body)};
  }
  return widened(z, state_->slack.drift_m);
}

UprightBox ProofScene::place(const ScenePiece& piece, std::span<const Bounds1> box,
                             const Base& base) const {
  UprightBox out;
  out.half_x = piece.half_x;
  out.half_y = piece.half_y;
  out.bottom = piece.bottom;
  out.top = piece.top;
  const AffineForm slack_x = AffineForm::within(0.0, piece.slack_m.x());
  const AffineForm slack_y = AffineForm::within(0.0, piece.slack_m.y());
  const AffineForm c(std::cos(piece.yaw_rad)), s(std::sin(piece.yaw_rad));
  const bool is_turned = piece.yaw_rad != 0.0;
  if (piece.carrier == ScenePiece::Carrier::kWorld ||
      piece.carrier == ScenePiece::Carrier::kSlider) {
    out.x = AffineForm(piece.middle.x()) + slack_x;
    out.y = AffineForm(piece.middle.y()) + slack_y;
    out.cosine = c;
    out.sine = s;
    return out;
  }
  const bool has_own = piece.carrier != ScenePiece::Carrier::kBase;
  Base own = has_own ? free_body(piece.body, box) : Base{};
  if (piece.carrier == ScenePiece::Carrier::kHand) {
    const AffineForm hx(piece.hand.x()), hy(piece.hand.y());
    own.x = base.x + base.cosine * hx - base.sine * hy;
    own.y = base.y + base.sine * hx + base.cosine * hy;
  }
  const Base& frame = has_own ? own : base;
  const AffineForm px(piece.middle.x()), py(piece.middle.y());
  out.x = frame.x + frame.cosine * px - frame.sine * py + slack_x;
  out.y = frame.y + frame.sine * px + frame.cosine * py + slack_y;
  out.cosine = is_turned ? frame.cosine * c - frame.sine * s : frame.cosine;
  out.sine = is_turned ? frame.sine * c + frame.cosine * s : frame.sine;
  return out;
}

}  // namespace parallax::harness
