// Draws from a distribution restricted to an interval, by inversion (Devroye 1986).
//
// A number u between 0 and 1 becomes the value with mass from + u (to - from) below it, where
// from and to are the masses below the ends of the interval. No draw is thrown away, however
// little mass the interval has. Far above the middle these masses are nearly 1 and their
// difference is lost in rounding; there all is mirrored and masses are counted from the upper
// tail, in which they are exact. An interval without any mass that a double can tell has no law.
// A choice of values keeps those in the interval, with their weights.
//
// Cost: constant, and linear in the values of a choice.

#include "harness/law/distribution.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "harness/confidence/quantiles.h"

namespace parallax::harness {
namespace {

constexpr double kLeastMass = 1e-300;
constexpr double kNormalReach = 9.0;  // standard deviations

/// Mass of the standard normal distribution below z, exact in the lower tail.
double normal_mass_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// Mass of a triangular distribution below (or, where `above`, above) a value.
double triangular_mass(const Distribution& law, double value, bool above) {
  const double width = law.upper - law.lower;
  const double x = std::clamp(value, law.lower, law.upper);
  if (x <= law.mode) {
    const double below = law.mode == law.lower
                             ? 0.0
                             : (x - law.lower) * (x - law.lower) / (width * (law.mode - law.lower));
    return above ? 1.0 - below : below;
  }
  const double beyond = (law.upper - x) * (law.upper - x) / (width * (law.upper - law.mode));
  return above ? beyond : 1.0 - beyond;
}

/// The value with probability `mass` below (or above) it.
double triangular_value(const Distribution& law, double mass, bool above) {
  const double width = law.upper - law.lower;
  const double at_mode = (law.mode - law.lower) / width;  // below the mode
  const bool left = above ? mass >= 1.0 - at_mode : mass <= at_mode;
  if (left) {
    const double below = above ? 1.0 - mass : mass;
    return law.lower + std::sqrt(std::max(below, 0.0) * width * (law.mode - law.lower));
  }
  const double beyond = above ? mass : 1.0 - mass;
  return law.upper - std::sqrt(std::max(beyond, 0.0) * width * (law.upper - law.mode));
}

}  // namespace

Interval Distribution::support() const {
  switch (kind) {
    case Kind::kUniform:
    case Kind::kTriangular:
      return {lower, upper, false};
    case Kind::kNormal:
      return {mean - kNormalReach * sd, mean + kNormalReach * sd, false};
    case Kind::kChoice:
      break;
  }
  const double last = values.back().first;
  if (values.size() == 1) return {last, last, true};
  // Half open as the others, so that a cell that begins at the last value has it.
  return {values.front().first, std::nextafter(last, std::numeric_limits<double>::infinity()),
          false};
}

std::string Distribution::text() const {
  switch (kind) {
    case Kind::kUniform:
      return "uniform";
    case Kind::kNormal:
      return fmt::format("normal with mean {} and sd {}", mean, sd);
    case Kind::kTriangular:
      return fmt::format("triangular over {} to {} with mode {}", lower, upper, mode);
    case Kind::kChoice:
      break;
  }
  double sum = 0.0;
  for (const auto& value : values) sum += value.second;
  std::vector<std::string> parts;
  for (const auto& [value, weight] : values) {
    parts.push_back(fmt::format("{} ({:.4g} %)", value, 100.0 * weight / sum));
  }
  return fmt::format("{}", fmt::join(parts, " or "));
}

std::optional<ConditionedLaw> ConditionedLaw::make(Distribution distribution,
                                                   const Interval& cell) {
  ConditionedLaw out(std::move(distribution), cell);
  auto& law = out.law_;
  switch (law.kind) {
    case Distribution::Kind::kUniform:
      out.cell_.lower = std::max(cell.lower, law.lower);
      out.cell_.upper = std::min(cell.upper, law.upper);
      if (!(out.cell_.lower < out.cell_.upper)) return std::nullopt;
      return out;
    case Distribution::Kind::kNormal: {
      double a = (cell.lower - law.mean) / law.sd, b = (cell.upper - law.mean) / law.sd;
      out.mirrored_ = a + b > 0.0;
      if (out.mirrored_) a = -a, b = -b;
      out.from_ = normal_mass_below(a);
      out.to_ = normal_mass_below(b);
      break;
    }
    case Distribution::Kind::kTriangular:
      out.mirrored_ = cell.lower + cell.upper > 2.0 * law.mode;
      out.from_ = triangular_mass(law, cell.lower, out.mirrored_);
      out.to_ = triangular_mass(law, cell.upper, out.mirrored_);
      break;
    case Distribution::Kind::kChoice:
      std::erase_if(law.values, [&](const auto& value) { return !cell.contains(value.first); });
      if (law.values.empty()) return std::nullopt;
      return out;
  }
  if (!(std::max(out.from_, out.to_) > kLeastMass) || out.from_ == out.to_) return std::nullopt;
  return out;
}

double ConditionedLaw::at(double u) const {
  switch (law_.kind) {
    case Distribution::Kind::kUniform:
      return std::clamp(cell_.lower + u * (cell_.upper - cell_.lower), cell_.lower,
                        std::nextafter(cell_.upper, cell_.lower));
    case Distribution::Kind::kChoice: {
      double sum = 0.0;
      for (const auto& value : law_.values) sum += value.second;
      double left = u * sum;
      std::size_t i = 0;
      while (i + 1 < law_.values.size() && left >= law_.values[i].second) {
        left -= law_.values[i++].second;
      }
      return law_.values[i].first;
    }
    case Distribution::Kind::kNormal:
    case Distribution::Kind::kTriangular:
      break;
  }
  const double mass = from_ + u * (to_ - from_);
  double value = 0.0;
  if (law_.kind == Distribution::Kind::kTriangular) {
    value = triangular_value(law_, mass, mirrored_);
  } else if (mass < kLeastMass) {
    value = mirrored_ ? cell_.upper : cell_.lower;
  } else if (mass >= 1.0) {
    value = mirrored_ ? cell_.lower : cell_.upper;
  } else {
    const double z = normal_quantile(mass);
    value = law_.mean + law_.sd * (mirrored_ ? -z : z);
  }
  return std::clamp(value, cell_.lower, std::nextafter(cell_.upper, cell_.lower));
}

}  // namespace parallax::harness
