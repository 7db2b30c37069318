#include "harness/robot/detection_errors.h"

#include <cmath>
#include <numbers>

namespace parallax::harness {
namespace {

/// splitmix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15ULL;
/// Keeps these draws apart from others that the same seed may serve.
constexpr std::uint64_t kStream = 0x6465746563740000ULL;  // "detect"

}  // namespace

void DetectionErrors::reset(std::uint64_t seed) {
  seed_ = mixed(seed ^ kStream);
  draws_ = 0;
  bias_ = draw(spec_.bias_m, spec_.bias_rad);
}

double DetectionErrors::uniform() {
  return static_cast<double>(mixed(seed_ + ++draws_ * kGoldenGamma) >> 11) * 0x1.0p-53;
}

DetectionError DetectionErrors::draw(double rms_m, double rms_rad) {
  // The square of the length of a plane normal vector is exponential: cutting it off is cutting off
  // the range of the uniform number that it is made from.
  const double least = std::exp(-kDetectionCut * kDetectionCut);
  const double length_m = rms_m * std::sqrt(-std::log(least + (1.0 - least) * (1.0 - uniform())));
  const double direction_rad = 2.0 * std::numbers::pi * uniform();
  DetectionError error;
  error.shift_m = length_m * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
  double normal = 0.0;
  do {
    const double length = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    normal = length * std::cos(2.0 * std::numbers::pi * uniform());
  } while (std::abs(normal) > kDetectionCut);
  error.turn_rad = rms_rad * normal;
  return error;
}

DetectionError DetectionErrors::next() {
  const DetectionError noise = draw(spec_.noise_m, spec_.noise_rad);
  return {bias_.shift_m + noise.shift_m, bias_.turn_rad + noise.turn_rad};
}

}  // namespace parallax::harness
