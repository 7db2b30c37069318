#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "harness/world/chain_arm.h"
#include "harness/world/structure_check.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {
namespace {

/// The tables in which the checks of both robots look things up.
class RoleChecker {
 protected:
  RoleChecker(const WorldSpec& spec, ProblemList& problems)
      : spec_(spec),
        problems_(problems),
        layout_(lay_out(spec)),
        body_names_(names_of(spec.bodies)),
        joint_names_(names_of(spec.joints)) {}

  void add(std::string path, std::string message) {
    problems_.add(std::move(path), std::move(message));
  }

  const JointSpec* joint_named(const std::string& name) const {
    const auto found = std::find_if(spec_.joints.begin(), spec_.joints.end(),
                                    [&](const JointSpec& one) { return one.name == name; });
    return found == spec_.joints.end() ? nullptr : &*found;
  }

  /// A squeeze is no stronger than the motor of the finger.
  void check_grip_force(const std::string& path, double force_n, const std::string& finger,
                        const std::string& near_pad) {
    const JointSpec* joint = joint_named(finger);
    if (joint == nullptr || joint->max_force_n <= 0.0) return;
    const double most = joint->max_force_n / grip_gain(layout_, finger, near_pad);
    if (force_n <= most) return;
    add(path, fmt::format("is {:g} N, more than the {:g} N (max_force_n) of `{}`", force_n, most,
                          finger));
  }

  std::uint32_t assembly(const std::string& body) const {
    return layout_.assembly_of[layout_.find_body(body)->index()];
  }

  const WorldSpec& spec_;
  ProblemList& problems_;
  WorldLayout layout_;
  std::vector<std::string> body_names_, joint_names_;
};

class LineRobotChecker final : RoleChecker {
 public:
  LineRobotChecker(const WorldSpec& spec, ProblemList& problems) : RoleChecker(spec, problems) {}

  void run() {
    const LineRobotSpec& robot = spec_.robot;
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();
    check_axis("base_joint", robot.base_joint, &x);
    check_axis("reach_joint", robot.reach_joint, &x);
    check_axis("lift_joint", robot.lift_joint, &z);
    check_axis("finger_joint", robot.finger_joint, nullptr);
    problems_.require_name("robot/base_body", body_names_, "body", robot.base_body);
    problems_.require_name("robot/near_pad_body", body_names_, "body", robot.near_pad_body);
    problems_.require_name("robot/far_pad_body", body_names_, "body", robot.far_pad_body);
    problems_.require_positive("robot/grip_force_n", robot.grip_force_n);
    check_grip_force("robot/grip_force_n", robot.grip_force_n, robot.finger_joint,
                     robot.near_pad_body);
    problems_.require_positive("robot/opening_m", robot.opening_m);
    if (problems_.empty()) check_one_machine();
  }

 private:
  void check_axis(const std::string& role, const std::string& name, const Eigen::Vector3d* axis) {
    const std::string path = "robot/" + role;
    problems_.require_name(path, joint_names_, "joint", name);
    const JointSpec* found = joint_named(name);
    if (found == nullptr) return;
    const JointSpec& joint = *found;
    if (joint.type != JointType::kSlider) add(path, "`" + name + "` is no slider");
    if (joint.max_force_n == 0.0) add(path, "`" + name + "` has no motor: max_force_n is 0");
    if (axis != nullptr && !joint.axis_W.normalized().isApprox(*axis, 1e-9)) {
      add(path, fmt::format("`{}` does not move along +{}", name, axis->z() > 0.5 ? 'z' : 'x'));
    }
    if (role == "lift_joint" && !joint.low_m) add(path, "`" + name + "` needs a lower stop");
  }

  /// The roles must belong to one machine, or the tool would not follow the axes.
  void check_one_machine() {
    const std::uint32_t robot = assembly(spec_.robot.base_body);
    if (robot == 0) add("robot/base_body", "is fixed to the world");
    for (const std::string& pad : {spec_.robot.near_pad_body, spec_.robot.far_pad_body}) {
      if (assembly(pad) != robot) {
        add("robot/base_body",
            "no joints lead from `" + spec_.robot.base_body + "` to `" + pad + "`");
      }
    }
  }
};

class MobileRobotChecker final : RoleChecker {
 public:
  MobileRobotChecker(const WorldSpec& spec, ProblemList& problems) : RoleChecker(spec, problems) {}

  void run(const MobileRobotSpec& robot) {
    require_joint("robot/base/joint", robot.base_joint, JointType::kGantry, "gantry");
    problems_.require_name("robot/base/body", body_names_, "body", robot.base_body);
    if (!robot.torso_joint.empty()) {
      require_joint("robot/torso/joint", robot.torso_joint, JointType::kSlider, "slider");
    }
    problems_.require(robot.relief_wavelength_m > 0.0, "robot/base/relief_wavelength_m",
                      "is not positive");
    problems_.require(robot.relief_amplitude_m >= 0.0, "robot/base/relief_amplitude_m",
                      "is negative");
    check_camera(robot);
    problems_.require(!robot.arms.empty(), "robot/arms", "is empty");
    for (const ArmSpec& arm : robot.arms) check_arm(arm);
    if (!problems_.empty()) return;
    if (const JointSpec* base = joint_named(robot.base_joint)) {
      problems_.require(base->parent.empty(), "robot/base/joint", "does not hang on the world");
      problems_.require(base->child == robot.base_body, "robot/base/joint",
                        "does not carry the base's body");
    }
    check_one_machine(robot);
    if (!problems_.empty()) return;
    for (const ArmSpec& arm : robot.arms) {
      if (!arm.chain.empty()) check_chain(spec_, layout_, arm, problems_);
    }
  }

 private:
  void require_joint(const std::string& path, const std::string& name, JointType type,
                     const char* kind) {
    problems_.require_name(path, joint_names_, "joint", name);
    const JointSpec* found = joint_named(name);
    if (found == nullptr) return;
    if (found->type != type) add(path, fmt::format("`{}` is no {}", name, kind));
    if (found->max_force_n <= 0.0) {
      add(path, fmt::format("`{}` has no motor: max_force_n is 0", name));
    }
  }

  void check_camera(const MobileRobotSpec& robot) {
    const CameraSpec& camera = robot.camera;
    const std::string path = "robot/camera/";
    problems_.require(camera.half_angle_rad > 0.0, path + "half_angle_rad", "is not positive");
    problems_.require(camera.half_angle_rad < 0.5 * std::numbers::pi, path + "half_angle_rad",
                      "is a right angle or more: that is no cone");
    problems_.require(camera.min_range_m >= 0.0, path + "range_m", "is negative");
    problems_.require(camera.max_range_m > camera.min_range_m, path + "range_m",
                      "is empty or reversed");
    problems_.require(camera.min_tilt_rad <= camera.max_tilt_rad, path + "tilt_rad", "is reversed");
    if (const auto base = layout_.find_body(robot.base_body)) {
      problems_.require(layout_.bodies[*base].p_WB.z() + camera.p_BC.z() > 0.0, path + "at_m",
                        "is below the floor");
    }
  }

  void check_arm(const ArmSpec& arm) {
    const std::string path = "robot/arms/" + arm.name;
    if (arm.chain.empty()) {
      require_joint(path + "/joint", arm.joint, JointType::kGantry, "gantry");
    }
    require_joint(path + "/finger_joint", arm.finger_joint, JointType::kSlider, "slider");
    problems_.require_name(path + "/palm_body", body_names_, "body", arm.palm_body);
    problems_.require_name(path + "/near_pad_body", body_names_, "body", arm.near_pad_body);
    problems_.require_name(path + "/far_pad_body", body_names_, "body", arm.far_pad_body);
    problems_.require(arm.opening_m > 0.0, path + "/opening_m", "is not positive");
    problems_.require(arm.grip_force_n > 0.0, path + "/grip_force_n", "is not positive");
    check_grip_force(path + "/grip_force_n", arm.grip_force_n, arm.finger_joint, arm.near_pad_body);
    if (!arm.chain.empty()) return;
    problems_.require(arm.max_reach_m > arm.min_reach_m && arm.min_reach_m >= 0.0,
                      path + "/reach_m", "is empty");
    const double carried_m = (arm.carry_B - arm.p_BS).norm();
    problems_.require(carried_m >= arm.min_reach_m && carried_m <= arm.max_reach_m,
                      path + "/carry_m", "is out of the arm's reach");
  }

  void check_one_machine(const MobileRobotSpec& robot) {
    const std::uint32_t base = assembly(robot.base_body);
    problems_.require(base != 0, "robot/base/body", "is fixed to the world");
    for (const ArmSpec& arm : robot.arms) {
      const std::string path = "robot/arms/" + arm.name;
      for (const std::string& body : {arm.palm_body, arm.near_pad_body, arm.far_pad_body}) {
        if (assembly(body) == base) continue;
        add(path, fmt::format("no joints lead from `{}` to `{}`", robot.base_body, body));
      }
      if (!arm.chain.empty()) continue;
      if (joint_named(arm.joint)->child != arm.palm_body) {
        add(path + "/joint", fmt::format("does not carry `{}`", arm.palm_body));
      }
      if (joint_named(arm.joint)->parent.empty())
        add(path + "/joint", "does not hang on the robot");
    }
  }
};

bool has_line_robot(const LineRobotSpec& r) {
  return !(r.base_joint.empty() && r.base_body.empty() && r.reach_joint.empty() &&
           r.lift_joint.empty() && r.finger_joint.empty() && r.near_pad_body.empty() &&
           r.far_pad_body.empty());
}

}  // namespace

void check_line_robot(const WorldSpec& spec, ProblemList& problems) {
  if (has_line_robot(spec.robot)) LineRobotChecker(spec, problems).run();
}

void check_mobile_robot(const WorldSpec& spec, ProblemList& problems) {
  if (spec.mobile) MobileRobotChecker(spec, problems).run(*spec.mobile);
}

}  // namespace parallax::harness
