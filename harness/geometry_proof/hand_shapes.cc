#include "harness/geometry_proof/hand_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "harness/engine/jaws.h"
#include "harness/engine/physics_world.h"
#include "harness/robot/detection_errors.h"
#include "harness/robot/mobile_robot.h"

namespace parallax::harness {
namespace {

constexpr double kTryEvery_m = 0.01;  // of the sweeps of PickUp::check_last_stretch

void add_heights(double way_m, std::vector<double>& heights_m) {
  const int steps = std::max(1, static_cast<int>(std::ceil(way_m / kTryEvery_m)));
  for (int i = 0; i <= steps; ++i) heights_m.push_back(way_m * i / steps);
}

}  // namespace

std::array<bool, 2> HandDescent::ways_round(const Bounds1& wrist) const {
  constexpr double kHalf = 0.5 * std::numbers::pi, kNear = 1e-9;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::array<bool, 2> ways = {false, false};
  if (wrist.upper - wrist.lower >= std::numbers::pi) return {true, true};
  const double shift = std::round(0.5 * (wrist.lower + wrist.upper) / kTurn) * kTurn;
  const double low = wrist.lower - shift, high = wrist.upper - shift;
  // Within a quarter turn it is taken as it is, else by half a circle less or more.
  for (const double turns : {-kTurn, 0.0, kTurn}) {
    if (high + turns > -kHalf - kNear && low + turns < kHalf + kNear) ways[0] = true;
    const double other_low = low + turns, other_high = high + turns;
    if (other_high > kHalf - kNear && other_low < 3.0 * kHalf + kNear) ways[1] = true;
  }
  return ways;
}

std::optional<HandDescent> descent_of(const ProofScene& scene, std::size_t arm, BodyId object,
                                      const Arguments& arguments) {
  const WorldLayout& layout = scene.layout();
  const auto& grasp = layout.bodies[object].grasp;
  const auto& look = scene.state().bodies[object.index()].look;
  if (!grasp || !grasp->from_above || !grasp->follows_body || !look) return std::nullopt;
  const ArmSpec& spec = scene.spec().mobile->arms[arm];
  const DetectionSpec& errors = scene.spec().mobile->camera.detection;
  const double clearance =
      std::min(arguments.number("clearance_m"), 0.5 * (spec.opening_m - grasp->width_m));
  const double opening = std::min(spec.opening_m, grasp->width_m + 2.0 * clearance);
  HandDescent out;
  out.object = object;
  out.wrist_rad = grasp->wrist_rad;
  out.clearance_m = arguments.number("clearance_m");
  out.seen = [&scene, object, look = *look](std::span<const Bounds1> box) {
    return sight_error(scene, box, object, look.points, look.needed);
  };
  out.error_m = kDetectionCut * (errors.bias_m + errors.noise_m);
  out.error_rad = kDetectionCut * (errors.bias_rad + errors.noise_rad) + kWristTolerance_rad;
  out.rise_m = std::max(arguments.number("standoff_m"), arguments.number("lift_m"));
  add_heights(arguments.number("standoff_m"), out.heights_m);
  add_heights(arguments.number("lift_m"), out.heights_m);

  const std::unique_ptr<const PhysicsWorld> owned = make_world(scene.spec());
  const PhysicsWorld& world = *owned;
  const Jaws jaws(spec, world);
  const ArmGeometry& hand = scene.arm(arm);
  const JointSpec& finger = layout.sliders[*layout.find_slider(spec.finger_joint)];
  const Eigen::Vector3d closing = jaws.finger_m(opening) * finger.axis_W.normalized();
  // The near pad keeps its clearance: the tool stands beside the grasp.
  const Eigen::Vector3d aside =
      -hand.pad_line_W * (0.5 * spec.opening_m - 0.5 * grasp->width_m - clearance);
  const Bounds1 height = scene.free_height(object);
  for (const BodyId id : hand.bodies) {
    const BodySpec& body = layout.bodies[id];
    if (!body.collides) continue;
    const bool is_far =
        layout.link_of[id.index()] == layout.link_of[layout.find_body(spec.far_pad_body)->index()];
    for (const BodyShape& shape : body.shapes) {
      const Probe placed = world.placed(id, shape);
      const Eigen::Vector3d from_tool =
          placed.p_WS - hand.tool_W + (is_far ? closing : Eigen::Vector3d::Zero());
      const double yaw = std::atan2(placed.R_WS(1, 0), placed.R_WS(0, 0));
      HandShape made;
      made.body = id;
      for (std::size_t way = 0; way < 2; ++way) {
        const double turn =
            grasp->wrist_rad - scene.base_yaw_rad() + (way == 0 ? 0.0 : std::numbers::pi);
        const Eigen::AngleAxisd R(turn, Eigen::Vector3d::UnitZ());
        ScenePiece& piece = made.turned[way];
        piece.body = id;
        piece.carrier = ScenePiece::Carrier::kBase;
        piece.middle = (grasp->p_BG + R * (aside + from_tool)).head<2>();
        piece.yaw_rad = yaw + turn;
        piece.half_x = 0.5 * shape.size_m.x();
        piece.half_y = 0.5 * shape.size_m.y();
        piece.slack_m.setConstant((is_far ? kFingerTolerance_m : 0.0) + kJointRoom_m);
      }
      const double z = grasp->p_BG.z() + from_tool.z(), half = 0.5 * shape.size_m.z();
      const double slack = kJointRoom_m;
      made.bottom = {height.lower + z - half - slack, height.upper + z - half + slack};
      made.top = {height.lower + z + half - slack, height.upper + z + half + slack};
      out.shapes.push_back(made);
    }
  }
  return out;
}

}  // namespace parallax::harness
