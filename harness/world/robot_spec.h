#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace parallax::harness {

/// A robot on a line, by joint and body name. All empty: a world without one.
struct LineRobotSpec {
  std::string base_joint;    // drives along x
  std::string base_body;     // what "robot.x" reports
  std::string reach_joint;   // moves the tool along x relative to the base
  std::string lift_joint;    // moves the tool along z; position 0 is the carry height
  std::string finger_joint;  // the driven pad
  std::string near_pad_body, far_pad_body;
  double grip_force_n = 20.0;
  double opening_m = 0.09;  // between the pads' inner faces when open
};

/// An arm of a mobile robot: a gripper that hangs from a palm, and the palm on a gantry. Its reach
/// is that of the arm that the gantry stands for. Positions in the frame of the base, with the
/// torso at its lowest where the torso carries them.
struct ArmSpec {
  std::string name;
  std::string joint;         // gantry of the palm
  std::string finger_joint;  // slider of the far pad, along the palm's y
  std::string palm_body, near_pad_body, far_pad_body;
  Eigen::Vector3d p_BS = Eigen::Vector3d::Zero();     // shoulder [m]
  double min_reach_m = 0.25, max_reach_m = 0.95;      // of the tool from the shoulder
  Eigen::Vector3d carry_B = Eigen::Vector3d::Zero();  // tool when parked [m]
  double opening_m = 0.09;                            // between the pads' inner faces when open
  double grip_force_n = 20.0;                         // of grasps that name no effort
};

struct CameraSpec {
  Eigen::Vector3d p_BC = Eigen::Vector3d::Zero();  // in the base frame, torso at its lowest [m]
  double half_angle_rad = 0.2;
  double min_range_m = 0.3, max_range_m = 2.5;
  double max_pan_rad = 2.8;
  double min_tilt_rad = -0.4, max_tilt_rad = 1.3;  // positive looks down
};

/// A base that drives and turns in the plane, an optional lifting torso, arms and a camera.
struct MobileRobotSpec {
  std::string base_joint;           // gantry, parent world
  std::string base_body;            // what "robot.x" reports
  std::string torso_joint;          // slider along z, or empty
  double relief_amplitude_m = 0.0;  // of the floor under the wheels: a sine over the way driven
  double relief_wavelength_m = 0.1;
  CameraSpec camera;
  std::vector<ArmSpec> arms;  // sorted by name
};

}  // namespace parallax::harness
