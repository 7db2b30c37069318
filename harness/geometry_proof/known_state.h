#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "harness/geometry_proof/affine_form.h"
#include "harness/region/state_mapping.h"
#include "harness/simulator/simulator.h"
#include "harness/world/arguments.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {

/// The assumptions about the actions before the examined one.
struct ProofAssumptions {
  /// Bodies that no action was to move stay where they were, up to this.
  double drift_m = 0.002, drift_rad = 0.005;
  /// Bodies in a drawer keep their place in it, up to this, while the drawer moves.
  double sliding_m = 0.010, sliding_rad = 0.05;
  /// The base stands within this of where it drove, unless its controller asks for less.
  double goal_m = 10.0, goal_rad = 10.0;
  /// A parked tool is within this of where it is carried; the default is the tolerance of `park`
  /// itself.
  double parked_m = 0.03;
  /// A held body is within `held_m` of where it was gripped, seen from above, and turned by at most
  /// `held_rad`. It is at most `held_height_m` higher or lower, and leans by at most `lean_rad`.
  double held_m = 0.03, held_rad = 0.2;
  double held_height_m = 0.03, lean_rad = 0.2;
  /// Positions of sliders ("dMid.q") that replace those implied by the success of an action.
  std::vector<std::pair<std::string, Bounds1>> sliders;
  friend bool operator==(const ProofAssumptions&, const ProofAssumptions&) = default;
};

/// The place of an arm's tool: as it was at the start, where parking leaves it, or anywhere.
enum class KnownArm { kAtStart, kParked, kAnywhere };

/// The knowledge of a free body.
struct KnownBody {
  enum class Where { kAtStart, kHeld, kAnywhere };
  Where where = Where::kAtStart;
  std::string arm;                  // that holds it
  int drives = 0;                   // before it was picked up
  std::optional<SliderId> carrier;  // whose child it lies in and moves with
  /// The last look for the body. The camera has not moved since then.
  struct Look {
    int points = 0, needed = 0;
  };
  std::optional<Look> look;
};

/// The knowledge of a mobile robot's world before an action. It follows from the start and from the
/// success of the actions before, that is, from the assertions of their controllers' own judgement.
struct KnownState {
  bool is_start = true;    // nothing has moved yet: all is exactly where the start puts it
  ProofAssumptions slack;  // all 0 while nothing has moved
  int drives = 0;          // so far
  /// The place where it drove to; none: where the start put it.
  struct Goal {
    Eigen::Vector2d p = Eigen::Vector2d::Zero();
    double yaw_rad = 0.0, within_m = 0.0, within_rad = 0.0;
  };
  std::optional<Goal> base_at;
  double relief_m = 0.0;             // how far the wheels may have lifted or lowered the base
  Bounds1 lift_m;                    // of the torso
  std::vector<Bounds1> slider_m;     // by SliderId
  std::vector<KnownArm> arms;        // as in MobileRobotSpec
  std::vector<KnownBody> bodies;     // by BodyId
  std::optional<PlaceSpec> gaze;     // where the camera was told to look, from where it is now
  std::vector<std::string> assumed;  // in words, one for each assumption
};

/// The knowledge before the first action, for starts from `region`.
KnownState state_at_start(const WorldSpec& spec, const WorldLayout& layout,
                          const StartCuboid& region);

/// Adds the knowledge that `call` has succeeded as well. Returns a text where nothing can be said
/// any more.
std::optional<std::string> assume_success(const WorldSpec& spec, const WorldLayout& layout,
                                          const std::string& event,
                                          const ControllerSpec& controller,
                                          const Arguments& arguments,
                                          const ProofAssumptions& assumptions, KnownState& state);

/// A point of the world that a place names: where it is and how far it may be from there.
struct KnownPoint {
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
};
/// One of its coordinates, rounded outwards.
AffineForm coordinate(const KnownPoint& point, Eigen::Index axis);
/// None where it lies in the frame of a body of which nothing is known.
std::optional<KnownPoint> locate(const WorldLayout& layout, const KnownState& state,
                                 const std::string& frame, const Eigen::Vector3d& p_F);

/// The target of `drive` and `look`: arguments target.x, .y, .z over the place.
std::optional<KnownPoint> target_of(const WorldLayout& layout, const KnownState& state,
                                    const Arguments& arguments);

}  // namespace parallax::harness
