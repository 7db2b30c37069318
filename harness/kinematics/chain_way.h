#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/kinematics/inverse.h"

namespace parallax::harness {

/// A way of the tool in a straight line, turning evenly, as positions of the joints at even shares
/// of it. Where it ends early, `share` says how far it goes, and why.
struct ChainWay {
  std::vector<JointVector> samples;  // at least the first
  double share = 1.0;                // of the way that the samples cover
  std::string fault;                 // "`elbow` is at its stop"; empty: the whole way

  bool whole() const { return fault.empty(); }
  const JointVector& last() const { return samples.back(); }
  /// The positions at a share of the whole way, by straight lines between the samples. The share is
  /// clamped to the way.
  JointVector at(double share_of_way) const;
  /// The change of the positions per share of the way.
  JointVector slope(double share_of_way) const;

  double step_share = 1.0;  // of the way between samples; the last may be nearer
};

/// Asked of each sample but the first; a text ends the way before it.
using ChainCheck = std::function<std::optional<std::string>(const JointVector&)>;

struct WayOptions {
  double step_m = 0.010, step_rad = 0.035;
  /// A joint that has to turn farther than this in one step is at a place where the tool cannot be
  /// led: the arm would have to jump to another posture.
  double jump = 0.25;  // [rad or m]
};

/// Follows the tool from where `start` has it to `goal`, each sample found from the one before it,
/// so that the arm never changes from one posture to another. Cost: a few steps of least squares
/// for each sample.
ChainWay follow_way(const SerialChain& chain, const JointVector& start,
                    const Eigen::Isometry3d& goal, const WayOptions& options,
                    const ChainCheck& check);

/// All joints at once from `start` to `goal`, evenly, up to `step` [rad or m] between samples; the
/// tool goes where that takes it.
ChainWay swing_way(const JointVector& start, const JointVector& goal, double step);

}  // namespace parallax::harness
