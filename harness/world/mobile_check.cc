#include "harness/world/mobile_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/base/suggest.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {
namespace {

class MobileChecker {
 public:
  MobileChecker(const WorldSpec& spec, std::vector<WorldProblem>& problems)
      : spec_(spec), problems_(problems), layout_(lay_out(spec)) {}

  void run() {
    check_places();
    for (const BodySpec& body : spec_.bodies) {
      if (body.grasp) check_grasp(body);
    }
    for (const JointSpec& joint : spec_.joints) {
      if (joint.handle && joint.type != JointType::kSlider) {
        add("joints/" + joint.name + "/handle", "only sliders have handles");
      }
    }
    if (spec_.mobile) check_robot(*spec_.mobile);
  }

 private:
  void add(std::string path, std::string message, std::string suggestion = {}) {
    problems_.push_back({std::move(path), std::move(message), std::move(suggestion)});
  }
  void require(bool good, const std::string& path, const char* message) {
    if (!good) add(path, message);
  }

  template <typename List>
  void require_name(const std::string& path, const List& list, const char* kind,
                    const std::string& name) {
    std::vector<std::string> names;
    for (const auto& item : list) names.push_back(item.name);
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    add(path,
        name.empty() ? fmt::format("no {} is named", kind) : fmt::format("no {} `{}`", kind, name),
        base::nearest_name(name, names).value_or(""));
  }

  void check_places() {
    for (const PlaceSpec& place : spec_.places) {
      if (place.p_FP.cwiseAbs().maxCoeff() > kMaxExtent_m) {
        add("places/" + place.name + "/at_m",
            fmt::format("is more than {:g} m away", kMaxExtent_m));
      }
      if (!place.frame.empty()) {
        require_name("places/" + place.name + "/frame", spec_.bodies, "body", place.frame);
      }
    }
  }

  void check_grasp(const BodySpec& body) {
    const std::string path = "bodies/" + body.name + "/grasp";
    require(body.grasp->width_m > 0.0, path + "/width_m", "is not positive");
    require(body.grasp->effort_n > 0.0, path + "/effort_n", "is not positive");
    require(layout_.is_free[layout_.find_body(body.name)->index()], path,
            "only free bodies are grasped");
  }

  const JointSpec* joint(const std::string& name) const {
    const auto found = std::find_if(spec_.joints.begin(), spec_.joints.end(),
                                    [&](const JointSpec& one) { return one.name == name; });
    return found == spec_.joints.end() ? nullptr : &*found;
  }

  void require_joint(const std::string& path, const std::string& name, JointType type,
                     const char* kind) {
    require_name(path, spec_.joints, "joint", name);
    const JointSpec* found = joint(name);
    if (found == nullptr) return;
    if (found->type != type) add(path, fmt::format("`{}` is no {}", name, kind));
    if (found->max_force_n <= 0.0) {
      add(path, fmt::format("`{}` has no motor: max_force_n is 0", name));
    }
  }

  void check_robot(const MobileRobotSpec& robot) {
    require_joint("robot/base/joint", robot.base_joint, JointType::kGantry, "gantry");
    require_name("robot/base/body", spec_.bodies, "body", robot.base_body);
    if (!robot.torso_joint.empty()) {
      require_joint("robot/torso/joint", robot.torso_joint, JointType::kSlider, "slider");
    }
    require(robot.relief_wavelength_m > 0.0, "robot/base/relief_wavelength_m", "is not positive");
    require(robot.relief_amplitude_m >= 0.0, "robot/base/relief_amplitude_m", "is negative");
    check_camera(robot);
    require(!robot.arms.empty(), "robot/arms", "is empty");
    for (const ArmSpec& arm : robot.arms) check_arm(arm);
    if (!problems_.empty()) return;
    if (const JointSpec* base = joint(robot.base_joint)) {
      require(base->parent.empty(), "robot/base/joint", "does not hang on the world");
      require(base->child == robot.base_body, "robot/base/joint", "does not carry the base's body");
    }
    check_one_machine(robot);
  }

  void check_camera(const MobileRobotSpec& robot) {
    const CameraSpec& camera = robot.camera;
    const std::string path = "robot/camera/";
    require(camera.half_angle_rad > 0.0, path + "half_angle_rad", "is not positive");
    require(camera.half_angle_rad < 0.5 * std::numbers::pi, path + "half_angle_rad",
            "is a right angle or more: that is no cone");
    require(camera.min_range_m >= 0.0, path + "range_m", "is negative");
    require(camera.max_range_m > camera.min_range_m, path + "range_m", "is empty or reversed");
    require(camera.min_tilt_rad <= camera.max_tilt_rad, path + "tilt_rad", "is reversed");
    if (const auto base = layout_.find_body(robot.base_body)) {
      require(layout_.bodies[*base].p_WB.z() + camera.p_BC.z() > 0.0, path + "at_m",
              "is below the floor");
    }
  }

  void check_arm(const ArmSpec& arm) {
    const std::string path = "robot/arms/" + arm.name;
    require_joint(path + "/joint", arm.joint, JointType::kGantry, "gantry");
    require_joint(path + "/finger_joint", arm.finger_joint, JointType::kSlider, "slider");
    require_name(path + "/palm_body", spec_.bodies, "body", arm.palm_body);
    require_name(path + "/near_pad_body", spec_.bodies, "body", arm.near_pad_body);
    require_name(path + "/far_pad_body", spec_.bodies, "body", arm.far_pad_body);
    require(arm.opening_m > 0.0, path + "/opening_m", "is not positive");
    require(arm.grip_force_n > 0.0, path + "/grip_force_n", "is not positive");
    require(arm.max_reach_m > arm.min_reach_m && arm.min_reach_m >= 0.0, path + "/reach_m",
            "is empty");
    const double carried_m = (arm.carry_B - arm.p_BS).norm();
    require(carried_m >= arm.min_reach_m && carried_m <= arm.max_reach_m, path + "/carry_m",
            "is out of the arm's reach");
  }

  void check_one_machine(const MobileRobotSpec& robot) {
    const std::uint32_t base = assembly(robot.base_body);
    require(base != 0, "robot/base/body", "is fixed to the world");
    for (const ArmSpec& arm : robot.arms) {
      const std::string path = "robot/arms/" + arm.name;
      for (const std::string& body : {arm.palm_body, arm.near_pad_body, arm.far_pad_body}) {
        if (assembly(body) == base) continue;
        add(path, fmt::format("no joints lead from `{}` to `{}`", robot.base_body, body));
      }
      if (joint(arm.joint)->child != arm.palm_body) {
        add(path + "/joint", fmt::format("does not carry `{}`", arm.palm_body));
      }
      if (joint(arm.joint)->parent.empty()) add(path + "/joint", "does not hang on the robot");
    }
  }

  std::uint32_t assembly(const std::string& name) const {
    return layout_.assembly_of[layout_.find_body(name)->index()];
  }

  const WorldSpec& spec_;
  std::vector<WorldProblem>& problems_;
  WorldLayout layout_;
};

}  // namespace

void check_mobile(const WorldSpec& spec, std::vector<WorldProblem>& problems) {
  MobileChecker(spec, problems).run();
}

}  // namespace parallax::harness
