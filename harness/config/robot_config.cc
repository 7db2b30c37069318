#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "harness/config/world_sections.h"

namespace parallax::harness {
namespace {

LineRobotSpec read_line_robot(YamlFields& fields) {
  LineRobotSpec robot;
  fields.only({"base_joint", "base_body", "reach_joint", "lift_joint", "finger_joint",
               "near_pad_body", "far_pad_body", "grip_force_n", "opening_m"});
  fields.text("base_joint", robot.base_joint);
  fields.text("base_body", robot.base_body);
  fields.text("reach_joint", robot.reach_joint);
  fields.text("lift_joint", robot.lift_joint);
  fields.text("finger_joint", robot.finger_joint);
  fields.text("near_pad_body", robot.near_pad_body);
  fields.text("far_pad_body", robot.far_pad_body);
  fields.number("grip_force_n", kNotNegative, robot.grip_force_n);
  fields.number("opening_m", kPositive, robot.opening_m);
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
  YamlFields fields(node, "`camera`", sink);
  fields.only({"at_m", "half_angle_rad", "range_m", "max_pan_rad", "tilt_rad"});
  fields.require("at_m");
  read_vector(fields, "at_m", camera.p_BC);
  fields.number("half_angle_rad", kPositive, camera.half_angle_rad);
  read_pair(fields, "range_m", camera.min_range_m, camera.max_range_m);
  fields.number("max_pan_rad", kPositive, camera.max_pan_rad);
  read_pair(fields, "tilt_rad", camera.min_tilt_rad, camera.max_tilt_rad);
  return camera;
}

ArmSpec read_arm(const YamlEntry& entry, base::DiagnosticSink& sink) {
  ArmSpec arm;
  arm.name = entry.key;
  YamlFields fields(entry.value, fmt::format("the arm `{}`", entry.key), sink);
  fields.only({"joint", "finger_joint", "palm_body", "near_pad_body", "far_pad_body", "shoulder_m",
               "reach_m", "carry_m", "opening_m", "grip_force_n"});
  fields.text("joint", arm.joint);
  fields.text("finger_joint", arm.finger_joint);
  fields.text("palm_body", arm.palm_body);
  fields.text("near_pad_body", arm.near_pad_body);
  fields.text("far_pad_body", arm.far_pad_body);
  fields.require("shoulder_m");
  fields.require("carry_m");
  read_vector(fields, "shoulder_m", arm.p_BS);
  read_vector(fields, "carry_m", arm.carry_B);
  read_pair(fields, "reach_m", arm.min_reach_m, arm.max_reach_m);
  fields.number("opening_m", kPositive, arm.opening_m);
  fields.number("grip_force_n", kPositive, arm.grip_force_n);
  return arm;
}

MobileRobotSpec read_mobile_robot(YamlFields& fields, const YamlNode& arms,
                                  base::DiagnosticSink& sink) {
  MobileRobotSpec robot;
  fields.only({"base", "torso", "camera", "arms"});
  if (const auto* base = fields.require("base")) {
    YamlFields inner(*base, "`base`", sink);
    inner.only({"joint", "body", "relief_amplitude_m", "relief_wavelength_m"});
    inner.text("joint", robot.base_joint);
    inner.text("body", robot.base_body);
    inner.number("relief_amplitude_m", kNotNegative, robot.relief_amplitude_m);
    inner.number("relief_wavelength_m", kPositive, robot.relief_wavelength_m);
  }
  if (const auto* torso = fields.find("torso")) {
    YamlFields inner(*torso, "`torso`", sink);
    inner.only({"joint"});
    inner.text("joint", robot.torso_joint);
  }
  if (const auto* camera = fields.require("camera")) robot.camera = read_camera(*camera, sink);
  const YamlFields all(arms, "`arms`", sink);
  for (const auto& entry : arms.entries) robot.arms.push_back(read_arm(entry, sink));
  std::sort(robot.arms.begin(), robot.arms.end(),
            [](const ArmSpec& a, const ArmSpec& b) { return a.name < b.name; });
  return robot;
}

}  // namespace

void read_robot(const YamlNode& node, WorldSpec& world, base::DiagnosticSink& sink) {
  YamlFields fields(node, "`robot`", sink);
  if (const auto* arms = fields.find("arms")) {
    world.mobile = read_mobile_robot(fields, *arms, sink);
  } else {
    world.robot = read_line_robot(fields);
  }
}

}  // namespace parallax::harness
