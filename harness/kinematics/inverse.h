#pragma once

#include <cstdint>

#include "harness/kinematics/serial_chain.h"

namespace parallax::harness {

struct InverseOptions {
  double tolerance_m = 1e-4, tolerance_rad = 1e-3;
  /// The weight of a radian of the tool's turn, in metres.
  double radian_as_m = 0.3;
  int steps = 60;     // of one descent
  int restarts = 24;  // after the one from the given start
};

struct InverseResult {
  bool reached = false;
  JointVector q;              // of the nearest that was found, within the stops
  double short_m = 0.0;       // of the tool from its goal
  double short_rad = 0.0;     // of its turn from that wanted
  std::uint32_t at_stop = 0;  // bit i: joint i stands at one of its stops
};

/// Positions that bring the tool to `X_RT`, by damped least squares from `start`: Wampler 1986,
/// with the damping of Levenberg and Marquardt; joints that would leave their range rest at the
/// stop while the others go on. Where a descent ends short, others follow from starts that are
/// spread evenly over the ranges, always the same ones. Hinges without stops start within half a
/// turn. No goal is beyond the numbers: not `reached` means that none was found, not that none is.
InverseResult solve_inverse(const SerialChain& chain, const Eigen::Isometry3d& X_RT,
                            const JointVector& start, const InverseOptions& options = {});

/// Places that are spread evenly over the ranges of the joints, `index` from 1: Halton's sequence.
/// Joints without stops stay within half a turn.
JointVector spread_positions(const SerialChain& chain, int index);

/// Positions from the start that comes `index`-th, from 1, after the given one; no others follow
/// it.
InverseResult solve_inverse_from(const SerialChain& chain, const Eigen::Isometry3d& X_RT, int index,
                                 const InverseOptions& options = {});

/// The error of a pose against another: metres, and then radians along the axis of the turn.
Eigen::Matrix<double, 6, 1> pose_error(const Eigen::Isometry3d& from, const Eigen::Isometry3d& to);

}  // namespace parallax::harness
