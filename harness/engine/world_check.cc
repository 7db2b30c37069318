#include "harness/engine/world_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "harness/engine/engine_module.h"
#include "harness/engine/jaws.h"
#include "harness/engine/physics_world.h"
#include "harness/engine/sweep.h"
#include "harness/engine/world_check.h"

namespace parallax::harness {
namespace {

constexpr double kTouching_m = 0.001;  // overlaps up to here are play in the measures
constexpr double kStep_m = 0.005;      // of sweeps
constexpr double kStep_rad = 0.01;     // of those of doors
constexpr double kProbe_m = 0.004;     // edge of the box that stands for a point
constexpr double kInside_m = 0.005;    // points deeper in furniture than this are inside it

BodyMask movable_bodies(const WorldLayout& layout) {
  BodyMask mask;
  for (const auto& link : layout.link_of) mask.push_back(link.has_value());
  return mask;
}

class GeometryChecker {
 public:
  GeometryChecker(const WorldSpec& spec, ProblemList& problems)
      : spec_(spec),
        problems_(problems),
        owned_(make_world(spec)),
        layout_(world_.layout()),
        movable_(movable_bodies(layout_)) {}

  void run() {
    for (const JointSpec& joint : layout_.sliders) {
      if (!is_part_of_robot(joint.child)) check_travel(joint);
      if (joint.handle && spec_.mobile) check_handle(joint);
    }
    for (const JointSpec& joint : layout_.hinges) {
      if (!joint.handle) continue;
      check_turn(joint);
      if (spec_.mobile) check_handle(joint);
    }
    for (const PlaceSpec& place : spec_.places) {
      if (place.frame.empty()) check_place(place);
    }
    for (const BodySpec& body : spec_.bodies) {
      // Where a grasp turns with the robot, where it is on the body is only known in a run.
      if (body.grasp && body.grasp->follows_body) {
        check_grip(body.name, body.grasp->p_BG, body.grasp->width_m,
                   "bodies/" + body.name + "/grasp");
      }
    }
  }

 private:
  void add(std::string path, std::string message) {
    problems_.add(std::move(path), std::move(message));
  }

  bool is_part_of_robot(const std::string& body) const {
    const auto base = layout_.find_body(base_body(spec_));
    const auto id = layout_.find_body(body);
    return base && layout_.assembly_of[base->index()] == layout_.assembly_of[id->index()];
  }

  /// A drawer that meets what is fixed on the way between its stops is too long or too wide.
  void check_travel(const JointSpec& joint) {
    if (!joint.low_m || !joint.high_m) return;
    BodyMask child(layout_.bodies.size(), false);
    const BodyId moved = *layout_.find_body(joint.child);
    child[moved.index()] = true;
    BodyMask ignored = movable_;
    for (std::size_t i = 0; i < ignored.size(); ++i) {
      ignored[i] = ignored[i] || layout_.never_collide(moved, layout_.bodies.id_at(i));
    }
    const Sweep sweep(world_, child, ignored, kTouching_m);
    const Eigen::Vector3d axis = joint.axis_W.normalized();
    const auto hit =
        sweep.along(*joint.low_m * axis, (*joint.high_m - *joint.low_m) * axis, kStep_m);
    if (!hit) return;
    add("joints/" + joint.name + "/range_m",
        fmt::format("`{}` meets `{}` {:.3f} m from its lower stop", hit->part, hit->obstacle,
                    hit->way_m));
  }

  /// The same of a door that has a handle.
  void check_turn(const JointSpec& joint) {
    const BodyId moved = *layout_.find_body(joint.child);
    BodyMask leaf(layout_.bodies.size(), false);
    leaf[moved.index()] = true;
    BodyMask ignored = movable_;
    for (std::size_t i = 0; i < ignored.size(); ++i) {
      ignored[i] = ignored[i] || layout_.never_collide(moved, layout_.bodies.id_at(i));
    }
    const Sweep sweep(world_, leaf, ignored, kTouching_m);
    const double sense = std::copysign(1.0, joint.axis_W.z());
    for (const double stop : {*joint.low_rad, *joint.high_rad}) {
      const auto hit = sweep.turning(Eigen::Vector3d::Zero(), joint.p_WA, sense * stop, kStep_rad);
      if (!hit) continue;
      add("joints/" + joint.name + "/range_rad",
          fmt::format("`{}` meets `{}` before its {} stop", hit->part, hit->obstacle,
                      stop == *joint.low_rad ? "lower" : "upper"));
      return;
    }
  }

  /// Pads that close at `p_BG` have to find something of the body there.
  bool check_grip(const std::string& name, const Eigen::Vector3d& p_BG, double width_m,
                  std::string path) {
    const BodyId body = *layout_.find_body(name);
    const Probe probe{Eigen::Vector3d::Constant(width_m),
                      world_.position(body) + world_.rotation(body) * p_BG, world_.rotation(body)};
    if (world_.overlaps(probe, body)) return true;
    add(std::move(path),
        fmt::format("there is nothing of `{}` within {:.3f} m of `at_m`", name, 0.5 * width_m));
    return false;
  }

  /// The base drives anywhere, so only the height decides.
  void check_handle(const JointSpec& joint) {
    if (!check_grip(joint.child, joint.handle->p_CH, joint.handle->width_m,
                    "joints/" + joint.name + "/handle"))
      return;
    const BodyId child = *layout_.find_body(joint.child);
    const double height_m =
        (world_.position(child) + world_.rotation(child) * joint.handle->p_CH).z();
    double highest_lift_m = 0.0;
    if (const auto torso = layout_.find_slider(spec_.mobile->torso_joint)) {
      highest_lift_m = layout_.sliders[*torso].high_m.value_or(0.0);
    }
    double nearest_m = std::numeric_limits<double>::infinity(), reach_m = 0.0;
    for (const ArmSpec& arm : spec_.mobile->arms) {
      const double low_m = arm.p_BS.z(), high_m = low_m + highest_lift_m;
      const double way_m = std::max({low_m - height_m, height_m - high_m, 0.0});
      if (way_m - arm.max_reach_m < nearest_m - reach_m || reach_m == 0.0) {
        nearest_m = way_m;
        reach_m = arm.max_reach_m;
      }
    }
    if (nearest_m <= reach_m) return;
    add("joints/" + joint.name + "/handle",
        fmt::format("is {:.3f} m above or below every shoulder; the reach is {:.3f} m", nearest_m,
                    reach_m));
  }

  void check_place(const PlaceSpec& place) {
    const Probe probe{Eigen::Vector3d::Constant(kProbe_m), place.p_FP, Eigen::Matrix3d::Identity()};
    const auto hit = world_.find_obstacle(probe, movable_, kInside_m);
    if (hit && hit->first != "floor") {
      add("places/" + place.name, fmt::format("lies inside `{}`", hit->first));
    }
  }

  const WorldSpec& spec_;
  ProblemList& problems_;
  std::unique_ptr<const PhysicsWorld> owned_;
  const PhysicsWorld& world_ = *owned_;
  const WorldLayout& layout_;
  BodyMask movable_;
};

constexpr double kOpeningRounding_m = 1e-6;

/// Something that pads are to close on.
struct NeededGrip {
  std::string path;  // "bodies/spoon1/grasp"
  double width_m = 0.0;
  double effort_n = 0.0;  // 0: as the action says
};

/// The grip widths and the force that an arm's pads are capable of.
struct PadRange {
  const ArmSpec* arm = nullptr;
  double narrowest_m = 0.0, widest_m = 0.0;  // by the stops of the finger
  double max_force_n = 0.0;                  // of its motor
  bool grips(const NeededGrip& grip) const {
    return std::min(arm->opening_m, widest_m) > grip.width_m && narrowest_m < grip.width_m;
  }
};

std::vector<NeededGrip> grips_of(const WorldSpec& spec) {
  std::vector<NeededGrip> grips;
  for (const BodySpec& body : spec.bodies) {
    if (!body.grasp) continue;
    grips.push_back({"bodies/" + body.name + "/grasp", body.grasp->width_m, body.grasp->effort_n});
  }
  for (const JointSpec& joint : spec.joints) {
    if (!joint.handle) continue;
    grips.push_back({"joints/" + joint.name + "/handle", joint.handle->width_m});
  }
  return grips;
}

/// The hand of a gantry hangs where its bodies are placed, which need not be near the shoulder.
void check_hand_near(const MobileRobotSpec& robot, const ArmSpec& arm, const Jaws& jaws,
                     const PhysicsWorld& world, ProblemList& problems) {
  if (!arm.chain.empty()) return;
  const WorldLayout& layout = world.layout();
  const BodyId base = *layout.find_body(robot.base_body), palm = *layout.find_body(arm.palm_body);
  Eigen::Vector3d shoulder = world.position(base) + world.rotation(base) * arm.p_BS;
  if (const auto torso = layout.find_slider(robot.torso_joint)) {
    shoulder.z() -= layout.sliders[*torso].low_m.value_or(0.0);  // the shoulder's is the lowest
  }
  const Eigen::Vector3d tool = world.position(palm) + world.rotation(palm) * jaws.tool_P();
  const double distance_m = (tool - shoulder).norm();
  if (distance_m >= arm.min_reach_m - kTouching_m && distance_m <= arm.max_reach_m + kTouching_m) {
    return;
  }
  problems.add(
      "robot/arms/" + arm.name,
      fmt::format("the hand is placed {:.3f} m from its shoulder, the reach is {:.3f} m to "
                  "{:.3f} m: what moves `{}` has to move `{}` and its pads along",
                  distance_m, arm.min_reach_m, arm.max_reach_m, robot.base_body, arm.palm_body));
}

class GripperChecker {
 public:
  GripperChecker(const WorldSpec& spec, ProblemList& problems)
      : problems_(problems), grips_(grips_of(spec)) {
    const std::unique_ptr<const PhysicsWorld> owned = make_world(spec);
    const PhysicsWorld& world = *owned;
    for (const ArmSpec& arm : spec.mobile->arms) {
      const Jaws jaws(arm, world);
      check_hand_near(*spec.mobile, arm, jaws, world, problems);
      const auto limits = jaws.opening_limits_m();
      const auto finger = world.layout().find_slider(arm.finger_joint);
      ranges_.push_back({&arm, limits.first, limits.second,
                         world.layout().sliders[*finger].max_force_n / jaws.gain()});
    }
  }

  void run() {
    const auto before = problems_.size();
    for (const PadRange& range : ranges_) check(range);
    if (problems_.size() != before) return;  // all that follows from it would be reported, too
    double widest_m = 0.0, strongest_n = 0.0;
    for (const PadRange& range : ranges_) {
      widest_m = std::max(widest_m, range.arm->opening_m);
      strongest_n = std::max(strongest_n, range.max_force_n);
    }
    for (const NeededGrip& grip : grips_) {
      if (grip.effort_n > strongest_n) {
        problems_.add(grip.path + "/effort_n",
                      fmt::format("is {:g} N, but no gripper's motor exerts more than {:g} N",
                                  grip.effort_n, strongest_n));
        continue;
      }
      const bool held = std::any_of(ranges_.begin(), ranges_.end(),
                                    [&](const PadRange& range) { return range.grips(grip); });
      if (held) continue;
      problems_.add(grip.path + "/width_m",
                    widest_m <= grip.width_m
                        ? fmt::format("is {:g} m, but no gripper opens wider than {:g} m",
                                      grip.width_m, widest_m)
                        : fmt::format("is {:g} m, to which no gripper closes", grip.width_m));
    }
  }

 private:
  void check(const PadRange& range) {
    const ArmSpec& arm = *range.arm;
    const std::string opening = "robot/arms/" + arm.name + "/opening_m";
    if (arm.opening_m > range.widest_m + kOpeningRounding_m ||
        arm.opening_m < range.narrowest_m - kOpeningRounding_m) {
      problems_.add(
          opening, fmt::format("is {:g} m, but `{}` takes the pads from {:.4g} to {:.4g} m",
                               arm.opening_m, arm.finger_joint, range.narrowest_m, range.widest_m));
      return;
    }
    if (grips_.empty() || std::any_of(grips_.begin(), grips_.end(),
                                      [&](const NeededGrip& grip) { return range.grips(grip); })) {
      return;
    }
    const bool narrow = std::all_of(grips_.begin(), grips_.end(), [&](const NeededGrip& grip) {
      return grip.width_m >= arm.opening_m;
    });
    problems_.add(
        narrow ? opening : "joints/" + arm.finger_joint + "/range_m",
        fmt::format("lets the pads hold nothing: they go from {:.4g} to {:.4g} m, and no grasp or "
                    "handle is between",
                    range.narrowest_m, std::min(arm.opening_m, range.widest_m)));
  }

  ProblemList& problems_;
  std::vector<NeededGrip> grips_;
  std::vector<PadRange> ranges_;
};

void check_geometry(const WorldSpec& spec, ProblemList& problems) {
  const bool drawers = std::any_of(spec.joints.begin(), spec.joints.end(), [](const JointSpec& j) {
    return (j.type == JointType::kSlider && j.low_m && j.high_m) ||
           (j.type == JointType::kHinge && j.handle);
  });
  if (drawers || !spec.places.empty()) GeometryChecker(spec, problems).run();
}

void check_grippers(const WorldSpec& spec, ProblemList& problems) {
  if (spec.mobile) GripperChecker(spec, problems).run();
}

/// Reports a joint that an engine of joint coordinates cannot represent.
void check_tree(const WorldSpec& spec, ProblemList& problems) {
  if (const auto problem = tree_problem(spec)) {
    problems.add("joints/" + problem->joint,
                 fmt::format("{}; {} needs one", problem->message, engine_title(spec.engine)));
  }
}

}  // namespace

std::vector<WorldProblem> check_world(const WorldSpec& spec) {
  ProblemList problems(check_structure(spec));
  if (needs_tree(spec.engine) && problems.empty()) check_tree(spec, problems);
  if (problems.empty()) check_geometry(spec, problems);
  if (problems.empty()) check_grippers(spec, problems);
  if (problems.empty()) check_overlaps(spec, problems);
  return problems.take();
}

}  // namespace parallax::harness
