#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/config/world_sections.h"

namespace parallax::harness {
namespace {

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
  if (const auto values = fields.numbers(key, 2)) {
    low = (*values)[0];
    high = (*values)[1];
  }
}

CameraSpec read_camera(const YamlNode& node, base::DiagnosticSink& sink) {
  CameraSpec camera;
  YamlFields fields(node, key_text(Key::kCamera), sink);
  fields.only({Key::kAtM, Key::kHalfAngleRad, Key::kRangeM, Key::kMaxPanRad, Key::kTiltRad});
  fields.require(Key::kAtM);
  read_vector(fields, Key::kAtM, camera.p_BC);
  fields.number(Key::kHalfAngleRad, kPositive, camera.half_angle_rad);
  read_pair(fields, Key::kRangeM, camera.min_range_m, camera.max_range_m);
  fields.number(Key::kMaxPanRad, kPositive, camera.max_pan_rad);
  read_pair(fields, Key::kTiltRad, camera.min_tilt_rad, camera.max_tilt_rad);
  return camera;
}

ArmSpec read_arm(const YamlEntry& entry, base::DiagnosticSink& sink) {
  ArmSpec arm;
  arm.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the arm `{}`", entry.key), sink);
  fields.only({Key::kJoint, Key::kFingerJoint, Key::kPalmBody, Key::kNearPadBody, Key::kFarPadBody,
               Key::kShoulderM, Key::kReachM, Key::kCarryM, Key::kOpeningM, Key::kGripForceN});
  fields.text(Key::kJoint, arm.joint);
  fields.text(Key::kFingerJoint, arm.finger_joint);
  fields.text(Key::kPalmBody, arm.palm_body);
  fields.text(Key::kNearPadBody, arm.near_pad_body);
  fields.text(Key::kFarPadBody, arm.far_pad_body);
  fields.require(Key::kShoulderM);
  fields.require(Key::kCarryM);
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

void read_robot(const YamlNode& node, WorldSpec& world, base::DiagnosticSink& sink) {
  YamlFields fields(node, key_text(Key::kRobot), sink);
  if (const auto* arms = fields.find(Key::kArms)) {
    world.mobile = read_mobile_robot(fields, *arms, sink);
  } else {
    world.robot = read_line_robot(fields);
  }
}

}  // namespace parallax::harness
