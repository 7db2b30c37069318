#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/import/mesh.h"
#include "harness/world/shapes.h"

namespace parallax::harness {

namespace {

/// [m, rad]; what is farther off was not detected.
constexpr NumberBounds kDetectionError{0.0, 0.5, false, false};
constexpr NumberBounds kUnit{0.0, 1.0, false, false};

struct RoundForm {
  std::string_view key;
  ShapeForm form;
};
constexpr std::array<RoundForm, 3> kRoundForms = {{{Key::kSphere, ShapeForm::kSphere},
                                                   {Key::kCylinder, ShapeForm::kCylinder},
                                                   {Key::kCapsule, ShapeForm::kCapsule}}};

void read_round(const YamlNode& node, const RoundForm& round, BodyShape& shape,
                base::DiagnosticSink& sink) {
  YamlFields fields(node, key_text(round.key), sink);
  double radius_m = 0.0, length_m = 0.0;
  fields.only({Key::kRadiusM, round.form == ShapeForm::kSphere ? Key::kRadiusM : Key::kLengthM});
  fields.require(Key::kRadiusM);
  fields.number(Key::kRadiusM, kPositive, radius_m);
  if (round.form != ShapeForm::kSphere) {
    fields.require(Key::kLengthM);
    fields.number(Key::kLengthM, kPositive, length_m);
  }
  shape.form = round.form;
  shape.size_m = round_size_m(round.form, radius_m, length_m);
}

/// Corners, whose convex hull is the shape. Its place is where the middle of the box round it is.
void read_hull(const YamlNode& node, BodyShape& shape, base::DiagnosticSink& sink) {
  const auto fault = [&](const YamlNode& at, const std::string& text) {
    sink.error(codes::kBadImport, at.range, text);
  };
  if (!node.is_list() || node.items.size() < 4 || node.items.size() > kMaxHullVertices) {
    return fault(node,
                 fmt::format("`{}` is no list of 4 to {} corners", Key::kHull, kMaxHullVertices));
  }
  std::vector<Eigen::Vector3d> corners;
  for (const auto& item : node.items) {
    if (!item.is_list() || item.items.size() != 3) {
      return fault(item, fmt::format("a corner of `{}` is no list of three numbers", Key::kHull));
    }
    Eigen::Vector3d corner;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto x = read_number(item.items[i], key_text(Key::kHull), kAnyNumber, sink);
      if (!x) return;
      corner[static_cast<Eigen::Index>(i)] = *x;
    }
    corners.push_back(corner);
  }
  if (!reads_meshes()) {
    sink.error(codes::kImportUnavailable, node.range, Key::kHull, "libassimp-dev and libqhull-dev");
    return;
  }
  const MadeHull made = hull_of(corners);
  if (made.fault) return fault(node, "the hull " + *made.fault);
  shape.form = ShapeForm::kHull;
  shape.size_m = made.hull->size_m;
  shape.p_BS = made.middle;
  shape.hull = made.hull;
}

/// The one form that is given: a box by its `size_m`, a hull, or something round.
void read_form(const YamlFields& fields, BodyShape& shape) {
  const RoundForm* form = nullptr;
  bool taken = fields.find(Key::kSizeM) != nullptr;
  for (const RoundForm& round : kRoundForms) {
    const auto* node = fields.find(round.key);
    if (node == nullptr) continue;
    if (taken) {
      fields.sink()
          .error(codes::kUnknownKey, node->range, round.key,
                 fields.what() + ", which has another form already")
          .help("Remove one of the two.");
      return;
    }
    taken = true;
    form = &round;
  }
  if (const auto* hull = fields.find(Key::kHull)) {
    if (!taken) return read_hull(*hull, shape, fields.sink());
    fields.sink()
        .error(codes::kUnknownKey, hull->range, Key::kHull,
               fields.what() + ", which has another form already")
        .help("Remove one of the two.");
    return;
  }
  if (form != nullptr) {
    read_round(*fields.find(form->key), *form, shape, fields.sink());
  } else if (fields.require(Key::kSizeM) != nullptr) {
    read_vector(fields, Key::kSizeM, shape.size_m);
  }
}

BodyShape read_shape(const YamlNode& node, std::string what, base::DiagnosticSink& sink) {
  BodyShape shape;
  YamlFields fields(node, std::move(what), sink);
  fields.only({Key::kSizeM, Key::kSphere, Key::kCylinder, Key::kCapsule, Key::kHull, Key::kAtM,
               Key::kYawRad, Key::kPitchRad, Key::kRollRad});
  read_form(fields, shape);
  const Eigen::Vector3d middle = shape.p_BS;
  shape.p_BS = Eigen::Vector3d::Zero();
  read_vector(fields, Key::kAtM, shape.p_BS);
  fields.angle(Key::kYawRad, shape.yaw_rad);
  fields.angle(Key::kPitchRad, shape.pitch_rad);
  fields.angle(Key::kRollRad, shape.roll_rad);
  if (shape.form == ShapeForm::kHull) shape.p_BS += shape_rotation(shape) * middle;
  return shape;
}

InertiaSpec read_inertia(const YamlNode& node, std::string what, base::DiagnosticSink& sink) {
  InertiaSpec inertia;
  YamlFields fields(node, std::move(what), sink);
  fields.only({Key::kCentreM, Key::kMomentsKgM2});
  fields.require(Key::kMomentsKgM2);
  read_vector(fields, Key::kCentreM, inertia.p_BC);
  if (const auto six = fields.numbers(Key::kMomentsKgM2, 6)) {
    const auto& [xx, yy, zz] = std::tie((*six)[0], (*six)[1], (*six)[2]);
    const auto& [xy, xz, yz] = std::tie((*six)[3], (*six)[4], (*six)[5]);
    inertia.I_C_kg_m2 << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  }
  return inertia;
}

/// A bowl: a bottom and a ring of walls, its origin in the middle of its height.
void read_ring(const YamlNode& node, BodySpec& body, base::DiagnosticSink& sink) {
  YamlFields fields(node, fmt::format("`{}` of the body `{}`", Key::kRing, body.name), sink);
  fields.only({Key::kDiameterM, Key::kHeightM, Key::kWallM, Key::kSides});
  double diameter_m = 0.0, height_m = 0.0, wall_m = 0.0;
  std::int64_t sides = 12;
  for (const auto key : {Key::kDiameterM, Key::kHeightM, Key::kWallM}) fields.require(key);
  fields.number(Key::kDiameterM, kPositive, diameter_m);
  fields.number(Key::kHeightM, kPositive, height_m);
  fields.number(Key::kWallM, kPositive, wall_m);
  fields.integer(Key::kSides, 4, 64, sides);
  if (!(diameter_m > 2.0 * wall_m && height_m > wall_m)) {
    sink.error(codes::kYamlOutOfBounds, node.range, fields.what(), "all wall",
               "wider and higher than its walls");
    return;
  }
  const double radius_m = 0.5 * (diameter_m - wall_m);
  const auto count = static_cast<double>(sides);
  const double length_m = 2.0 * 0.5 * diameter_m * std::tan(std::numbers::pi / count);
  const double bottom_m = diameter_m * std::numbers::sqrt2 / 2.0 - wall_m;
  body.shapes.push_back(
      {{bottom_m, bottom_m, wall_m}, {0.0, 0.0, -0.5 * (height_m - wall_m)}, 0.0});
  for (std::int64_t side = 0; side < sides; ++side) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(side) / count;
    body.shapes.push_back({{wall_m, length_m, height_m},
                           {radius_m * std::cos(angle), radius_m * std::sin(angle), 0.0},
                           angle});
  }
}

/// One shape, or a list of them under `shapes`, or a ring of boxes.
void read_shapes(const YamlFields& fields, BodySpec& body) {
  const auto* list = fields.find(Key::kShapes);
  const auto* ring = fields.find(Key::kRing);
  if (list == nullptr && ring == nullptr) {
    read_form(fields, body.shapes.emplace_back());
    return;
  }
  for (const auto other : {Key::kSizeM, Key::kSphere, Key::kCylinder, Key::kCapsule, Key::kHull,
                           list != nullptr ? Key::kRing : Key::kSizeM}) {
    const auto* extra = fields.find(other);
    if (extra == nullptr) continue;
    fields.sink()
        .error(codes::kUnknownKey, extra->range, other,
               fmt::format("{}, which has `{}` or `{}`", fields.what(), Key::kShapes, Key::kRing))
        .help("Remove one of the two.");
    return;
  }
  if (ring != nullptr) {
    read_ring(*ring, body, fields.sink());
    return;
  }
  if (!list->is_list()) {
    fields.sink().error(codes::kWrongYamlKind, list->range, key_text(Key::kShapes), describe(*list),
                        "a list of shapes");
    return;
  }
  for (const auto& item : list->items) {
    body.shapes.push_back(read_shape(item, "a shape of " + fields.what(), fields.sink()));
  }
}

GraspSpec read_grasp(const YamlNode& node, std::string what, base::DiagnosticSink& sink) {
  static constexpr std::array<std::string_view, 2> kFrames = {"robot", "body"};
  static constexpr std::array<std::string_view, 2> kApproaches = {"level", "above"};
  GraspSpec grasp;
  YamlFields fields(node, std::move(what), sink);
  fields.only(
      {Key::kAtM, Key::kFrame, Key::kWristRad, Key::kApproach, Key::kWidthM, Key::kEffortN});
  fields.require(Key::kWidthM);
  read_vector(fields, Key::kAtM, grasp.p_BG);
  if (const auto frame =
          fields.choice(Key::kFrame, "frame of a grasp", kFrames, grasp.follows_body ? 1 : 0)) {
    grasp.follows_body = *frame == 1;
  }
  grasp.from_above =
      fields.choice(Key::kApproach, "approach of a grasp", kApproaches, 0) == std::size_t{1};
  fields.angle(Key::kWristRad, grasp.wrist_rad);
  fields.number(Key::kWidthM, kPositive, grasp.width_m);
  fields.number(Key::kEffortN, kPositive, grasp.effort_n);
  return grasp;
}

LineRobotSpec read_line_robot(YamlFields& fields) {
  LineRobotSpec robot;
  fields.only({Key::kBaseJoint, Key::kBaseBody, Key::kReachJoint, Key::kLiftJoint,
               Key::kFingerJoint, Key::kNearPadBody, Key::kFarPadBody, Key::kGripForceN,
               Key::kOpeningM});
  fields.text(Key::kBaseJoint, robot.base_joint);
  fields.text(Key::kBaseBody, robot.base_body);
  fields.text(Key::kReachJoint, robot.reach_joint);
  fields.text(Key::kLiftJoint, robot.lift_joint);
  fields.text(Key::kFingerJoint, robot.finger_joint);
  fields.text(Key::kNearPadBody, robot.near_pad_body);
  fields.text(Key::kFarPadBody, robot.far_pad_body);
  fields.number(Key::kGripForceN, kNotNegative, robot.grip_force_n);
  fields.number(Key::kOpeningM, kPositive, robot.opening_m);
  return robot;
}

void read_pair(const YamlFields& fields, std::string_view key, double& low, double& high) {
  ReadLog::fallback(fields.node(), key, std::array{low, high});
  if (const auto values = fields.numbers(key, 2)) {
    low = (*values)[0];
    high = (*values)[1];
  }
}

DetectionSpec read_detection(const YamlNode& node, base::DiagnosticSink& sink) {
  DetectionSpec detection;
  YamlFields fields(node, key_text(Key::kDetection), sink);
  fields.may_be_absent();
  fields.only({Key::kBiasM, Key::kBiasRad, Key::kNoiseM, Key::kNoiseRad, Key::kMissRate,
               Key::kConfusionRate});
  fields.number(Key::kBiasM, kDetectionError, detection.bias_m);
  fields.number(Key::kBiasRad, kDetectionError, detection.bias_rad);
  fields.number(Key::kNoiseM, kDetectionError, detection.noise_m);
  fields.number(Key::kNoiseRad, kDetectionError, detection.noise_rad);
  fields.number(Key::kMissRate, kUnit, detection.miss_rate);
  fields.number(Key::kConfusionRate, kUnit, detection.confusion_rate);
  return detection;
}

CameraSpec read_camera(const YamlNode& node, base::DiagnosticSink& sink) {
  CameraSpec camera;
  YamlFields fields(node, key_text(Key::kCamera), sink);
  fields.only({Key::kAtM, Key::kHalfAngleRad, Key::kRangeM, Key::kMaxPanRad, Key::kTiltRad,
               Key::kDetection});
  fields.require(Key::kAtM);
  read_vector(fields, Key::kAtM, camera.p_BC);
  fields.number(Key::kHalfAngleRad, kPositive, camera.half_angle_rad);
  read_pair(fields, Key::kRangeM, camera.min_range_m, camera.max_range_m);
  fields.number(Key::kMaxPanRad, kPositive, camera.max_pan_rad);
  read_pair(fields, Key::kTiltRad, camera.min_tilt_rad, camera.max_tilt_rad);
  for (const auto& [key, angles] :
       {std::pair{Key::kMaxPanRad, Interval{camera.max_pan_rad, camera.max_pan_rad}},
        std::pair{Key::kTiltRad, Interval{camera.min_tilt_rad, camera.max_tilt_rad}}}) {
    const auto* written = fields.find(key);
    if (written != nullptr) (void)check_radians(angles, *written, key_text(key), fields.sink());
  }
  if (const auto* detection = fields.find(Key::kDetection)) {
    camera.detection = read_detection(*detection, sink);
  }
  return camera;
}

/// Keys of an arm on a gantry that say nothing of a chain.
void refuse_of_gantries(const YamlFields& fields) {
  for (const auto key : {Key::kJoint, Key::kShoulderM, Key::kReachM}) {
    const auto* node = fields.find(key);
    if (node == nullptr) continue;
    fields.sink()
        .error(codes::kUnknownKey, node->range, key,
               fmt::format("{}, which has `{}`", fields.what(), Key::kChain))
        .help("Remove it: it says nothing of a chain.");
  }
}

ArmSpec read_arm(const YamlEntry& entry, base::DiagnosticSink& sink) {
  ArmSpec arm;
  arm.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the arm `{}`", entry.key), sink);
  fields.only({Key::kJoint, Key::kChain, Key::kFingerJoint, Key::kPalmBody, Key::kNearPadBody,
               Key::kFarPadBody, Key::kShoulderM, Key::kReachM, Key::kCarryM, Key::kOpeningM,
               Key::kGripForceN});
  fields.text(Key::kJoint, arm.joint);
  fields.texts(Key::kChain, arm.chain);
  const bool is_chain = fields.find(Key::kChain) != nullptr;
  if (is_chain) refuse_of_gantries(fields);
  fields.text(Key::kFingerJoint, arm.finger_joint);
  fields.text(Key::kPalmBody, arm.palm_body);
  fields.text(Key::kNearPadBody, arm.near_pad_body);
  fields.text(Key::kFarPadBody, arm.far_pad_body);
  if (is_chain) {
    // Values that follow from the joints are filled in when all joints have been read.
    arm.carry_B.setConstant(std::numeric_limits<double>::quiet_NaN());
  } else {
    fields.require(Key::kShoulderM);
    fields.require(Key::kCarryM);
  }
  read_vector(fields, Key::kShoulderM, arm.p_BS);
  read_vector(fields, Key::kCarryM, arm.carry_B);
  read_pair(fields, Key::kReachM, arm.min_reach_m, arm.max_reach_m);
  fields.number(Key::kOpeningM, kPositive, arm.opening_m);
  fields.number(Key::kGripForceN, kPositive, arm.grip_force_n);
  return arm;
}

MobileRobotSpec read_mobile_robot(YamlFields& fields, const YamlNode& arms,
                                  base::DiagnosticSink& sink) {
  MobileRobotSpec robot;
  fields.only({Key::kBase, Key::kTorso, Key::kCamera, Key::kArms});
  if (const auto* base = fields.require(Key::kBase)) {
    YamlFields inner(*base, key_text(Key::kBase), sink);
    inner.only({Key::kJoint, Key::kBody, Key::kReliefAmplitudeM, Key::kReliefWavelengthM});
    inner.text(Key::kJoint, robot.base_joint);
    inner.text(Key::kBody, robot.base_body);
    inner.number(Key::kReliefAmplitudeM, kNotNegative, robot.relief_amplitude_m);
    inner.number(Key::kReliefWavelengthM, kPositive, robot.relief_wavelength_m);
  }
  if (const auto* torso = fields.find(Key::kTorso)) {
    YamlFields inner(*torso, key_text(Key::kTorso), sink);
    inner.only({Key::kJoint});
    inner.text(Key::kJoint, robot.torso_joint);
  }
  if (const auto* camera = fields.require(Key::kCamera)) robot.camera = read_camera(*camera, sink);
  const YamlFields all(arms, key_text(Key::kArms), sink);
  for (const auto& entry : arms.entries) robot.arms.push_back(read_arm(entry, sink));
  std::sort(robot.arms.begin(), robot.arms.end(),
            [](const ArmSpec& a, const ArmSpec& b) { return a.name < b.name; });
  return robot;
}

}  // namespace

void read_vector(const YamlFields& fields, std::string_view key, Eigen::Vector3d& out) {
  ReadLog::fallback(fields.node(), key, std::array{out.x(), out.y(), out.z()});
  if (const auto values = fields.numbers(key, 3)) {
    out = Eigen::Vector3d((*values)[0], (*values)[1], (*values)[2]);
  }
}

BodySpec read_body(const YamlEntry& entry, base::DiagnosticSink& sink) {
  BodySpec body;
  body.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the body `{}`", entry.key), sink);
  fields.only({Key::kSizeM, Key::kSphere, Key::kCylinder, Key::kCapsule, Key::kHull, Key::kShapes,
               Key::kRing, Key::kMassKg, Key::kInertia, Key::kMaterial, Key::kPositionM,
               Key::kYawRad, Key::kGravity, Key::kCollides, Key::kApart, Key::kSettable, Key::kKind,
               Key::kGrasp});
  read_shapes(fields, body);
  fields.number(Key::kMassKg, kNotNegative, body.mass_kg);
  fields.text(Key::kMaterial, body.material);
  read_vector(fields, Key::kPositionM, body.p_WB);
  fields.angle(Key::kYawRad, body.yaw_rad);
  fields.boolean(Key::kGravity, body.gravity);
  fields.boolean(Key::kCollides, body.collides);
  fields.text(Key::kApart, body.apart);
  if (const auto* inertia = fields.find(Key::kInertia)) {
    body.inertia = read_inertia(
        *inertia, fmt::format("`{}` of the body `{}`", Key::kInertia, entry.key), sink);
  }
  fields.texts(Key::kSettable, body.settable);
  fields.text(Key::kKind, body.kind);
  if (const auto* grasp = fields.find(Key::kGrasp)) {
    body.grasp =
        read_grasp(*grasp, fmt::format("`{}` of the body `{}`", Key::kGrasp, entry.key), sink);
  }
  return body;
}

HandleSpec read_handle(const YamlNode& node, base::DiagnosticSink& sink) {
  HandleSpec handle;
  YamlFields fields(node, key_text(Key::kHandle), sink);
  fields.only({Key::kAtM, Key::kApproach, Key::kWristRad, Key::kWidthM});
  fields.require(Key::kAtM);
  read_vector(fields, Key::kAtM, handle.p_CH);
  read_vector(fields, Key::kApproach, handle.approach);
  fields.angle(Key::kWristRad, handle.wrist_rad);
  fields.number(Key::kWidthM, kPositive, handle.width_m);
  if (handle.approach.norm() < 1e-9) {
    sink.error(codes::kYamlOutOfBounds, node.range, key_text(Key::kApproach), "without a direction",
               "a vector with a length");
  }
  return handle;
}

PlaceSpec read_place(const YamlEntry& entry, base::DiagnosticSink& sink) {
  PlaceSpec place;
  place.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the place `{}`", entry.key), sink);
  fields.only({Key::kFrame, Key::kAtM, Key::kYawRad});
  fields.require(Key::kAtM);
  fields.text(Key::kFrame, place.frame);
  read_vector(fields, Key::kAtM, place.p_FP);
  fields.angle(Key::kYawRad, place.yaw_rad);
  return place;
}

void read_robot(const YamlNode& node, WorldSpec& world, base::DiagnosticSink& sink) {
  YamlFields fields(node, key_text(Key::kRobot), sink);
  if (const auto* arms = fields.find(Key::kArms)) {
    world.mobile = read_mobile_robot(fields, *arms, sink);
  } else {
    world.robot = read_line_robot(fields);
  }
}

}  // namespace parallax::harness
