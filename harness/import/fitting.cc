// Adapts what files may say to what a simulator can have.
//
// Positions: the tree is walked from its roots, and everything that hangs on a joint is moved by
// the joint's position. The joint's own angle counts from there on, so its stops move the other
// way.
//
// Joints that follow others: the shift of a follower becomes its first position, so that both count
// from where they are coupled, and its stops become stops of its leader.
//
// Links without mass between two joints (files put them there for a joint of two or three axes)
// cannot be moved by forces. Each takes 2 % of the mass and inertia of the next link behind it that
// has any, at the same place, so that all of it weighs the same. About the axes behind the link the
// inertia is smaller by that share.
//
// Inertias: moments that break the triangle inequality are raised to it, the two lesser ones by the
// same amount; where one is not positive at all, that of the shapes counts.

#include "harness/import/fitting.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace parallax::harness {
namespace {

/// A hinge that may turn by less, or a slider that may move by less, is fixed [rad, m].
constexpr double kNoWay = 1e-9;
/// Moments may break the triangle inequality by this share of the greatest, as numbers are rounded.
constexpr double kRoundedShare = 1e-3;

LinkDescription* link_named(Description& description, const std::string& name) {
  const auto found = std::find_if(description.links.begin(), description.links.end(),
                                  [&](const LinkDescription& link) { return link.name == name; });
  return found == description.links.end() ? nullptr : &*found;
}

void fix_stuck(Description& description) {
  for (JointDescription& joint : description.joints) {
    if (joint.type == JointType::kFixed || !(joint.high - joint.low < kNoWay)) continue;
    if (joint.high < joint.low) continue;  // reversed, which is said of it
    description.left_out.add("joints whose stops leave no way (held fast)", joint.name,
                             joint.offset);
    joint.type = JointType::kFixed;
  }
}

/// Moves what hangs on a joint, itself included, by `X`, a motion in the world.
void move_behind(Description& description, const JointDescription& joint,
                 const Eigen::Isometry3d& X) {
  std::set<std::string> behind = {joint.child};
  for (bool grows = true; grows;) {
    grows = false;
    for (JointDescription& other : description.joints) {
      if (behind.contains(other.parent) && behind.insert(other.child).second) grows = true;
    }
  }
  for (LinkDescription& link : description.links) {
    if (behind.contains(link.name)) link.X_WL = X * link.X_WL;
  }
  for (JointDescription& other : description.joints) {
    if (!behind.contains(other.parent)) continue;
    other.axis_W = X.linear() * other.axis_W;
    other.p_WA = X * other.p_WA;
  }
}

void set_position(Description& description, std::size_t number, double position) {
  const JointDescription joint = description.joints[number];
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d axis = joint.axis_W.normalized();
  if (joint.type == JointType::kHinge) {
    X.linear() = Eigen::AngleAxisd(position, axis).toRotationMatrix();
    X.translation() = joint.p_WA - X.linear() * joint.p_WA;
  } else {
    X.translation() = position * axis;
  }
  move_behind(description, joint, X);
  description.joints[number].low -= position;
  description.joints[number].high -= position;
}

/// Followers of followers follow the first of them; what would follow nothing that moves is fixed,
/// or let go of.
void fit_leaders(Description& description) {
  auto& joints = description.joints;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    for (std::size_t steps = 0; !joints[i].leader.empty(); ++steps) {
      JointDescription& joint = joints[i];
      const auto leader =
          std::find_if(joints.begin(), joints.end(),
                       [&](const JointDescription& one) { return one.name == joint.leader; });
      const bool is_sound =
          std::isfinite(joint.shift) && std::isfinite(joint.ratio) && joint.ratio != 0.0;
      if (joint.type == JointType::kFixed) {
        joint.leader.clear();
      } else if (leader == joints.end() || !is_sound || steps > joints.size()) {
        description.left_out.add("joints that follow none that moves (they move freely)",
                                 joint.name, joint.offset);
        joint.leader.clear();
      } else if (leader->type == JointType::kFixed) {
        description.left_out.add("joints that follow one that is held fast (so are they)",
                                 joint.name, joint.offset);
        joint.leader.clear();
        set_position(description, i, joint.shift);
        joint.type = JointType::kFixed;
      } else if (leader->leader.empty()) {
        break;
      } else {
        joint.shift += joint.ratio * leader->shift;
        joint.ratio *= leader->ratio;
        joint.leader = leader->leader;
      }
    }
  }
}

/// The stops of followers become stops of their leaders.
void share_stops(Description& description) {
  for (JointDescription& joint : description.joints) {
    if (joint.leader.empty()) continue;
    JointDescription& leader =
        *std::find_if(description.joints.begin(), description.joints.end(),
                      [&](const JointDescription& one) { return one.name == joint.leader; });
    const double one = (joint.low - joint.shift) / joint.ratio,
                 other = (joint.high - joint.shift) / joint.ratio;
    const double low = std::max(leader.low, std::min(one, other)),
                 high = std::min(leader.high, std::max(one, other));
    joint.high = std::numeric_limits<double>::infinity();
    joint.low = -joint.high;
    if (low < high) {
      leader.low = low;
      leader.high = high;
    } else {
      description.left_out.add("stops of joints that follow others, which leave these no way",
                               joint.name, joint.offset);
    }
  }
}

/// The mass behind a joint, which the links from it on can share.
LinkDescription* mass_behind(Description& description, const std::string& link) {
  for (const JointDescription& joint : description.joints) {
    if (joint.parent != link || joint.type == JointType::kFixed) continue;
    LinkDescription* child = link_named(description, joint.child);
    if (child != nullptr && !child->is_static && child->mass_kg > 0.0) return child;
  }
  return nullptr;
}

bool has_children(const Description& description, const std::string& link) {
  return std::any_of(description.joints.begin(), description.joints.end(),
                     [&](const JointDescription& joint) { return joint.parent == link; });
}

Eigen::Vector3d raised_moments(Eigen::Vector3d moments) {
  Eigen::Index most = 0;
  const double greatest = moments.maxCoeff(&most);
  const double lacks = 2.0 * greatest - moments.sum();
  for (Eigen::Index i = 0; i < 3; ++i) {
    if (i != most && lacks > 0.0) moments[i] += 0.5 * lacks;
  }
  return moments;
}

}  // namespace

std::optional<TextFault> fit_joints(const std::map<std::string, double>& positions,
                                    Description& description) {
  std::set<std::string> unused;
  for (const auto& [name, position] : positions) unused.insert(name);
  fix_stuck(description);
  fit_leaders(description);
  share_stops(description);
  std::map<std::string, double> begins;
  for (std::size_t i = 0; i < description.joints.size(); ++i) {
    const JointDescription& joint = description.joints[i];
    if (joint.type == JointType::kFixed) continue;
    const auto given = positions.find(plain_name(joint.name));
    if (given != positions.end() && !joint.leader.empty()) {
      return TextFault{joint.offset, fmt::format("`positions` names the joint `{}`, which follows "
                                                 "`{}`: give that one's",
                                                 joint.name, joint.leader)};
    }
    if (given != positions.end()) {
      unused.erase(given->first);
      begins[joint.name] = given->second;
      if (given->second < joint.low || given->second > joint.high) {
        return TextFault{joint.offset,
                         fmt::format("`positions` puts the joint `{}` at {:g}, beyond its stops, "
                                     "{:g} and {:g}",
                                     joint.name, given->second, joint.low, joint.high)};
      }
      if (given->second != 0.0) set_position(description, i, given->second);
      continue;
    }
    if (joint.high < joint.low || (joint.low <= 0.0 && joint.high >= 0.0)) continue;
    // The middle, so that it does not begin at a stop; one-sided stops have none.
    const bool has_both = std::isfinite(joint.low) && std::isfinite(joint.high);
    const double position = has_both          ? 0.5 * (joint.low + joint.high)
                            : joint.low > 0.0 ? joint.low
                                              : joint.high;
    description.left_out.add(
        "positions 0 that are beyond the stops (the joint begins in the middle between them, and "
        "counts from there)",
        fmt::format("{}, at {:.4g}", joint.name, position), joint.offset);
    begins[joint.name] = position;
    set_position(description, i, position);
  }
  for (std::size_t i = 0; i < description.joints.size(); ++i) {
    JointDescription& joint = description.joints[i];
    if (joint.leader.empty()) continue;
    const double position = joint.ratio * begins[joint.leader] + joint.shift;
    joint.shift = 0.0;
    if (position != 0.0) set_position(description, i, position);
  }
  if (unused.empty()) return std::nullopt;
  return TextFault{0, fmt::format("`positions` names `{}`, and there is no joint of that name that "
                                  "moves",
                                  *unused.begin())};
}

bool fit_massless(Description& description) {
  bool fixes = false;
  for (LinkDescription& link : description.links) {
    if (link.mass_kg != 0.0 || link.is_static) continue;
    const auto above =
        std::find_if(description.joints.begin(), description.joints.end(),
                     [&](const JointDescription& joint) { return joint.child == link.name; });
    if (above == description.joints.end()) {
      if (link.shapes.empty() && !has_children(description, link.name)) continue;
      description.left_out.add("motions of roots without mass (they stand fast)", link.name,
                               link.offset);
      link.is_static = true;
      fixes = true;
    } else if (above->type != JointType::kFixed && mass_behind(description, link.name) == nullptr &&
               !has_children(description, link.name)) {
      description.left_out.add("joints of links without mass (held fast)", above->name,
                               above->offset);
      above->type = JointType::kFixed;
      fit_leaders(description);
      fixes = true;
    }
  }
  if (fixes) return true;
  // From the ends of the chains inwards, so that what has just got a mass can give of it.
  for (bool shares = true; shares;) {
    shares = false;
    for (LinkDescription& link : description.links) {
      if (link.mass_kg != 0.0 || link.is_static) continue;
      LinkDescription* from = mass_behind(description, link.name);
      if (from == nullptr) continue;
      description.left_out.add(
          fmt::format("links without mass between joints (each has {:g} % of the mass behind it)",
                      100.0 * kSharedMass),
          link.name, link.offset);
      link.mass_kg = kSharedMass * from->mass_kg;
      link.X_LC = link.X_WL.inverse() * from->X_WL * from->X_LC;
      link.I_C_kg_m2 = kSharedMass * from->I_C_kg_m2;
      from->mass_kg -= link.mass_kg;
      from->I_C_kg_m2 -= link.I_C_kg_m2;
      shares = true;
    }
  }
  return false;
}

void fit_inertias(Description& description) {
  for (LinkDescription& link : description.links) {
    if (link.is_static || link.mass_kg <= 0.0 || !link.I_C_kg_m2.allFinite()) continue;
    const Eigen::Matrix3d I = 0.5 * (link.I_C_kg_m2 + link.I_C_kg_m2.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(I);
    const Eigen::Vector3d moments = axes.eigenvalues();
    if (!(moments.minCoeff() > 0.0)) {
      description.left_out.add(
          "inertias with a moment that is not positive (that of the shapes "
          "counts)",
          link.name, link.offset);
      link.has_own_inertia = false;
      continue;
    }
    if (2.0 * moments.maxCoeff() <= moments.sum() + kRoundedShare * moments.maxCoeff()) continue;
    description.left_out.add(
        "inertias that no body has (one moment greater than the other two "
        "together; those are raised)",
        link.name, link.offset);
    const Eigen::Vector3d raised = raised_moments(moments);
    link.I_C_kg_m2 = axes.eigenvectors() * raised.asDiagonal() * axes.eigenvectors().transpose();
  }
}

}  // namespace parallax::harness
