// From the bodies and joints of an imported robot to an arm with a task.
//
// The gripper is a pair of sliders on one link that go along one line, with a body each. The way
// from that link to the root, against the tree of joints, is the chain. The tool lies between the
// pads. It points from the middle of the palm to there, less what lies along the line of the pads.
// The arm is to hang down from above: the turn that brings the tool's direction to the vertical
// and the line of the pads to y is composed with the tool's present pose, and the inverse
// kinematics of the chain is asked for it above tables of several heights and distances, for both
// spots, at the grasp and above it. The first table whose postures are all reached is taken.
//
// Cost: some hundred inverse problems of milliseconds each, at worst.

#include "tools/scaffold/robot_arm.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "harness/kinematics/inverse.h"
#include "harness/world/chain_arm.h"
#include "harness/world/shapes.h"
#include "harness/world/world_layout.h"

namespace parallax::tools {
namespace {

using harness::BodyId;
using harness::JointSpec;
using harness::JointType;
using harness::JointVector;
using harness::WorldLayout;
using harness::WorldSpec;

constexpr double kParallel = 0.99;
constexpr double kRise_m = 0.15;  // of the tool over a spot

bool is_same_link(const WorldLayout& layout, const std::string& a, const std::string& b) {
  if (a == b) return true;
  const auto one = layout.find_body(a), other = layout.find_body(b);
  if (!one || !other) return false;
  const auto& link = layout.link_of[one->index()];
  return link.has_value() && link == layout.link_of[other->index()];
}

/// The joints from the root to the link of `body`; empty where a joint on the way has no motor
/// here.
std::vector<const JointSpec*> way_to(const WorldSpec& world, const WorldLayout& layout,
                                     std::string body) {
  std::vector<const JointSpec*> way;
  for (std::size_t steps = 0; steps <= world.joints.size() && !body.empty(); ++steps) {
    const auto above =
        std::find_if(world.joints.begin(), world.joints.end(), [&](const JointSpec& joint) {
          return joint.type != JointType::kFixed && is_same_link(layout, joint.child, body);
        });
    if (above == world.joints.end()) break;
    if (above->follows || above->type == JointType::kGantry) return {};
    way.push_back(&*above);
    body = above->parent;
  }
  std::reverse(way.begin(), way.end());
  return way;
}

/// Two sliders whose children come together, as leader and follower.
bool is_pair(const WorldLayout& layout, const JointSpec& leader, const JointSpec& follower) {
  if (leader.follows || (follower.follows && follower.follows->leader != leader.name)) return false;
  if (!leader.low_m || !leader.high_m) return false;
  if (!follower.follows && leader.name > follower.name) return false;  // each pair once
  if (leader.parent.empty() || !is_same_link(layout, leader.parent, follower.parent)) return false;
  const double along = leader.axis_W.normalized().dot(follower.axis_W.normalized());
  if (std::abs(along) < kParallel) return false;
  return !follower.follows || follower.follows->ratio * along < 0.0;
}

Eigen::Vector3d middle_of(const WorldSpec& world, const std::string& name) {
  const auto body = std::find_if(world.bodies.begin(), world.bodies.end(),
                                 [&](const harness::BodySpec& one) { return one.name == name; });
  return body->p_WB +
         Eigen::AngleAxisd(body->yaw_rad, Eigen::Vector3d::UnitZ()) * body->shapes.front().p_BS;
}

/// The turns that bring the tool's direction down and the line of the pads to y, either way.
std::vector<Eigen::Matrix3d> turns_down(const WorldSpec& world, const FoundArm& arm) {
  const auto near = middle_of(world, arm.roles.near_pad_body),
             far = middle_of(world, arm.roles.far_pad_body);
  const auto finger =
      std::find_if(world.joints.begin(), world.joints.end(),
                   [&](const JointSpec& joint) { return joint.name == arm.roles.finger_joint; });
  const Eigen::Vector3d line = finger->axis_W.normalized();
  Eigen::Vector3d ahead = 0.5 * (near + far) - middle_of(world, arm.roles.palm_body);
  ahead -= line.dot(ahead) * line;
  if (ahead.norm() < 1e-6) return {};
  ahead.normalize();
  Eigen::Matrix3d from, to;
  from << ahead, line, ahead.cross(line);
  std::vector<Eigen::Matrix3d> turns;
  for (const double side : {1.0, -1.0}) {
    const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ(), y = side * Eigen::Vector3d::UnitY();
    to << down, y, down.cross(y);
    turns.push_back(to * from.transpose());
  }
  return turns;
}

/// Positions for all poses in a row, each from the one before; none where one is not reached.
std::optional<JointVector> reach_all(const harness::SerialChain& chain, const Eigen::Matrix3d& R,
                                     const std::vector<Eigen::Vector3d>& points,
                                     const JointVector& start) {
  JointVector at = start, first = start;
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Isometry3d goal = Eigen::Isometry3d::Identity();
    goal.linear() = R;
    goal.translation() = points[i];
    harness::InverseOptions options;
    if (i > 0) options.restarts = 0;  // the arm is to get there from where it is
    const auto found = solve_inverse(chain, goal, at, options);
    if (!found.reached) return std::nullopt;
    at = found.q;
    if (i == 0) first = at;
  }
  return first;
}

/// Three times what holds the arm in any of many postures, and something for its own motion.
std::map<std::string, double> strengths_for(const harness::ChainArm& arm, double gravity_m_s2) {
  constexpr int kPostures = 200;
  constexpr double kTimes = 3.0, kLeast = 10.0;
  const Eigen::Vector3d gravity = gravity_m_s2 * Eigen::Vector3d::UnitZ();
  JointVector most = JointVector::Zero(arm.chain.size());
  for (int i = 1; i <= kPostures; ++i) {
    const auto q = spread_positions(arm.chain, i);
    most = most.cwiseMax(arm.chain.holding_torques(q, arm.masses, gravity).cwiseAbs());
  }
  std::map<std::string, double> out;
  for (std::size_t i = 0; i < arm.chain.joints().size(); ++i) {
    out[arm.chain.joints()[i].name] =
        std::ceil(kTimes * most(static_cast<Eigen::Index>(i)) + kLeast);
  }
  return out;
}

}  // namespace

std::optional<FoundArm> find_arm(const WorldSpec& world) {
  const WorldLayout layout = lay_out(world);
  std::optional<FoundArm> best;
  for (const JointSpec& leader : world.joints) {
    for (const JointSpec& follower : world.joints) {
      if (&leader == &follower || leader.type != JointType::kSlider ||
          follower.type != JointType::kSlider || !is_pair(layout, leader, follower)) {
        continue;
      }
      const auto way = way_to(world, layout, leader.parent);
      if (way.empty() || way.size() > static_cast<std::size_t>(harness::kMostChainJoints)) continue;
      if (best && best->roles.chain.size() >= way.size()) continue;
      FoundArm arm;
      arm.roles.name = "arm";
      arm.roles.palm_body = leader.parent;
      arm.roles.finger_joint = leader.name;
      arm.roles.far_pad_body = leader.child;
      arm.roles.near_pad_body = follower.child;
      arm.follower = follower.name;
      arm.is_coupled = follower.follows.has_value();
      arm.ratio = leader.axis_W.dot(follower.axis_W) > 0.0 ? -1.0 : 1.0;
      for (const JointSpec* joint : way) {
        arm.roles.chain.push_back(joint->name);
        const bool turns = joint->type == JointType::kHinge;
        if (!turns) arm.slides.insert(joint->name);
        if (turns && !(joint->low_rad && joint->high_rad)) arm.endless.push_back(joint->name);
      }
      arm.root = way.front()->parent;
      const auto root = layout.find_body(arm.root);
      arm.root_moves = root && layout.link_of[root->index()].has_value();
      best = std::move(arm);
    }
  }
  return best;
}

std::optional<WorkPlace> find_work_place(WorldSpec world, const FoundArm& arm, double floor_m) {
  for (JointSpec& joint : world.joints) {
    if (std::find(arm.endless.begin(), arm.endless.end(), joint.name) == arm.endless.end())
      continue;
    joint.low_rad = -kEndlessRange_rad;
    joint.high_rad = kEndlessRange_rad;
  }
  if (arm.root.empty()) return std::nullopt;
  const WorldLayout layout = lay_out(world);
  const harness::ChainArm made = chain_arm(world, layout, arm.roles);
  const Eigen::Vector3d p_WR = layout.bodies[made.root].p_WB;
  const double yaw = layout.bodies[made.root].yaw_rad;
  const Eigen::Matrix3d R_RW = Eigen::AngleAxisd(-yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const JointVector zero = JointVector::Zero(made.chain.size());
  const Eigen::Matrix3d R_RT = made.chain.tool(zero).linear();
  const double reach = std::min(made.chain.longest_reach_m(), 2.0);
  const double shoulder =
      R_RW.transpose().row(2).dot(made.chain.joints().front().p_RA) + p_WR.z() - floor_m;
  for (const double share : {0.5, 0.45, 0.55, 0.4, 0.6, 0.35, 0.3}) {
    for (const double height : {0.3, 0.2, 0.4, 0.1, 0.5, 0.7}) {
      WorkPlace place;
      place.x_m = std::round(100.0 * share * reach) / 100.0;
      place.top_m = height;
      place.aside_m = std::round(100.0 * 0.15 * reach) / 100.0;
      if (height > shoulder + 0.5 * reach) continue;
      const auto point = [&](double y, double over) {
        return Eigen::Vector3d(R_RW *
                               (Eigen::Vector3d(place.x_m, y, floor_m + height + over) - p_WR));
      };
      const double low = 0.04, left = place.aside_m;
      const std::vector<Eigen::Vector3d> points = {
          point(0.0, low + 1.5 * kRise_m), point(left, low + kRise_m),  point(left, low),
          point(left, low + kRise_m),      point(-left, low + kRise_m), point(-left, low)};
      for (const Eigen::Matrix3d& turn : turns_down(world, arm)) {
        const auto first =
            reach_all(made.chain, R_RW * turn * R_RW.transpose() * R_RT, points, zero);
        if (!first) continue;
        for (std::size_t i = 0; i < made.chain.joints().size(); ++i) {
          place.positions[made.chain.joints()[i].name] = (*first)(static_cast<Eigen::Index>(i));
        }
        place.strengths = strengths_for(made, world.solver.gravity_m_s2);
        return place;
      }
    }
  }
  return std::nullopt;
}

}  // namespace parallax::tools
