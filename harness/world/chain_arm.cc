#include "harness/world/chain_arm.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>

#include "harness/kinematics/inverse.h"
#include "harness/world/shapes.h"

namespace parallax::harness {
namespace {

Eigen::Isometry3d default_pose(const BodySpec& body) {
  Eigen::Isometry3d X_WB = Eigen::Isometry3d::Identity();
  X_WB.linear() = Eigen::AngleAxisd(body.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X_WB.translation() = body.p_WB;
  return X_WB;
}

Eigen::Vector3d default_centre(const BodySpec& body) {
  if (body.inertia) return default_pose(body) * body.inertia->p_BC;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double volume = 0.0;
  for (const BodyShape& shape : body.shapes) {
    sum += volume_m3(shape) * shape.p_BS;
    volume += volume_m3(shape);
  }
  return default_pose(body) * Eigen::Vector3d(sum / volume);
}

template <typename List>
const typename List::value_type* named(const List& list, const std::string& name) {
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const auto& one) { return one.name == name; });
  return found == list.end() ? nullptr : &*found;
}

/// The joints of the chain, or none if one is not there.
std::vector<const JointSpec*> joints_of(const WorldSpec& spec, const ArmSpec& arm) {
  std::vector<const JointSpec*> all;
  for (const std::string& name : arm.chain) {
    const JointSpec* joint = named(spec.joints, name);
    if (joint == nullptr) return {};
    all.push_back(joint);
  }
  return all;
}

/// The last joint of the chain on the way from a body to the world; -1: none.
int last_joint(const WorldSpec& spec, const ArmSpec& arm, std::string body) {
  for (std::size_t steps = 0; steps <= spec.joints.size(); ++steps) {
    const auto joint = std::find_if(spec.joints.begin(), spec.joints.end(),
                                    [&](const JointSpec& one) { return one.child == body; });
    if (joint == spec.joints.end()) return -1;
    const auto found = std::find(arm.chain.begin(), arm.chain.end(), joint->name);
    if (found != arm.chain.end()) return static_cast<int>(found - arm.chain.begin());
    body = joint->parent;
  }
  return -1;
}

/// At the default placement, in the frame of `X_WR`.
ChainJoint chain_joint(const WorldSpec& spec, const JointSpec& joint,
                       const Eigen::Isometry3d& X_WR) {
  ChainJoint out;
  out.name = joint.name;
  out.slides = joint.type == JointType::kSlider;
  out.axis_R = X_WR.linear().transpose() * joint.axis_W.normalized();
  out.p_RA = X_WR.inverse() * (out.slides ? named(spec.bodies, joint.child)->p_WB : joint.p_WA);
  out.low = (out.slides ? joint.low_m : joint.low_rad).value_or(-kMostTurn_rad);
  out.high = (out.slides ? joint.high_m : joint.high_rad).value_or(kMostTurn_rad);
  return out;
}

/// The middle between the pads, along the palm's axes; at the default placement.
Eigen::Isometry3d tool_pose(const WorldSpec& spec, const ArmSpec& arm) {
  const auto middle = [&](const std::string& pad) {
    const BodySpec& body = *named(spec.bodies, pad);
    return Eigen::Vector3d(default_pose(body) * body.shapes.front().p_BS);
  };
  Eigen::Isometry3d X_WT = default_pose(*named(spec.bodies, arm.palm_body));
  X_WT.translation() = 0.5 * (middle(arm.near_pad_body) + middle(arm.far_pad_body));
  return X_WT;
}

/// Checks one joint of a chain. Returns false if it has faults; then nothing else can be said of
/// it.
bool check_chain_joint(const std::string& path, const JointSpec& joint, ProblemList& problems) {
  const auto before = problems.size();
  const bool hinge = joint.type == JointType::kHinge;
  if (!hinge && joint.type != JointType::kSlider) {
    problems.add(path, fmt::format("`{}` is no hinge or slider", joint.name));
    return false;
  }
  if (joint.follows) {
    problems.add(path, fmt::format("`{}` follows `{}`", joint.name, joint.follows->leader));
  }
  if (!(hinge ? joint.max_torque_nm > 0.0 : joint.max_force_n > 0.0)) {
    problems.add(path, fmt::format("`{}` has no motor: {} is 0", joint.name,
                                   hinge ? "max_torque_nm" : "max_force_n"));
  }
  if (!(hinge ? joint.low_rad && joint.high_rad : joint.low_m && joint.high_m)) {
    problems.add(path, fmt::format("`{}` has no stops: it needs `{}`", joint.name,
                                   hinge ? "range_rad" : "range_m"));
  }
  return problems.size() == before;
}

bool check_links(const WorldSpec& spec, const WorldLayout& layout, const ArmSpec& arm,
                 const std::string& path, ProblemList& problems) {
  const auto before = problems.size();
  const auto link = [&](const std::string& body) {
    return layout.link_of[layout.find_body(body)->index()];
  };
  const auto joints = joints_of(spec, arm);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (!check_chain_joint(path, *joints[i], problems)) continue;
    if (joints[i]->parent.empty()) {
      problems.add(path, fmt::format("`{}` does not hang on the robot", joints[i]->name));
    } else if (i > 0 && link(joints[i]->parent) != link(joints[i - 1]->child)) {
      problems.add(path, fmt::format("`{}` does not hang on what `{}` carries", joints[i]->name,
                                     joints[i - 1]->name));
    }
  }
  if (problems.size() == before && link(joints.back()->child) != link(arm.palm_body)) {
    problems.add(path, fmt::format("`{}`, the last, does not carry `{}`", joints.back()->name,
                                   arm.palm_body));
  }
  return problems.size() == before;
}

void check_strength(const ChainArm& made, double gravity_m_s2, const std::string& path,
                    ProblemList& problems) {
  const JointVector zero = JointVector::Zero(made.chain.size());
  const JointVector needed =
      made.chain.holding_torques(zero, made.masses, gravity_m_s2 * Eigen::Vector3d::UnitZ());
  for (std::size_t i = 0; i < made.strengths.size(); ++i) {
    const double most = std::abs(needed(static_cast<Eigen::Index>(i)));
    if (most <= made.strengths[i]) continue;
    const ChainJoint& joint = made.chain.joints()[i];
    problems.add(path,
                 fmt::format("the motor of `{}` gives {:.3g} {}; to hold the arm as it is "
                             "placed takes {:.3g}",
                             joint.name, made.strengths[i], joint.slides ? "N" : "N m", most));
  }
}

}  // namespace

ChainArm chain_arm(const WorldSpec& spec, const WorldLayout& layout, const ArmSpec& arm) {
  const auto joints = joints_of(spec, arm);
  ChainArm out;
  out.root = *layout.find_body(joints.front()->parent);
  out.palm = *layout.find_body(arm.palm_body);
  const Eigen::Isometry3d X_WR = default_pose(layout.bodies[out.root]);
  std::vector<ChainJoint> chain;
  for (const JointSpec* joint : joints) {
    chain.push_back(chain_joint(spec, *joint, X_WR));
    out.strengths.push_back(chain.back().slides ? joint->max_force_n : joint->max_torque_nm);
  }
  out.chain = SerialChain(std::move(chain), X_WR.inverse() * tool_pose(spec, arm));
  out.masses.resize(joints.size());
  for (const BodySpec& body : layout.bodies) {
    const int joint = last_joint(spec, arm, body.name);
    out.hangs_on.push_back(joint);
    if (joint < 0) continue;
    ChainMass& mass = out.masses[static_cast<std::size_t>(joint)];
    const Eigen::Vector3d moment =
        mass.mass_kg * mass.p_RC + body.mass_kg * (X_WR.inverse() * default_centre(body));
    mass.mass_kg += body.mass_kg;
    if (mass.mass_kg > 0.0) mass.p_RC = moment / mass.mass_kg;
  }
  return out;
}

void check_chain(const WorldSpec& spec, const WorldLayout& layout, const ArmSpec& arm,
                 ProblemList& problems) {
  const std::string path = "robot/arms/" + arm.name;
  if (arm.chain.size() > static_cast<std::size_t>(kMostChainJoints)) {
    return problems.add(path + "/chain", fmt::format("has more than {} joints", kMostChainJoints));
  }
  for (const std::string& name : arm.chain) {
    problems.require_name(path + "/chain", names_of(spec.joints), "joint", name);
  }
  if (joints_of(spec, arm).empty()) return;
  if (!check_links(spec, layout, arm, path + "/chain", problems)) return;
  const ChainArm made = chain_arm(spec, layout, arm);
  check_strength(made, spec.solver.gravity_m_s2, path + "/chain", problems);
  // As the world has it by default, and as the torso has it then.
  const JointVector zero = JointVector::Zero(made.chain.size());
  Eigen::Isometry3d X_RT = made.chain.tool(zero);
  const Eigen::Isometry3d X_WB = default_pose(*named(spec.bodies, spec.mobile->base_body));
  const Eigen::Isometry3d X_WR = default_pose(layout.bodies[made.root]);
  X_RT.translation() = X_WR.inverse() * (X_WB * arm.carry_B);
  const InverseResult found = solve_inverse(made.chain, X_RT, zero);
  if (found.reached) return;
  problems.add(
      path + "/carry_m",
      fmt::format("is out of the chain's reach: it comes to within {:.3f} m and {:.2f} rad",
                  found.short_m, found.short_rad));
}

std::string arms_text(const WorldSpec& spec) {
  if (!spec.mobile) return {};
  std::string text;
  for (const ArmSpec& arm : spec.mobile->arms) {
    text += arm.name + ": ";
    text += arm.chain.empty() ? std::string("palm on a gantry, ")
                              : fmt::format("chain of {} joints, ", arm.chain.size());
  }
  const JointSpec* wheels = named(spec.joints, spec.mobile->base_joint);
  text += wheels != nullptr && wheels->suspension ? "base on springs" : "base held upright";
  return text;
}

void complete_chains(WorldSpec& spec) {
  if (!spec.mobile) return;
  const BodySpec* base = named(spec.bodies, spec.mobile->base_body);
  for (ArmSpec& arm : spec.mobile->arms) {
    const auto joints = joints_of(spec, arm);
    if (joints.empty() || base == nullptr) continue;
    bool there = true;
    for (const auto* name : {&arm.palm_body, &arm.near_pad_body, &arm.far_pad_body}) {
      const BodySpec* body = named(spec.bodies, *name);
      there = there && body != nullptr && !body->shapes.empty();
    }
    for (const JointSpec* joint : joints) there = there && named(spec.bodies, joint->child);
    if (!there) continue;
    const Eigen::Isometry3d X_WB = default_pose(*base);
    std::vector<ChainJoint> chain;
    for (const JointSpec* joint : joints) chain.push_back(chain_joint(spec, *joint, X_WB));
    const SerialChain made(std::move(chain), X_WB.inverse() * tool_pose(spec, arm));
    arm.p_BS = made.joints().front().p_RA;
    arm.min_reach_m = 0.0;
    arm.max_reach_m = made.longest_reach_m();
    if (std::isnan(arm.carry_B.x())) {
      arm.carry_B = made.tool(JointVector::Zero(made.size())).translation();
    }
  }
}

}  // namespace parallax::harness
