// A mixture of normal laws fitted to weighted points by expectation maximization.
//
// For one to four parts: centres are drawn far from each other (Arthur and Vassilvitskii 2007),
// each begins with the spread of the points nearest to it, and some rounds assign points to
// parts by density and recompute shares, means and covariances. Schwarz's criterion (1978)
// chooses the number of parts, with the effective number of points. Few points look narrower
// than the law they come from, so small parts get a wider covariance and weaker correlations; a
// floor keeps each covariance positive definite, and at the end all deviations are widened by a
// quarter, as tails that are too short cost more than wide ones. Covariances are kept as
// Cholesky factors, by which points are drawn and densities found.
//
// Cost: at most 15 rounds for each number of parts, each points * parts * dimensions^2.

#include "harness/search/normal_mixture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

constexpr std::size_t kMostParts = 4;
constexpr int kRounds = 15;
constexpr double kEnough = 1e-4;  // gain of the mean logarithm that is worth another round
constexpr double kWiden = 1.25;   // of deviations
constexpr double kLeastDeviation = 1e-7;
constexpr double kFewDeviation = 0.05;  // about points that are too few to show one
constexpr double kNegligible = 40.0;    // in the exponent

std::size_t at(std::size_t row, std::size_t column) { return row * (row + 1) / 2 + column; }

double total_weight(const std::vector<WeightedPoint>& points) {
  double sum = 0.0;
  for (const auto& one : points) sum += one.weight;
  return sum;
}

/// As many equally weighted points say as much.
double effective_size(const std::vector<WeightedPoint>& points) {
  double sum = 0.0, squares = 0.0;
  for (const auto& one : points) {
    sum += one.weight;
    squares += one.weight * one.weight;
  }
  return sum * sum / squares;
}

double parameters(std::size_t parts, std::size_t dimensions) {
  const auto d = static_cast<double>(dimensions);
  return static_cast<double>(parts) * (1.0 + d + 0.5 * d * (d + 1.0)) - 1.0;
}

}  // namespace

void NormalMixture::set_covariance(Part& part, std::vector<double> covariance, double floor) {
  const auto d = part.mean.size();
  for (std::size_t i = 0; i < d; ++i) covariance[at(i, i)] += floor * floor;
  for (std::size_t i = 0; i < d; ++i) {
    for (std::size_t k = 0; k <= i; ++k) {
      double sum = covariance[at(i, k)];
      for (std::size_t j = 0; j < k; ++j) sum -= covariance[at(i, j)] * covariance[at(k, j)];
      covariance[at(i, k)] =
          i == k ? std::sqrt(std::max(sum, floor * floor)) : sum / covariance[at(k, k)];
    }
  }
  part.root = std::move(covariance);
  part.log_scale = -0.5 * static_cast<double>(d) * std::log(2.0 * std::numbers::pi);
  for (std::size_t i = 0; i < d; ++i) part.log_scale -= std::log(part.root[at(i, i)]);
}

double NormalMixture::log_density(const Part& part, const UnitPoint& point) {
  constexpr std::size_t kUsual = 16;
  double small[kUsual];
  std::vector<double> large;
  const auto d = point.size();
  double* solved = small;
  if (d > kUsual) {
    large.resize(d);
    solved = large.data();
  }
  double square = 0.0;
  const double* row = part.root.data();
  for (std::size_t i = 0; i < d; ++i) {
    double sum = point[i] - part.mean[i];
    for (std::size_t k = 0; k < i; ++k) sum -= row[k] * solved[k];
    solved[i] = sum / row[i];
    square += solved[i] * solved[i];
    // Too little to count, even if the density at the mean is very large.
    if (0.5 * square - std::max(0.0, part.log_scale) > kNegligible) return -1e300;
    row += i + 1;
  }
  return part.log_scale - 0.5 * square;
}

double NormalMixture::density(const UnitPoint& point) const {
  double sum = 0.0;
  for (const auto& part : parts_) sum += part.share * std::exp(log_density(part, point));
  return sum;
}

UnitPoint NormalMixture::draw(SearchRng& rng) const {
  double left = rng.uniform();
  std::size_t which = 0;
  while (which + 1 < parts_.size() && left >= parts_[which].share) left -= parts_[which++].share;
  const auto& part = parts_[which];
  const auto d = part.mean.size();
  UnitPoint normal(d), point(part.mean);
  for (auto& value : normal) value = rng.normal();
  for (std::size_t i = 0; i < d; ++i) {
    for (std::size_t k = 0; k <= i; ++k) point[i] += part.root[at(i, k)] * normal[k];
  }
  return point;
}

std::vector<NormalMixture::Part> NormalMixture::begun(const std::vector<WeightedPoint>& points,
                                                      std::size_t count, SearchRng& rng) {
  // Centres that are far from each other (Arthur and Vassilvitskii 2007).
  const auto d = points.front().point.size();
  std::vector<double> nearest(points.size(), 1.0);
  std::vector<Part> parts;
  while (parts.size() < count) {
    double all = 0.0;
    for (std::size_t i = 0; i < points.size(); ++i) all += points[i].weight * nearest[i];
    double left = rng.uniform() * all;
    std::size_t chosen = 0;
    while (chosen + 1 < points.size() && left >= points[chosen].weight * nearest[chosen]) {
      left -= points[chosen].weight * nearest[chosen];
      ++chosen;
    }
    Part part;
    part.mean = points[chosen].point;
    parts.push_back(std::move(part));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double away = squared_distance(points[i].point, points[chosen].point);
      nearest[i] = parts.size() == 1 ? away : std::min(nearest[i], away);
    }
  }
  // Each component begins with the spread of the points nearest to it.
  std::vector<std::vector<double>> covariances(count, std::vector<double>(d * (d + 1) / 2));
  std::vector<double> weights(count);
  for (const auto& one : points) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < count; ++k) {
      if (squared_distance(one.point, parts[k].mean) <
          squared_distance(one.point, parts[best].mean)) {
        best = k;
      }
    }
    weights[best] += one.weight;
    for (std::size_t i = 0; i < d; ++i) {
      const double off = one.point[i] - parts[best].mean[i];
      covariances[best][at(i, i)] += one.weight * off * off;
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    for (auto& value : covariances[k]) value /= std::max(weights[k], 1e-300);
    parts[k].share = 1.0 / static_cast<double>(count);
    set_covariance(parts[k], std::move(covariances[k]), 1e-3);
  }
  return parts;
}

double NormalMixture::improve(const std::vector<WeightedPoint>& points, std::vector<Part>& parts) {
  const auto d = points.front().point.size();
  const auto n_d = static_cast<double>(d);
  const auto count = parts.size();
  const double all = total_weight(points);
  std::vector<double> belongs(points.size() * count);
  double mean_log = 0.0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    double most = -1e300;
    double* logs = &belongs[n * count];
    for (std::size_t k = 0; k < count; ++k) {
      logs[k] = std::log(parts[k].share) + log_density(parts[k], points[n].point);
      most = std::max(most, logs[k]);
    }
    double sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) sum += std::exp(logs[k] - most);
    mean_log += points[n].weight / all * (most + std::log(sum));
    for (std::size_t k = 0; k < count; ++k) {
      logs[k] = points[n].weight * std::exp(logs[k] - most) / sum;
    }
  }
  const double size = effective_size(points);
  for (std::size_t k = 0; k < count; ++k) {
    double weight = 1e-300;
    std::vector<double> mean(d), covariance(d * (d + 1) / 2);
    for (std::size_t n = 0; n < points.size(); ++n) {
      const double own = belongs[n * count + k];
      weight += own;
      for (std::size_t i = 0; i < d; ++i) mean[i] += own * points[n].point[i];
    }
    for (auto& value : mean) value /= weight;
    for (std::size_t n = 0; n < points.size(); ++n) {
      const double own = belongs[n * count + k] / weight;
      if (own < 1e-12) continue;
      for (std::size_t i = 0; i < d; ++i) {
        const double off = own * (points[n].point[i] - mean[i]);
        for (std::size_t j = 0; j <= i; ++j) {
          covariance[at(i, j)] += off * (points[n].point[j] - mean[j]);
        }
      }
    }
    // Few points are narrower than what they come from, and say little of correlations.
    const double own_size = std::max(1.0, size * weight / all);
    const double kept = own_size < 2.0 * (n_d + 1.0) ? own_size / (own_size + n_d) : 1.0;
    const double wider = own_size / std::max(0.5 * own_size, own_size - n_d);
    double largest = 0.0;
    for (std::size_t i = 0; i < d; ++i) {
      largest = std::max(largest, covariance[at(i, i)]);
      covariance[at(i, i)] *= wider;
      for (std::size_t j = 0; j < i; ++j) covariance[at(i, j)] *= kept * wider;
    }
    parts[k].mean = std::move(mean);
    parts[k].share = std::max(weight / all, 1e-12);
    set_covariance(parts[k], std::move(covariance),
                   points.size() < d + 2 ? kFewDeviation
                                         : std::max(kLeastDeviation, 1e-6 * std::sqrt(largest)));
  }
  return mean_log;
}

void NormalMixture::widen() {
  double sum = 0.0;
  for (auto& part : parts_) {
    for (auto& value : part.root) value *= kWiden;
    part.log_scale -= static_cast<double>(part.mean.size()) * std::log(kWiden);
    sum += part.share;
  }
  for (auto& part : parts_) part.share /= sum;
}

void NormalMixture::mix(const NormalMixture& other, double share) {
  for (auto& part : parts_) part.share *= 1.0 - share;
  for (auto part : other.parts_) {
    part.share *= share;
    parts_.push_back(std::move(part));
  }
}

NormalMixture NormalMixture::fit(const std::vector<WeightedPoint>& points, SearchRng& rng) {
  PARALLAX_REQUIRE(!points.empty(), "points to fit to");
  const auto d = points.front().point.size();
  const double size = effective_size(points);
  NormalMixture best;
  double best_score = 0.0;
  for (std::size_t count = 1; count <= kMostParts; ++count) {
    // A part needs more points than it has dimensions.
    if (count > 1 && size < static_cast<double>(count * (d + 2))) break;
    auto parts = begun(points, count, rng);
    double mean_log = -1e300;
    for (int round = 0; round < kRounds; ++round) {
      const double now = improve(points, parts);
      const bool settled = now - mean_log < kEnough;
      mean_log = now;
      if (settled && round > 2) break;
    }
    const double score = -2.0 * size * mean_log + parameters(count, d) * std::log(size);
    if (best.parts_.empty() || score < best_score) {
      best.parts_ = std::move(parts);
      best_score = score;
    }
  }
  best.widen();
  return best;
}

}  // namespace parallax::harness
