#pragma once

#include <memory>
#include <span>

#include "harness/geometry_proof/geometric_check.h"

namespace parallax::harness {

// Why twice: a certificate claims its verdict for every start of a box, and `--simulate` sees only
// the starts that it draws. Two programs without common code decide each box, when it is proved
// and when the certificate is checked.

/// Decides a test of a controller once more, by other means and without sharing code with the
/// check: shapes are corners, not half widths; places come from the code that starts simulations;
/// what is apart is shown by one fixed direction for a box, what meets by one point that both
/// shapes contain throughout; boxes are cut until that works.
class SecondEvaluation {
 public:
  virtual ~SecondEvaluation() = default;

  /// Is the verdict right everywhere in the box? `effort`: pieces that it may be cut into; false
  /// where that is not enough.
  virtual bool confirms(std::span<const Bounds1> box, BoxVerdict verdict, int effort) const = 0;

  /// Does the test refuse at one start, with everything else in the middle of its range? Safe boxes
  /// promise that it does not even between the places that the controller tries.
  virtual bool refuses_at(std::span<const double> start) const = 0;
};

/// A box that has one start.
StartBox box_at(std::span<const double> start);

/// The second evaluation of `Drive::is_blocked`. All arguments outlive it.
std::unique_ptr<SecondEvaluation> make_second_drive(
    const WorldSpec& spec, const WorldLayout& layout, const StartCuboid& region,
    const KnownState& state, const KnownPoint& target, double yaw_rad, double sweep_step_m);

/// The second evaluations of `require_reach` and of `Perception::look_at`.
std::unique_ptr<SecondEvaluation> make_second_reach(const WorldSpec& spec,
                                                    const WorldLayout& layout,
                                                    const StartCuboid& region,
                                                    const KnownState& state, std::size_t arm,
                                                    std::vector<KnownPoint> points);
std::unique_ptr<SecondEvaluation> make_second_gaze(const WorldSpec& spec, const WorldLayout& layout,
                                                   const StartCuboid& region,
                                                   const KnownState& state,
                                                   const KnownPoint& place);

}  // namespace parallax::harness
