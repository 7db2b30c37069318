#include "tools/bench/search/search_worlds.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/base/contract.h"
#include "harness/search/search_rng.h"

namespace parallax::bench {
namespace {

using harness::UnitPoint;

constexpr std::size_t kPocketDimensions = 4;
/// Where the pocket and the valley of `decoy` lie.
constexpr double kPocket[kPocketDimensions] = {0.7, 0.35, 0.6, 0.3};
constexpr double kValley[kPocketDimensions] = {0.25, 0.7, 0.3, 0.7};
/// The valley's floor, above the border of pockets up to 5 %, and how it rises.
constexpr double kFloor = 0.4, kRise = 0.3;

/// A weighted mean in which each coordinate counts less than the one before.
double slanted(const UnitPoint& point) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < point.size(); ++i) {
    const double weight = 1.0 / static_cast<double>(i + 1);
    sum += weight * point[i];
    weights += weight;
  }
  return sum / weights;
}

double distance_from(const UnitPoint& point, const double (&centre)[kPocketDimensions]) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kPocketDimensions; ++i) {
    sum += (point[i] - centre[i]) * (point[i] - centre[i]);
  }
  return std::sqrt(sum);
}

double ridge(const UnitPoint& point) {
  const double curve = 0.5 + 0.35 * std::sin(2.0 * std::numbers::pi * point[0]);
  double aside = 0.0;
  for (std::size_t i = 2; i < point.size(); ++i) aside += (point[i] - 0.5) * (point[i] - 0.5);
  if (point.size() > 2) aside /= static_cast<double>(point.size() - 2);
  return std::abs(point[1] - curve) + 0.25 * (1.0 - point[0]) + 0.1 * aside;
}

}  // namespace

SearchWorld::SearchWorld(std::string_view name, std::size_t dimensions, std::vector<double> shares,
                         std::size_t sample_size)
    : name_(name), dimensions_(dimensions), shares_(std::move(shares)) {
  PARALLAX_REQUIRE(dimensions >= kPocketDimensions, "room for the pocket");
  harness::SearchRng rng(0x776f726c64ULL, dimensions);
  std::vector<float> heights(sample_size);
  UnitPoint point(dimensions);
  for (auto& one : heights) {
    for (auto& value : point) value = rng.uniform();
    one = static_cast<float>(height(point));
  }
  for (const double share : shares_) {
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(sample_size));
    std::nth_element(heights.begin(), heights.begin() + at, heights.end());
    borders_.push_back(static_cast<double>(heights[static_cast<std::size_t>(at)]));
  }
}

double SearchWorld::height(const UnitPoint& point) const {
  if (name_ == "edge") return 1.0 - slanted(point);
  if (name_ == "band") return std::abs(slanted(point) - 0.55);
  if (name_ == "corner") return 1.0 - *std::min_element(point.begin(), point.end());
  if (name_ == "ridge") return ridge(point);
  const double pocket = distance_from(point, kPocket);
  if (name_ == "flat") return pocket;
  return std::min(pocket, kFloor + kRise * distance_from(point, kValley));
}

harness::Evaluation SearchWorld::evaluate(const UnitPoint& point, std::size_t share) const {
  const double above = height(point) - borders_[share];
  harness::Evaluation out;
  out.point = point;
  out.kind = above < 0.0 ? harness::EvaluationKind::kDiscrepancy : harness::EvaluationKind::kClean;
  out.margin = is_flat() ? (above < 0.0 ? -1.0 : 1.0) : above;
  return out;
}

const std::vector<std::string>& search_world_names() {
  static const std::vector<std::string> names = {"edge",  "band",  "corner",
                                                 "ridge", "decoy", "flat"};
  return names;
}

}  // namespace parallax::bench
