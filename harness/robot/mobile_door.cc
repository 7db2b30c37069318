#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "harness/robot/mobile_controller.h"
#include "harness/world/angles.h"

namespace parallax::harness {
namespace {

constexpr double kHandAcceleration_m_s2 = 0.3;
constexpr double kAtStop_rad = 0.002;
constexpr double kTouchingDoor_m = 0.002;  // overlaps up to here are play in the measures
constexpr double kDoorStep_rad = 0.035;    // between the places of the arc that are tried
constexpr double kLeastGap_m = 0.0005;     // of pads with something between them
constexpr double kBehind_m = 0.5;          // what a palm pushes is looked for from so far
constexpr int kChainPlaces = 3;            // of an arm of joints, whose ways are tried later

/// Leads a door to one of its stops: by its handle or, if the hand holds something, with the palm
/// that pushes where the handle is. The base stands still; the hand follows the arc, and the wrist
/// turns with the leaf. Angles are those about the vertical, upwards.
class MoveDoor final : public MobileController {
 public:
  MoveDoor(const ControlContext& context, const Arguments& arguments, bool opens)
      : MobileController(context, arguments), hinge_(*arguments.hinge("joint")) {
    handle_ = *joint().handle;
    leaf_ = *world().layout().find_body(joint().child);
    // As of a drawer, the upper stop is the open end.
    goal_rad_ = opens ? *joint().high_rad : *joint().low_rad;
    if (is_there()) return;
    const bool pulls = !context.grasp.held_body(arm().gripper());
    const double wrist = pulls ? aim_at_handle() : aim_behind();
    standoff_ = grip_ - number("standoff_m") * way_in();
    if (require_arc(wrist) && require_free_door()) add_phases(wrist, pulls);
  }

 private:
  const JointSpec& joint() const { return world().layout().hinges[hinge_]; }
  double sense() const { return std::copysign(1.0, joint().axis_W.z()); }
  double turned_rad() const { return sense() * world().hinge_angle_rad(hinge_); }
  double left_rad() const { return sense() * goal_rad_ - turned_rad(); }
  bool is_there() const { return std::abs(left_rad()) <= number("stop_tolerance_rad"); }

  /// A point of the axis, wherever the door hangs now.
  Eigen::Vector3d axis() const {
    const BodySpec& leaf = world().layout().bodies[leaf_];
    const Eigen::AngleAxisd back(-leaf.yaw_rad, Eigen::Vector3d::UnitZ());
    return world().position(leaf_) + world().rotation(leaf_) * (back * (joint().p_WA - leaf.p_WB));
  }
  /// How far the leaf is turned from its default placement, what it hangs on included.
  double swung_rad() const {
    return heading_rad(world().rotation(leaf_)) - world().layout().bodies[leaf_].yaw_rad;
  }
  Eigen::Vector3d handle_in_world() const {
    return world().position(leaf_) + world().rotation(leaf_) * handle_.p_CH;
  }
  /// The last stretch to the handle, or to beside it, as the door stands.
  Eigen::Vector3d way_in() const {
    return Eigen::AngleAxisd(swung_rad(), Eigen::Vector3d::UnitZ()) * handle_.approach.normalized();
  }
  /// The rest of the arc and a little more, so that the stop ends it.
  double arc_rad() const {
    const double beyond_rad = beyond_m_ / (grip_ - axis()).head<2>().norm();
    return left_rad() + std::copysign(beyond_rad, left_rad());
  }

  /// The hand at the handle as the door stands; how its wrist is turned then.
  double aim_at_handle() {
    const double wrist = wrapped(handle_.wrist_rad + swung_rad() - robot().base().pose().yaw_rad);
    grip_ = tool_beside(handle_in_world(), handle_.width_m, number("clearance_m"), wrist);
    return wrist;
  }

  /// The palm behind what it will meet first of the door, where the handle is and on the way that
  /// the door is to go. A line of the pads along that way is as good either way round.
  double aim_behind() {
    const Eigen::Vector3d handle = handle_in_world();
    const Eigen::Vector3d out = (handle - axis()).cwiseProduct(Eigen::Vector3d(1.0, 1.0, 0.0));
    const Eigen::Vector3d ahead =
        std::copysign(1.0, left_rad()) * Eigen::Vector3d::UnitZ().cross(out).normalized();
    const Eigen::Vector3d behind = handle - kBehind_m * ahead;
    const double way_m = world().ray_meets(behind, handle, leaf_).value_or(kBehind_m);
    const Eigen::Vector3d line = arm().pad_line(arm().wrist_rad());
    double turn = wrapped(std::atan2(ahead.y(), ahead.x()) - std::atan2(line.y(), line.x()));
    if (turn > 0.5 * M_PI) turn -= M_PI;
    if (turn <= -0.5 * M_PI) turn += M_PI;
    const double wrist = wrapped(arm().wrist_rad() + turn);
    const double room_m = arm().palm_half_extent_m(ahead, wrist) + number("clearance_m");
    grip_ = behind + (way_m - room_m) * ahead - arm().palm_offset();
    beyond_m_ += number("clearance_m");
    return wrist;
  }

  void add_phases(double wrist, bool pulls) {
    add_wrist(wrist);
    if (pulls) add_opening([this] { return arm().spec().opening_m; });
    add_step([this] { check_hand(); });
    add_tool_path("reaching", [this] { return standoff_; });
    Motion slow = tool_motion();
    slow.max_speed_m_s = number("approach_speed_m_s");
    add_tool_move(
        "approaching", [this] { return grip_; }, slow);
    if (pulls) {
      add_handle_squeeze(handle_);
      add_step([this] { check_hold(); });
    }
    add_turning();
    if (pulls) add_opening([this] { return arm().spec().opening_m; });
    add_tool_move(
        "drawing back",
        [this] { return Eigen::Vector3d(arm().tool() - number("standoff_m") * way_in()); },
        tool_motion());
    add_pause("settling", number("settle_s"));
  }

  /// The whole arc of the hand is within reach.
  bool require_arc(double wrist) {
    const double arc = arc_rad();
    const auto needed = static_cast<int>(std::ceil(std::abs(arc) / kDoorStep_rad));
    const int places = arm().chain() != nullptr ? kChainPlaces : std::max(1, needed);
    for (int i = 0; i <= places; ++i) {
      const double turned = arc * i / places;
      const std::string what =
          i == 0 ? fmt::format("the handle of `{}`", joint().name)
                 : fmt::format("the handle of `{}`, turned by {:.2f} rad,", joint().name, turned);
      if (!require_reach(round_vertical(grip_, axis(), turned), wrist + turned, what)) return false;
    }
    return true;
  }

  /// Nothing that stays where it is stands in the arc of the leaf, the robot itself included. What
  /// is free may give way.
  bool require_free_door() {
    const WorldLayout& layout = world().layout();
    BodyMask moving(layout.bodies.size(), false), ignored = moving;
    for (std::size_t i = 0; i < moving.size(); ++i) {
      const BodyId id = layout.bodies.id_at(i);
      moving[i] =
          layout.link_of[i].has_value() && layout.link_of[i] == layout.link_of[leaf_.index()];
      ignored[i] = moving[i] || layout.is_free[i] || layout.never_collide(leaf_, id) ||
                   (arm().chain() != nullptr && arm().chain()->arm().hangs_on[i] >= 0);
    }
    for (const BodyId id : arm().bodies()) ignored[id.index()] = true;
    const Sweep leaf(world(), moving, ignored, kTouchingDoor_m);
    const auto hit = leaf.turning(Eigen::Vector3d::Zero(), axis(), left_rad(), kDoorStep_rad);
    if (!hit) return true;
    refuse_with(kManipulationUnreachable, fmt::format("on the arc of `{}` `{}` would meet `{}`",
                                                      joint().name, hit->part, hit->obstacle));
    return false;
  }

  /// The way in is straight, and then the hand turns with the door: what is in its way makes the
  /// handle unreachable. On its way in the leaf is in the way, too, its handle included: open pads
  /// pass it at the clearance, and a palm ends so far from what it is to push.
  void check_hand() {
    ArmWays ways = arm_ways(leaf_, 0.0);
    auto fault = ways.along(standoff_, grip_);
    if (!fault) fault = arm_ways(std::nullopt, kTouchingDoor_m).along(standoff_, grip_);
    if (!fault) fault = ways.round(grip_, axis(), arc_rad(), leaf_);
    if (!fault) return;
    refuse_way(*fault, "at the handle");
  }

  /// Pads that have closed on air, above the bar or beside it, lead nothing.
  void check_hold() {
    if (leaf_between_pads()) return;
    refuse_with(kGraspFailed,
                fmt::format("nothing of `{}` is between the closed pads: the handle of `{}` "
                            "was missed",
                            world().layout().bodies[leaf_].name, joint().name));
  }

  /// Does the leaf reach into the gap between the faces of the pads?
  bool leaf_between_pads() const {
    const double gap_m = arm().opening_m();
    if (gap_m < kLeastGap_m) return false;
    Probe gap = face(arm().spec().near_pad_body);
    const Eigen::Vector3d to_far = face(arm().spec().far_pad_body).p_WS - gap.p_WS;
    Eigen::Index across = 0;
    (gap.R_WS.transpose() * to_far).cwiseAbs().maxCoeff(&across);
    gap.form = ShapeForm::kBox;
    gap.hull = nullptr;
    gap.p_WS += 0.5 * to_far;
    gap.size_m[across] = gap_m;
    return world().overlaps(gap, leaf_);
  }

  /// The shape with which a pad touches: the first in its list.
  Probe face(const std::string& pad) const {
    const BodyId id = *world().layout().find_body(pad);
    return world().placed(id, world().layout().bodies[id].shapes.front());
  }

  void add_turning() {
    add(
        "turning it",
        [this] {
          const double lever_m = (arm().tool() - axis()).head<2>().norm();
          const Motion pace{number("pull_speed_m_s") / lever_m, kHandAcceleration_m_s2 / lever_m,
                            0.001, 10.0};
          const double arc = arc_rad();
          arm().lead_tool_round(axis(), arc, pace);
          return patience_s(arc, pace);
        },
        [this] { return std::abs(left_rad()) < kAtStop_rad || arm().tool_at_rest(); });
    add_braking([this] { arm().brake(); }, [this] { return arm().tool_at_rest(); });
  }

  Outcome judge(std::string_view overdue) override {
    const double short_rad = std::abs(left_rad());
    const State margins{{"stop", number("stop_tolerance_rad") - short_rad}};
    if (is_there()) return {SimStatus::kOk, {}, 0.0, margins};
    const auto text = fmt::format("`{}` is {:.3f} rad short of its stop", joint().name, short_rad);
    return failed(kGoalNotReached, with_overdue(text, overdue), margins);
  }

  HingeId hinge_;
  HandleSpec handle_;
  BodyId leaf_;
  double goal_rad_ = 0.0;
  double beyond_m_ = kBeyondStop_m;  // of the hand's way
  Eigen::Vector3d grip_ = Eigen::Vector3d::Zero(), standoff_ = Eigen::Vector3d::Zero();
};

}  // namespace

std::unique_ptr<Controller> make_open_door(const ControlContext& context,
                                           const Arguments& arguments) {
  return std::make_unique<MoveDoor>(context, arguments, true);
}

std::unique_ptr<Controller> make_close_door(const ControlContext& context,
                                            const Arguments& arguments) {
  return std::make_unique<MoveDoor>(context, arguments, false);
}

}  // namespace parallax::harness
