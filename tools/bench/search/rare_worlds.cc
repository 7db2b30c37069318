#include "tools/bench/search/rare_worlds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/base/contract.h"

namespace parallax::bench {
namespace {

constexpr std::size_t kBallDimensions = 4;
constexpr double kFirst[kBallDimensions] = {0.7, 0.35, 0.6, 0.3};
constexpr double kSecond[kBallDimensions] = {0.3, 0.7, 0.35, 0.7};
/// The valley's floor, far above where anything fails, and how it rises.
constexpr double kValleyFloor = 0.3, kValleyRise = 0.3;
constexpr double kMiddle = 0.55;  // of the band

double distance_to(const harness::UnitPoint& point, const double (&centre)[kBallDimensions]) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kBallDimensions; ++i) {
    sum += (point[i] - centre[i]) * (point[i] - centre[i]);
  }
  return std::sqrt(sum);
}

/// Radius of a ball in four dimensions.
double ball_radius(double volume) {
  return std::pow(volume * 2.0 / (std::numbers::pi * std::numbers::pi), 0.25);
}

}  // namespace

RareWorld::RareWorld(std::string name, std::size_t dimensions, double probability)
    : name_(std::move(name)), dimensions_(dimensions), probability_(probability) {
  PARALLAX_REQUIRE(dimensions >= kBallDimensions && probability > 0.0 && probability <= 0.01,
                   "a rare event");
  double sum = 0.0;
  for (std::size_t i = 0; i < dimensions; ++i) {
    slopes_.push_back(1.0 / static_cast<double>(i + 1));
    sum += slopes_.back();
  }
  for (auto& one : slopes_) one /= sum;
  if (name_ == "edge") size_ = border_with_share(probability);
  if (name_ == "hidden") size_ = border_with_share(0.5 * probability);
  if (name_ == "corner") size_ = std::pow(probability, 1.0 / static_cast<double>(dimensions));
  if (name_ == "ridge") size_ = 0.5 * std::sqrt(probability);
  if (name_ == "decoy") radius_ = ball_radius(probability);
  if (name_ == "two" || name_ == "hidden") radius_ = ball_radius(0.5 * probability);
  if (name_ == "band") {
    double low = 0.0, high = 0.4;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      const double share = share_below(kMiddle + middle) - share_below(kMiddle - middle);
      (share < probability ? low : high) = middle;
    }
    size_ = high;
  }
}

double RareWorld::share_below(double border) const {
  // Inclusion and exclusion over the cube's corners below the plane.
  double sum = 0.0, product = 1.0;
  for (const double one : slopes_) product *= one;
  for (std::size_t corner = 0; corner < (std::size_t{1} << dimensions_); ++corner) {
    double left = border, sign = 1.0;
    for (std::size_t i = 0; i < dimensions_; ++i) {
      if ((corner >> i & 1U) == 0) continue;
      left -= slopes_[i];
      sign = -sign;
    }
    if (left > 0.0) sum += sign * std::pow(left, static_cast<double>(dimensions_));
  }
  return sum / product / std::tgamma(static_cast<double>(dimensions_) + 1.0);
}

double RareWorld::border_with_share(double share) const {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (share_below(middle) < share ? low : high) = middle;
  }
  return high;
}

double RareWorld::slanted(const harness::UnitPoint& point) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < dimensions_; ++i) sum += slopes_[i] * point[i];
  return sum;
}

double RareWorld::height(const harness::UnitPoint& point) const {
  if (name_ == "edge") return slanted(point) - size_;
  if (name_ == "band") return std::abs(slanted(point) - kMiddle) - size_;
  if (name_ == "corner") return *std::max_element(point.begin(), point.end()) - size_;
  if (name_ == "ridge") {
    const double curve = 0.5 + 0.35 * std::sin(2.0 * std::numbers::pi * point[0]);
    return std::abs(point[1] - curve) + 0.25 * (1.0 - point[0]) - size_;
  }
  const double first = distance_to(point, kFirst);
  if (name_ == "two") return std::min(first, distance_to(point, kSecond)) - radius_;
  if (name_ == "decoy") {
    return std::min(first, kValleyFloor + kValleyRise * distance_to(point, kSecond)) - radius_;
  }
  // The ball and the edge do not meet.
  return first < radius_ ? -1.0 : slanted(point) - size_;
}

harness::Evaluation RareWorld::evaluate(const harness::UnitPoint& point) const {
  harness::Evaluation out;
  out.margin = height(point);
  if (out.margin < 0.0) out.kind = harness::EvaluationKind::kDiscrepancy;
  return out;
}

const std::vector<std::string>& rare_world_names() {
  static const std::vector<std::string> names = {"edge",  "band", "corner", "ridge",
                                                 "decoy", "two",  "hidden"};
  return names;
}

}  // namespace parallax::bench
