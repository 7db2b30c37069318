#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "harness/world/world_spec.h"

namespace parallax::harness {

/// Errors are cut off here, in root mean squares.
inline constexpr double kDetectionCut = 2.0;

/// The error of one estimate of a body.
struct DetectionError {
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();  // in the plane of the floor
  double turn_rad = 0.0;                              // about the vertical
};

/// The errors of a camera that looks for things, drawn from the seed of a run: the same seed and
/// the same questions in the same order give the same answers. Shifts and turns are normal and cut
/// off at twice their root mean square; larger errors are left to misses and confusions.
class DetectionErrors {
 public:
  explicit DetectionErrors(const DetectionSpec& spec) : spec_(spec) { reset(0); }

  void reset(std::uint64_t seed);
  /// The error of the next detection: the run's bias and a noise of its own.
  DetectionError next();
  bool missed() { return uniform() < spec_.miss_rate; }
  bool confused() { return uniform() < spec_.confusion_rate; }

 private:
  double uniform();  // [0, 1)
  DetectionError draw(double rms_m, double rms_rad);

  DetectionSpec spec_;
  std::uint64_t seed_ = 0, draws_ = 0;
  DetectionError bias_;
};

}  // namespace parallax::harness
