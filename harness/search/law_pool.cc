#include "harness/search/law_pool.h"

#include <algorithm>

namespace parallax::harness {
namespace {

constexpr std::size_t kMostFitted = 300;
constexpr double kBehind = 0.2;  // share of the law that is fitted to more points

}  // namespace

void LawPool::add(DefensiveLaw law, const std::vector<Particle>& drawn) {
  const auto draws = static_cast<double>(law.draws);
  for (auto& one : points_) one.density += draws * law.density(one.point);
  laws_.push_back(std::move(law));
  for (const auto& one : drawn) {
    if (one.margin < 0.0) ++discrepancies_;
    if (!any_ || one.margin > worst_) worst_ = one.margin;
    any_ = true;
    Point point{one.point, one.margin, 0.0};
    for (const auto& each : laws_) {
      point.density += static_cast<double>(each.draws) * each.density(one.point);
    }
    points_.push_back(std::move(point));
  }
  std::stable_sort(points_.begin(), points_.end(),
                   [](const Point& a, const Point& b) { return a.margin < b.margin; });
  if (points_.size() > kept_) points_.resize(kept_);
}

double LawPool::probability() const {
  double sum = 0.0;
  for (const auto& one : points_) sum += one.margin < 0.0 ? 1.0 / one.density : 0.0;
  return sum;
}

std::vector<WeightedPoint> LawPool::best(std::size_t count) const {
  std::vector<WeightedPoint> out;
  // Evenly, where there are too many.
  const std::size_t step = (count + kMostFitted - 1) / kMostFitted;
  double sum = 0.0;
  for (std::size_t i = 0; i < count; i += std::max<std::size_t>(step, 1)) {
    out.push_back({points_[i].point, 1.0 / points_[i].density});
    sum += out.back().weight;
  }
  // A single one in the middle of nowhere must not be all that there is.
  const double most = 5.0 * sum / static_cast<double>(std::max<std::size_t>(out.size(), 1));
  for (auto& one : out) one.weight = std::min(one.weight, most);
  return out;
}

std::optional<NormalMixture> LawPool::fit(SearchRng& rng) const {
  const auto enough = 12 + 3 * dimensions_;
  const auto found = static_cast<std::size_t>(
      std::partition_point(points_.begin(), points_.end(),
                           [](const Point& one) { return one.margin < 0.0; }) -
      points_.begin());
  auto count = std::max(found, std::min(points_.size(), enough));
  // Points as bad as the worst give no direction.
  while (count > found && points_[count - 1].margin >= worst_) --count;
  if (count == 0) return std::nullopt;
  auto law = NormalMixture::fit(best(count), rng);
  auto behind = std::min(points_.size(), 2 * count);
  while (behind > count && points_[behind - 1].margin >= worst_) --behind;
  if (behind > count + dimensions_) law.mix(NormalMixture::fit(best(behind), rng), kBehind);
  return law;
}

}  // namespace parallax::harness
