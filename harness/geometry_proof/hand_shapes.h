#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "harness/geometry_proof/geometric_check.h"
#include "harness/geometry_proof/second_evaluation.h"
#include "harness/geometry_proof/sight_error.h"

namespace parallax::harness {

/// One box of the hand at its lowest, in the frame of the body that it is to grip as that is
/// believed to lie; for both ways round that the hand may be turned.
struct HandShape {
  BodyId body;
  std::array<ScenePiece, 2> turned;  // 0: by the grasp's own wrist; 1: by half a circle more
  Bounds1 bottom, top;               // in the world
};

/// A grasp from above.
struct HandDescent {
  BodyId object;
  double wrist_rad = 0.0;  // of the grasp, and with it of the hand against the believed heading
  double error_m = 0.0, error_rad = 0.0;  // of the believed pose as drawn; of the hand's turn
  /// The additional error of the camera, seeing from anywhere in a box of starts.
  std::function<SightError(std::span<const Bounds1>)> seen;
  double clearance_m = 0.0;       // of each pad, as the action asks for it
  double rise_m = 0.0;            // of the way, above its lowest
  std::vector<double> heights_m;  // that are tried, above the lowest
  std::vector<HandShape> shapes;

  /// Which of the ways round are possible where the wrist, before it is brought within a quarter
  /// turn, is in this range.
  std::array<bool, 2> ways_round(const Bounds1& wrist) const;
};

/// How a `pick-up` comes down; none for one that does not come from above or not follow the body,
/// or whose body was seen from elsewhere. Of the camera's errors the greatest is taken. The scene
/// outlives it.
std::optional<HandDescent> descent_of(const ProofScene& scene, std::size_t arm, BodyId object,
                                      const Arguments& arguments);

/// `PickUp::check_last_stretch`, and its second evaluation, which takes no shapes from `descent`.
std::unique_ptr<GeometricCheck> make_hand_check(const ProofScene& scene,
                                                const HandDescent& descent);
std::unique_ptr<SecondEvaluation> make_second_hand(const WorldSpec& spec, const WorldLayout& layout,
                                                   const StartCuboid& region,
                                                   const KnownState& state, std::size_t arm,
                                                   BodyId object, const HandDescent& descent);

/// The greatest distance of the parts of a hand from where its joints have them: the engine holds
/// them there.
inline constexpr double kJointRoom_m = 1e-4;

}  // namespace parallax::harness
