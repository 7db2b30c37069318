// Descent to a discrepancy with a local affine model (after Hasofer and Lind 1974, Rackwitz and
// Fiessler 1978, with a trust region).
//
// Around the best point an affine model of the margin is fitted by least squares through that
// point, near points weighing most; where the points tell nothing of a direction, the slope
// before is kept. The next point lies downhill where the model predicts a margin just below
// zero, or where the trusted radius or the cube ends. Every third point is mirrored instead, as
// a distance from a border grows on both of its sides, and every third is off the way, to learn
// the slope there. Progress widens the radius, steps in vain halve it. A place where nothing
// helps any more is left, and its surroundings are avoided unless they are clearly better.
//
// Cost: for each batch one fit over the best and the latest points, dimensions^2 for each and
// dimensions^3 for the solution.

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "harness/search/strategies.h"

namespace parallax::harness {
namespace {

constexpr double kFirstRadius = 0.5;   // of a step, times the root of the dimension
constexpr double kLeastRadius = 1e-7;  // a place is left where steps have become so short
constexpr double kOvershoot = 0.02;    // beyond the predicted border, as a share of the margin
constexpr double kKeptSlope = 1e-3;    // weight of the slope before, against that of the points
constexpr double kLeftRadius = 0.1;    // around a place that was left, times the root
constexpr std::size_t kFewestPoints = 6;
constexpr std::size_t kTournament = 3;
constexpr std::size_t kNeighbours = 4;  // times the coefficients of an affine model
constexpr std::size_t kLatest = 512;

double root_of(std::size_t dimensions) { return std::sqrt(static_cast<double>(dimensions)); }

/// start - t * direction, kept in the cube.
UnitPoint moved(const UnitPoint& start, const std::vector<double>& direction, double t) {
  UnitPoint point(start);
  for (std::size_t i = 0; i < point.size(); ++i) {
    point[i] = std::clamp(start[i] - t * direction[i], 0.0, 1.0);
  }
  return point;
}

/// The best points and the latest ones: of a long history all that matters.
std::vector<std::size_t> neighbours(const SearchHistory& history) {
  auto out = history.leading();
  const auto& judged = history.judged();
  const auto latest = judged.size() - std::min(kLatest, judged.size());
  out.insert(out.end(), judged.begin() + static_cast<std::ptrdiff_t>(latest), judged.end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

/// How much an affine model with this slope falls from one point to the other.
double predicted_fall(const UnitPoint& from, const UnitPoint& to,
                      const std::vector<double>& slope) {
  double fall = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) fall -= slope[i] * (to[i] - from[i]);
  return fall;
}

}  // namespace

/// Near a place that was left, and not much better: going on from there would end there again.
bool DescentStrategy::is_left(const SearchHistory& history, std::size_t number) const {
  const double radius = kLeftRadius * root_of(history.dimensions());
  return std::any_of(left_.begin(), left_.end(), [&](std::size_t left) {
    return history[number].margin >= 0.9 * history[left].margin &&
           squared_distance(history[number].point, history[left].point) < radius * radius;
  });
}

void DescentStrategy::learn(const SearchHistory& history) {
  bool own_step = false;
  auto centre = centre_;
  for (; seen_ < history.all().size(); ++seen_) {
    const auto& evaluation = history[seen_];
    const bool own =
        std::find(proposed_.begin(), proposed_.end(), evaluation.point) != proposed_.end();
    own_step = own_step || own;
    if (!centre || !std::isfinite(evaluation.margin)) continue;
    if (evaluation.margin < history[*centre].margin && !is_left(history, seen_)) centre = seen_;
  }
  proposed_.clear();
  if (!centre_) return;
  if (centre != centre_) {
    const double distance =
        std::sqrt(squared_distance(history[*centre].point, history[*centre_].point));
    radius_ =
        std::min(std::max(radius_, 2.0 * distance), kFirstRadius * root_of(history.dimensions()));
    in_vain_ = 0;
    centre_ = centre;
  } else if (own_step) {
    ++in_vain_;
    if (in_vain_ % 3 == 0) radius_ *= 0.5;
  }
  if (in_vain_ >= kFewestPoints + history.dimensions() || radius_ < kLeastRadius) {
    left_.push_back(*centre_);
    centre_.reset();
  }
}

/// The best place at first; later places that are merely good, as the best ones lead back.
bool DescentStrategy::choose_centre(const SearchHistory& history) {
  const auto& judged = history.judged();
  if (judged.size() < kFewestPoints) return false;
  std::optional<std::size_t> chosen;
  const auto consider = [&](std::size_t number) {
    if (is_left(history, number)) return;
    if (!chosen || history[number].margin < history[*chosen].margin) chosen = number;
  };
  if (left_.empty()) {
    for (const auto number : judged) consider(number);
  } else {
    for (std::size_t i = 0; i < kTournament; ++i) {
      const auto at = static_cast<std::size_t>(rng_.uniform() * static_cast<double>(judged.size()));
      consider(judged[at]);
    }
  }
  if (!chosen) return false;
  centre_ = chosen;
  radius_ = kFirstRadius * root_of(history.dimensions());
  slope_.assign(history.dimensions(), 0.0);
  in_vain_ = 0;
  return true;
}

/// Least squares through the centre, with weights that fall off with the distance; where the points
/// say nothing, the slope of before stays.
void DescentStrategy::fit_slope(const SearchHistory& history) {
  const auto dimensions = history.dimensions();
  const auto n = static_cast<Eigen::Index>(dimensions);
  const auto& centre = history[*centre_];
  std::vector<std::pair<double, std::size_t>> near;
  for (const auto number : neighbours(history)) {
    const double distance = squared_distance(history[number].point, centre.point);
    if (distance > 0.0) near.emplace_back(distance, number);
  }
  std::sort(near.begin(), near.end());
  if (near.empty()) return;
  near.resize(std::min(near.size(), kNeighbours * (dimensions + 2)));
  const auto enough = std::min(near.size() - 1, dimensions + 1);
  const double width = std::max(near[enough].first, radius_ * radius_);
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  for (const auto& [distance, number] : near) {
    const double weight = std::exp(-distance / width);
    if (weight < 1e-8) break;
    Eigen::VectorXd off(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      off(i) = history[number].point[at] - centre.point[at];
    }
    normal += weight / distance * off * off.transpose();
    right += weight / distance * (history[number].margin - centre.margin) * off;
  }
  const Eigen::Map<Eigen::VectorXd> before(slope_.data(), n);
  const double kept = kKeptSlope * normal.trace() / static_cast<double>(n);
  normal.diagonal().array() += kept;
  right += kept * before;
  const Eigen::VectorXd slope = normal.ldlt().solve(right);
  for (Eigen::Index i = 0; i < n; ++i) slope_[static_cast<std::size_t>(i)] = slope(i);
}

/// The first point on the way down whose predicted margin is below zero, or the one where the
/// trusted region or the cube ends.
UnitPoint DescentStrategy::downhill(const Evaluation& centre) const {
  const double wanted = (1.0 + kOvershoot) * std::max(centre.margin, 0.0);
  const auto too_far = [&](const UnitPoint& point) {
    return squared_distance(point, centre.point) > radius_ * radius_ ||
           predicted_fall(centre.point, point, slope_) > wanted;
  };
  double steepest = 0.0;
  for (const double one : slope_) steepest = std::max(steepest, std::abs(one));
  if (steepest <= 0.0) return centre.point;
  double near = 0.0, far = 1e-9 / steepest;
  for (int i = 0; i < 80 && !too_far(moved(centre.point, slope_, far)); ++i) near = far, far *= 2.0;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (near + far);
    (too_far(moved(centre.point, slope_, middle)) ? far : near) = middle;
  }
  return moved(centre.point, slope_, near);
}

UnitPoint DescentStrategy::step(const SearchHistory& history, std::size_t number) {
  const auto& centre = history[*centre_];
  const auto dimensions = history.dimensions();
  auto point = downhill(centre);
  const double length = std::sqrt(squared_distance(point, centre.point));
  if (number % 3 == 1) {
    // The border may have been passed: a distance from it grows on both of its sides.
    for (std::size_t i = 0; i < dimensions; ++i) {
      point[i] = std::clamp(2.0 * centre.point[i] - point[i], 0.0, 1.0);
    }
  } else if (number % 3 == 2) {
    // Learns the slope in another direction.
    const double wide = length > 0.0 ? length : radius_;
    for (std::size_t i = 0; i < dimensions; ++i) {
      point[i] = std::clamp(point[i] + 0.5 * wide * rng_.normal() / root_of(dimensions), 0.0, 1.0);
    }
  }
  const auto known = neighbours(history);
  const auto tried = [&](std::size_t at) { return history[at].point == point; };
  if (std::any_of(known.begin(), known.end(), tried)) {
    for (auto& value : point) {
      value = std::clamp(value + radius_ * rng_.normal() / root_of(dimensions), 0.0, 1.0);
    }
  }
  return point;
}

std::vector<UnitPoint> DescentStrategy::propose(const SearchHistory& history, std::size_t count) {
  learn(history);
  std::vector<UnitPoint> points;
  const bool has_centre = !history.is_flat() && (centre_ || choose_centre(history));
  if (has_centre) fit_slope(history);
  while (points.size() < count) {
    points.push_back(has_centre ? step(history, in_vain_ + points.size())
                                : uniform_point(rng_, history.dimensions()));
  }
  if (has_centre) proposed_ = points;
  return points;
}

}  // namespace parallax::harness
