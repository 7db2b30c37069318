#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/id.h"
#include "harness/simulator/simulator.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

struct BodyTag {};
struct SliderTag {};
struct GantryTag {};
struct HingeTag {};
struct LinkTag {};
using BodyId = base::Id<BodyTag>;      // in WorldLayout::bodies
using SliderId = base::Id<SliderTag>;  // in WorldLayout::sliders
using GantryId = base::Id<GantryTag>;  // in WorldLayout::gantries
using HingeId = base::Id<HingeTag>;    // in WorldLayout::hinges
using LinkId = base::Id<LinkTag>;      // in WorldLayout::links

/// Bodies that are welded together and move as one.
struct Link {
  std::vector<BodyId> members;  // sorted by name; the link's axes are those of the first
};

/// Have two ascending lists a number in common?
inline bool share_word(const std::vector<std::uint32_t>& a, const std::vector<std::uint32_t>& b) {
  auto i = a.begin();
  auto k = b.begin();
  while (i != a.end() && k != b.end()) {
    if (*i == *k) return true;
    ++(*i < *k ? i : k);
  }
  return false;
}

/// A WorldSpec put into the order in which the engine creates it, with its structure made plain.
struct WorldLayout {
  base::Store<BodyId, BodySpec> bodies;        // sorted by name
  base::Store<SliderId, JointSpec> sliders;    // sorted by name
  base::Store<GantryId, JointSpec> gantries;   // sorted by name
  base::Store<HingeId, JointSpec> hinges;      // sorted by name
  base::Store<LinkId, Link> links;             // sorted by the name of their first member
  std::vector<std::optional<LinkId>> link_of;  // by body; none: static
  /// By body: the words of BodySpec::apart by number, ascending. Bodies that share one never
  /// collide.
  std::vector<std::vector<std::uint32_t>> apart_of;
  /// By body. Bodies of one assembly hang together by joints and never collide with each other;
  /// 0 is the static world.
  std::vector<std::uint32_t> assembly_of;
  std::vector<bool> is_free;  // by body: movable, and no joint names it

  std::optional<BodyId> find_body(std::string_view name) const;
  std::optional<SliderId> find_slider(std::string_view name) const;
  std::optional<GantryId> find_gantry(std::string_view name) const;
  std::optional<HingeId> find_hinge(std::string_view name) const;
  /// Does any joint follow this one?
  bool leads(std::string_view joint) const;
  /// Can the two never touch?
  bool never_collide(BodyId a, BodyId b) const {
    const auto of_a = assembly_of[a.index()];
    if (of_a != 0 && of_a == assembly_of[b.index()]) return true;
    return share_word(apart_of[a.index()], apart_of[b.index()]);
  }
};

/// Position of a body's origin [m] and its turn about z [rad], in the world.
struct Placement {
  Eigen::Vector3d p_WB = Eigen::Vector3d::Zero();
  double yaw_rad = 0.0;
  double mass_kg = 0.0;  // of a free body; 0: as specified
};

/// How far the pads of a gripper come together for each metre that its finger moves: 1, or, where
/// the near pad follows the finger, as far as both go.
double grip_gain(const WorldLayout& layout, std::string_view finger_joint,
                 std::string_view near_pad);

/// A flag for each BodyId.
using BodyMask = std::vector<bool>;

/// `spec` must pass check_world.
WorldLayout lay_out(const WorldSpec& spec);

/// The variables that a simulator made from `spec` observes, sorted by name, without building it:
/// NAME.x .y .z .roll .pitch .yaw .held for each free body. With a robot on a line: robot.x,
/// tool.x, tool.z, opening. With a mobile robot: robot.x, .y, .yaw, .lift, .looking_at; ARM.x, .y,
/// .z, .opening, .parked, .open; for each free body BODY.bottom, BODY.mass, BODY.held_by.ARM,
/// BODY.perceived, BODY.seen.known and BODY.seen.x, .y, .z, .yaw, .bottom (where it is believed to
/// be; 0 when unknown); JOINT.q of sliders that are no fingers, and CHILD.x, .y, .z, .yaw of what
/// they carry. Of each hinge, with any robot or none: JOINT.q and CHILD.x, .y, .z, .yaw. Besides
/// these an observation has "digest". `spec` must pass check_structure.
std::vector<Parameter> observables(const WorldSpec& spec);

/// Sliders whose position says something: all but the fingers.
std::vector<SliderId> observed_sliders(const WorldLayout& layout, const MobileRobotSpec& robot);

/// "JOINT.q" and the pose of the body that a joint of the building carries.
std::vector<Parameter> joint_parameters(const JointSpec& joint);

/// The state at reset, or the reason why it cannot be.
struct StartState {
  SimStatus status = SimStatus::kOk;  // or kUnsupported, kInvalidStart
  std::string reason;
  std::vector<Placement> placements;  // by BodyId
};

/// The default placements, changed by the settable variables in `given`: robot.x (.y, .yaw) moves
/// all that hangs on the base; NAME.bottom is the height of the lowest point of a free body, and
/// NAME.mass its mass. kUnsupported for a variable that is not settable or not a finite
/// number; kInvalidStart where the base would lie beyond its stops.
StartState read_start_state(const WorldSpec& spec, const WorldLayout& layout, const State& given);

}  // namespace parallax::harness
