#include "harness/world/structure_check.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "compiler/base/suggest.h"
#include "harness/world/shapes.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {
namespace {

constexpr double kMaxGravity_m_s2 = 100.0;  // four times that of the largest planet
constexpr double kUpright = 1e-3;           // of a hinge with a handle: sine of how far it leans
constexpr double kLeastLever_m = 0.05;      // from its axis to the handle
const std::array<std::string, 6> kSettable = {"bottom", "mass", "x", "y", "yaw", "z"};

class SolverChecker {
 public:
  explicit SolverChecker(ProblemList& problems) : problems_(problems) {}

  void run(const SolverSpec& s) {
    // Longer steps are no physics, shorter ones no simulation anybody waits for.
    require(s.timestep_s >= 1e-5 && s.timestep_s <= 0.1, "timestep_s",
            "is not within 1e-5 to 0.1 s");
    require_softness("erp", "cfm", s.erp, s.cfm);
    require_softness("contact_erp", "contact_cfm", s.contact_erp.value_or(1.0),
                     s.contact_cfm.value_or(0.0));
    require_not_negative("surface_layer_m", s.surface_layer_m);
    require(s.max_correcting_velocity_m_s > 0.0 && std::isfinite(s.max_correcting_velocity_m_s),
            "max_correcting_velocity_m_s", "is not a positive number");
    require_not_negative("start_penetration_m", s.start_penetration_m);
    require_not_negative("sleep_linear_m_s", s.sleep_linear_m_s);
    require_not_negative("sleep_angular_rad_s", s.sleep_angular_rad_s);
    require_not_negative("sleep_after_s", s.sleep_after_s);
    require(s.gravity_m_s2 <= 0.0, "gravity_m_s2", "does not point down: it is not negative");
    require(s.gravity_m_s2 >= -kMaxGravity_m_s2, "gravity_m_s2", "is stronger than 100 m/s^2");
    require(s.max_contacts_per_pair >= 1 && s.max_contacts_per_pair <= 16, "max_contacts_per_pair",
            "is not within 1 to 16");
  }

 private:
  void require(bool good, const char* key, const char* message) {
    problems_.require(good, std::string("solver/") + key, message);
  }
  void require_not_negative(const char* key, double value) {
    require(value >= 0.0 && std::isfinite(value), key, "is negative or not a number");
  }
  /// Share of an error that a step corrects, and how much a constraint gives.
  void require_softness(const char* erp_key, const char* cfm_key, double erp, double cfm) {
    require(erp > 0.0 && erp <= 1.0, erp_key, "is not within (0, 1]");
    require(cfm >= 0.0 && cfm <= 1.0, cfm_key, "is not within 0 to 1");
  }

  ProblemList& problems_;
};

class StructureChecker {
 public:
  explicit StructureChecker(const WorldSpec& spec)
      : spec_(spec), body_names_(names_of(spec.bodies)), joint_names_(names_of(spec.joints)) {}

  std::vector<WorldProblem> run() {
    SolverChecker(problems_).run(spec_.solver);
    check_friction();
    for (const BodySpec& body : spec_.bodies) check_body(body);
    for (const JointSpec& joint : spec_.joints) check_joint(joint);
    check_unique("bodies", body_names_);
    check_unique("joints", joint_names_);
    check_children();
    if (problems_.empty()) check_line_robot(spec_, problems_);
    if (problems_.empty()) {
      check_places();
      check_grips();
      check_mobile_robot(spec_, problems_);
    }
    return problems_.take();
  }

 private:
  void add(std::string path, std::string message, std::string suggestion = {}) {
    problems_.add(std::move(path), std::move(message), std::move(suggestion));
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
    problems_.require_not_negative("friction/fallback", spec_.friction.fallback);
    for (const auto& [pair, mu] : spec_.friction.pairs) {
      const std::string path = "friction/pairs/" + pair.first + "," + pair.second;
      problems_.require_not_negative(path, mu);
      if (pair.second < pair.first) add(path, "the two materials are not in order");
      problems_.require_name(path, materials, "body of material", pair.first);
      problems_.require_name(path, materials, "body of material", pair.second);
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
    problems_.require_not_negative(path + "/mass_kg", body.mass_kg);
    if (body.mass_kg > kMaxMass_kg) {
      add(path + "/mass_kg", fmt::format("is more than {:g} kg", kMaxMass_kg));
    }
    if (body.shapes.empty()) add(path + "/shapes", "is empty");
    for (const BodyShape& shape : body.shapes) {
      if (!(shape.size_m.array() > 0.0).all() || !shape.size_m.allFinite()) {
        add(path + "/shapes", "a size is not positive");
      }
      if ((shape.form == ShapeForm::kHull) != (shape.hull != nullptr)) {
        add(path + "/shapes", "a hull has no corners, or something else has");
      }
      if (!shape.p_BS.allFinite()) add(path + "/shapes", "a position is not a number");
      const double turns = shape.yaw_rad + shape.pitch_rad + shape.roll_rad;
      if (!std::isfinite(turns)) add(path + "/shapes", "an angle is not a number");
    }
    if (!body.p_WB.allFinite() || !std::isfinite(body.yaw_rad)) {
      add(path, "the placement is not a number");
    }
    check_extent(body);
    check_inertia(body);
    check_settable(body);
  }

  /// A body can have these moments only if each is at most the sum of the other two.
  void check_inertia(const BodySpec& body) {
    if (!body.inertia || !problems_.empty()) return;
    const std::string path = "bodies/" + body.name + "/inertia";
    const InertiaSpec& inertia = *body.inertia;
    if (body.mass_kg == 0.0) return add(path, "is of a body without mass");
    if (!inertia.p_BC.allFinite() || !inertia.I_C_kg_m2.allFinite()) {
      return add(path, "is not a number");
    }
    if (inertia.p_BC.cwiseAbs().maxCoeff() > kMaxExtent_m) {
      return add(path, fmt::format("has its centre more than {:g} m away", kMaxExtent_m));
    }
    if (!inertia.I_C_kg_m2.isApprox(inertia.I_C_kg_m2.transpose(), 1e-9)) {
      return add(path, "is not symmetric");
    }
    const Eigen::Vector3d moments = principal_moments(inertia.I_C_kg_m2);
    if (!(moments.minCoeff() > 0.0)) return add(path, "has a moment that is not positive");
    if (moments.maxCoeff() > body.mass_kg * kMaxExtent_m * kMaxExtent_m) {
      return add(path, fmt::format("is that of a body of more than {:g} m", kMaxExtent_m));
    }
    const double play = 1e-3 * moments.maxCoeff();  // numbers are rounded where they are written
    if (2.0 * moments.maxCoeff() > moments.sum() + play) {
      add(path,
          fmt::format("is that of no body: its moments are {:.3g}, {:.3g} and {:.3g}, and one is "
                      "more than the other two together",
                      moments.x(), moments.y(), moments.z()));
    }
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
        [&](const BodyShape& shape) { return is_far(shape.size_m) || is_far(shape.p_BS); });
    if (huge)
      add(path + "/shapes", fmt::format("a shape is larger or farther than {:g} m", kMaxExtent_m));
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
    if (!joint.parent.empty())
      problems_.require_name(path + "/parent", body_names_, "body", joint.parent);
    problems_.require_name(path + "/child", body_names_, "body", joint.child);
    if (joint.parent == joint.child) add(path + "/child", "is the parent itself");
    problems_.require_not_negative(path + "/max_force_n", joint.max_force_n);
    if (joint.type == JointType::kFixed) return;
    if (joint.type == JointType::kGantry) {
      problems_.require_positive(path + "/max_force_n", joint.max_force_n);
      problems_.require_positive(path + "/max_torque_nm", joint.max_torque_nm);
      if (joint.suspension) check_suspension(path + "/suspension", joint);
      return;
    }
    if (!joint.axis_W.allFinite() || joint.axis_W.norm() < 1e-9) {
      add(path + "/axis", "has no direction");
    }
    problems_.require_not_negative(path + "/damping_n_s_m", joint.damping_n_s_m);
    problems_.require_not_negative(path + "/damping_nm_s", joint.damping_nm_s);
    if (joint.type == JointType::kHinge) {
      check_hinge(path, joint);
    } else {
      check_stops(path + "/range_m", joint);
    }
    if (joint.follows) check_follows(path + "/follows", *joint.follows);
  }

  void check_follows(const std::string& path, const FollowSpec& follows) {
    constexpr double kLeastRatio = 1e-3, kMostRatio = 1e3;
    problems_.require_name(path + "/joint", joint_names_, "joint", follows.leader);
    const double size = std::abs(follows.ratio);
    if (!(size >= kLeastRatio && size <= kMostRatio)) {
      add(path + "/ratio", fmt::format("is {:g}, not between {:g} and {:g} in size", follows.ratio,
                                       kLeastRatio, kMostRatio));
    }
    const auto leader = std::find_if(spec_.joints.begin(), spec_.joints.end(),
                                     [&](const JointSpec& j) { return j.name == follows.leader; });
    if (leader == spec_.joints.end()) return;
    if (leader->type != JointType::kSlider && leader->type != JointType::kHinge) {
      add(path + "/joint", fmt::format("`{}` is no slider or hinge", follows.leader));
    } else if (leader->follows) {
      add(path + "/joint", fmt::format("`{}` follows another joint itself", follows.leader));
    }
  }

  void check_suspension(const std::string& path, const JointSpec& joint) {
    const SuspensionSpec& s = *joint.suspension;
    if (!joint.parent.empty()) add(path, "belongs to gantries of the world");
    problems_.require_positive(path + "/stiffness_n_m", s.stiffness_n_m);
    problems_.require_positive(path + "/stiffness_nm_rad", s.stiffness_nm_rad);
    problems_.require_not_negative(path + "/damping_n_s_m", s.damping_n_s_m);
    problems_.require_not_negative(path + "/damping_nm_s", s.damping_nm_s);
  }

  void check_hinge(const std::string& path, const JointSpec& joint) {
    problems_.require_not_negative(path + "/max_torque_nm", joint.max_torque_nm);
    if (!joint.p_WA.allFinite() || joint.p_WA.cwiseAbs().maxCoeff() > kMaxExtent_m) {
      add(path + "/at_m", fmt::format("is more than {:g} m away", kMaxExtent_m));
    }
    const double low = joint.low_rad.value_or(0.0), high = joint.high_rad.value_or(0.0);
    const std::string range = path + "/range_rad";
    if (joint.low_rad && joint.high_rad && low > high) {
      add(range, fmt::format("is reversed: {:g} is above {:g}", low, high));
    } else if (joint.low_rad && joint.high_rad && low == high) {
      add(range, "leaves the hinge no way to turn");
    } else if (low > 0.0 || high < 0.0) {
      add(range, "excludes 0, the default placement");
    } else if (!(low >= -kMostTurn_rad && high <= kMostTurn_rad)) {
      add(range, fmt::format("goes beyond {:g} rad, about two turns; without stops a hinge turns "
                             "for ever",
                             kMostTurn_rad));
    }
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

  void check_places() {
    for (const PlaceSpec& place : spec_.places) {
      if (place.p_FP.cwiseAbs().maxCoeff() > kMaxExtent_m) {
        add("places/" + place.name + "/at_m",
            fmt::format("is more than {:g} m away", kMaxExtent_m));
      }
      if (!place.frame.empty()) {
        problems_.require_name("places/" + place.name + "/frame", body_names_, "body", place.frame);
      }
    }
  }

  /// Where grippers take hold: grasps of bodies, handles of joints.
  void check_grips() {
    const WorldLayout layout = lay_out(spec_);
    for (const BodySpec& body : spec_.bodies) {
      if (!body.grasp) continue;
      const std::string path = "bodies/" + body.name + "/grasp";
      problems_.require(body.grasp->width_m > 0.0, path + "/width_m", "is not positive");
      problems_.require(body.grasp->effort_n > 0.0, path + "/effort_n", "is not positive");
      problems_.require(layout.is_free[layout.find_body(body.name)->index()], path,
                        "only free bodies are grasped");
    }
    for (const JointSpec& joint : spec_.joints) {
      if (joint.handle) check_handle(joint);
    }
  }

  void check_handle(const JointSpec& joint) {
    const std::string path = "joints/" + joint.name + "/handle";
    if (joint.type == JointType::kSlider) return;
    if (joint.type != JointType::kHinge) {
      return add(path, "only sliders and hinges have handles");
    }
    problems_.require(joint.low_rad && joint.high_rad, path,
                      "is on a hinge that turns for ever: a door has stops (`range_rad`)");
    if (counts_turns(joint)) {
      add(path, fmt::format("is on a hinge that turns farther than {:g} rad", kHalfTurn_rad));
    }
    const Eigen::Vector3d axis = joint.axis_W.normalized();
    if (axis.head<2>().norm() > kUpright) {
      return add(path, "is on a hinge that leans: hands turn about the vertical alone");
    }
    const auto child = std::find_if(spec_.bodies.begin(), spec_.bodies.end(),
                                    [&](const BodySpec& b) { return b.name == joint.child; });
    if (child == spec_.bodies.end()) return;  // told elsewhere
    const Eigen::Vector3d grip =
        child->p_WB +
        Eigen::AngleAxisd(child->yaw_rad, Eigen::Vector3d::UnitZ()) * joint.handle->p_CH;
    problems_.require((grip - joint.p_WA).head<2>().norm() > kLeastLever_m, path,
                      "lies within 5 cm of the axis of its hinge");
  }

  const WorldSpec& spec_;
  std::vector<std::string> body_names_, joint_names_;
  ProblemList problems_;
};

}  // namespace

void ProblemList::add(std::string path, std::string message, std::string suggestion) {
  found_.push_back({std::move(path), std::move(message), std::move(suggestion)});
}

void ProblemList::require(bool good, const std::string& path, const char* message) {
  if (!good) add(path, message);
}

void ProblemList::require_positive(const std::string& path, double value) {
  require(value > 0.0 && std::isfinite(value), path, "is not a positive number");
}

void ProblemList::require_not_negative(const std::string& path, double value) {
  require(value >= 0.0 && std::isfinite(value), path, "is negative or not a number");
}

void ProblemList::require_name(const std::string& path, const std::vector<std::string>& names,
                               const std::string& kind, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  add(path, name.empty() ? "no " + kind + " is named" : "no " + kind + " `" + name + "`",
      base::nearest_name(name, names).value_or(""));
}

std::vector<WorldProblem> check_structure(const WorldSpec& spec) {
  return StructureChecker(spec).run();
}

}  // namespace parallax::harness
