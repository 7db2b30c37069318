#include "harness/world/structure_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "compiler/base/suggest.h"
#include "harness/world/mobile_check.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {
namespace {

const std::array<std::string, 6> kSettable = {"bottom", "mass", "x", "y", "yaw", "z"};

class StructureChecker {
 public:
  explicit StructureChecker(const WorldSpec& spec) : spec_(spec) {
    for (const BodySpec& body : spec.bodies) body_names_.push_back(body.name);
    for (const JointSpec& joint : spec.joints) joint_names_.push_back(joint.name);
  }

  std::vector<WorldProblem> run() {
    check_solver(spec_.solver, problems_);
    check_friction();
    for (const BodySpec& body : spec_.bodies) check_body(body);
    for (const JointSpec& joint : spec_.joints) check_joint(joint);
    check_unique("bodies", body_names_);
    check_unique("joints", joint_names_);
    check_children();
    if (problems_.empty() && has_robot()) check_robot();
    if (problems_.empty()) check_mobile(spec_, problems_);
    return std::move(problems_);
  }

 private:
  void add(std::string path, std::string message, std::string suggestion = {}) {
    problems_.push_back({std::move(path), std::move(message), std::move(suggestion)});
  }

  void require_positive(const std::string& path, double value) {
    if (!(value > 0.0) || !std::isfinite(value)) add(path, "is not a positive number");
  }
  void require_not_negative(const std::string& path, double value) {
    if (!(value >= 0.0) || !std::isfinite(value)) add(path, "is negative or not a number");
  }

  void require_name(const std::string& path, const std::vector<std::string>& names,
                    const std::string& kind, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) != names.end()) return;
    add(path, name.empty() ? "no " + kind + " is named" : "no " + kind + " `" + name + "`",
        base::nearest_name(name, names).value_or(""));
  }

  void check_unique(const std::string& path, const std::vector<std::string>& names) {
    std::set<std::string> seen;
    for (const std::string& name : names) {
      if (name.empty()) add(path, "a name is empty");
      if (!seen.insert(name).second) add(path + "/" + name, "the name is used twice");
    }
  }

  void check_friction() {
    std::vector<std::string> materials = {spec_.floor_material};
    for (const BodySpec& body : spec_.bodies) materials.push_back(body.material);
    require_not_negative("friction/fallback", spec_.friction.fallback);
    for (const auto& [pair, mu] : spec_.friction.pairs) {
      const std::string path = "friction/pairs/" + pair.first + "," + pair.second;
      require_not_negative(path, mu);
      if (pair.second < pair.first) add(path, "the two materials are not in order");
      require_name(path, materials, "body of material", pair.first);
      require_name(path, materials, "body of material", pair.second);
    }
  }

  void check_body(const BodySpec& body) {
    const std::string path = "bodies/" + body.name;
    if (body.name == "floor") add(path, "the floor is built in");
    for (const char* reserved : {"robot", "tool"}) {
      if (body.name == reserved && !is_base(body)) {
        add(path, "the name is kept for the robot's own variables");
      }
    }
    require_not_negative(path + "/mass_kg", body.mass_kg);
    if (body.mass_kg > kMaxMass_kg) {
      add(path + "/mass_kg", fmt::format("is more than {:g} kg", kMaxMass_kg));
    }
    if (body.shapes.empty()) add(path + "/shapes", "is empty");
    for (const BoxShape& shape : body.shapes) {
      if (!(shape.size_m.array() > 0.0).all() || !shape.size_m.allFinite()) {
        add(path + "/shapes", "a size is not positive");
      }
      if (!shape.p_BS.allFinite()) add(path + "/shapes", "a position is not a number");
    }
    if (!body.p_WB.allFinite() || !std::isfinite(body.yaw_rad)) {
      add(path, "the placement is not a number");
    }
    check_extent(body);
    check_settable(body);
  }

  void check_extent(const BodySpec& body) {
    const auto is_far = [](const Eigen::Vector3d& v) {
      return v.cwiseAbs().maxCoeff() > kMaxExtent_m;
    };
    const std::string path = "bodies/" + body.name;
    if (is_far(body.p_WB)) {
      add(path + "/position_m", fmt::format("is more than {:g} m away", kMaxExtent_m));
    }
    const bool huge = std::any_of(
        body.shapes.begin(), body.shapes.end(),
        [&](const BoxShape& shape) { return is_far(shape.size_m) || is_far(shape.p_BS); });
    if (huge)
      add(path + "/shapes", fmt::format("a box is larger or farther than {:g} m", kMaxExtent_m));
  }

  bool is_base(const BodySpec& body) const {
    return body.name == base_body(spec_) && !body.name.empty();
  }

  bool is_jointed(const BodySpec& body) const {
    return std::any_of(spec_.joints.begin(), spec_.joints.end(), [&](const JointSpec& joint) {
      return joint.parent == body.name || joint.child == body.name;
    });
  }

  void check_settable(const BodySpec& body) {
    const std::string path = "bodies/" + body.name + "/settable";
    for (const std::string& item : body.settable) {
      if (std::find(kSettable.begin(), kSettable.end(), item) == kSettable.end()) {
        add(path, "`" + item + "` is none of x, y, z, yaw, bottom, mass",
            base::nearest_name(item, kSettable, 1).value_or(""));
      } else if (is_base(body)) {
        const bool planar = spec_.mobile && (item == "y" || item == "yaw");
        if (item != "x" && !planar) {
          add(path, fmt::format("the robot's base takes {} only, not `{}`",
                                spec_.mobile ? "x, y and yaw" : "x", item));
        }
      } else if (body.mass_kg == 0.0 || is_jointed(body)) {
        add(path, "only free bodies and the robot's base can be placed at reset");
        return;
      }
    }
  }

  void check_joint(const JointSpec& joint) {
    const std::string path = "joints/" + joint.name;
    if (!joint.parent.empty()) require_name(path + "/parent", body_names_, "body", joint.parent);
    require_name(path + "/child", body_names_, "body", joint.child);
    if (joint.parent == joint.child) add(path + "/child", "is the parent itself");
    require_not_negative(path + "/max_force_n", joint.max_force_n);
    if (joint.type == JointType::kFixed) return;
    if (joint.type == JointType::kGantry) {
      require_positive(path + "/max_force_n", joint.max_force_n);
      require_positive(path + "/max_torque_nm", joint.max_torque_nm);
      return;
    }
    if (!joint.axis_W.allFinite() || joint.axis_W.norm() < 1e-9) {
      add(path + "/axis_W", "has no direction");
    }
    check_stops(path + "/range_m", joint);
  }

  void check_stops(const std::string& path, const JointSpec& joint) {
    const double low_m = joint.low_m.value_or(0.0), high_m = joint.high_m.value_or(0.0);
    if (joint.low_m && joint.high_m && low_m > high_m) {
      add(path, fmt::format("is reversed: {:g} is above {:g}", low_m, high_m));
    } else if (joint.low_m && joint.high_m && low_m == high_m) {
      add(path, "leaves the slider no way to move");
    } else if (low_m > 0.0 || high_m < 0.0) {
      add(path, "excludes 0, the default placement");
    } else if (high_m - low_m > kMaxExtent_m) {
      add(path, fmt::format("is longer than {:g} m", kMaxExtent_m));
    }
  }

  /// Each body hangs on at most one joint; a loop of sliders would lock.
  void check_children() {
    std::map<std::string, std::string> joint_of;
    for (const JointSpec& joint : spec_.joints) {
      const auto [found, fresh] = joint_of.emplace(joint.child, joint.name);
      if (!fresh) {
        add("joints/" + joint.name + "/child",
            "`" + joint.child + "` hangs on joint `" + found->second + "` already");
      }
    }
    for (const BodySpec& body : spec_.bodies) {
      const auto joint = joint_of.find(body.name);
      if (joint != joint_of.end() && body.mass_kg == 0.0) {
        add("bodies/" + body.name + "/mass_kg", "is 0, but joint `" + joint->second + "` moves it");
      }
    }
  }

  bool has_robot() const {
    const LineRobotSpec& r = spec_.robot;
    return !(r.base_joint.empty() && r.base_body.empty() && r.reach_joint.empty() &&
             r.lift_joint.empty() && r.finger_joint.empty() && r.near_pad_body.empty() &&
             r.far_pad_body.empty());
  }

  void check_axis(const std::string& role, const std::string& name, const Eigen::Vector3d* axis) {
    const std::string path = "robot/" + role;
    require_name(path, joint_names_, "joint", name);
    for (const JointSpec& joint : spec_.joints) {
      if (joint.name != name) continue;
      if (joint.type != JointType::kSlider) add(path, "`" + name + "` is no slider");
      if (joint.max_force_n == 0.0) add(path, "`" + name + "` has no motor: max_force_n is 0");
      if (axis != nullptr && !joint.axis_W.normalized().isApprox(*axis, 1e-9)) {
        add(path, fmt::format("`{}` does not move along +{}", name, axis->z() > 0.5 ? 'z' : 'x'));
      }
      if (role == "lift_joint" && !joint.low_m) add(path, "`" + name + "` needs a lower stop");
    }
  }

  void check_robot() {
    const LineRobotSpec& robot = spec_.robot;
    const Eigen::Vector3d x = Eigen::Vector3d::UnitX(), z = Eigen::Vector3d::UnitZ();
    check_axis("base_joint", robot.base_joint, &x);
    check_axis("reach_joint", robot.reach_joint, &x);
    check_axis("lift_joint", robot.lift_joint, &z);
    check_axis("finger_joint", robot.finger_joint, nullptr);
    require_name("robot/base_body", body_names_, "body", robot.base_body);
    require_name("robot/near_pad_body", body_names_, "body", robot.near_pad_body);
    require_name("robot/far_pad_body", body_names_, "body", robot.far_pad_body);
    require_positive("robot/grip_force_n", robot.grip_force_n);
    require_positive("robot/opening_m", robot.opening_m);
    if (problems_.empty()) check_one_machine();
  }

  /// The roles must belong to one machine, or the tool would not follow the axes.
  void check_one_machine() {
    const WorldLayout layout = lay_out(spec_);
    const auto assembly = [&](const std::string& name) {
      return layout.assembly_of[layout.find_body(name)->index()];
    };
    const std::uint32_t robot = assembly(spec_.robot.base_body);
    if (robot == 0) add("robot/base_body", "is fixed to the world");
    for (const std::string& pad : {spec_.robot.near_pad_body, spec_.robot.far_pad_body}) {
      if (assembly(pad) != robot) {
        add("robot/base_body",
            "no joints lead from `" + spec_.robot.base_body + "` to `" + pad + "`");
      }
    }
  }

  const WorldSpec& spec_;
  std::vector<std::string> body_names_, joint_names_;
  std::vector<WorldProblem> problems_;
};

}  // namespace

std::vector<WorldProblem> check_structure(const WorldSpec& spec) {
  return StructureChecker(spec).run();
}

}  // namespace parallax::harness
