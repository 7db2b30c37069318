// Regression by a Gaussian process (Rasmussen and Williams 2006, algorithm 2.1).
//
// The covariance of the points is factored once (Cholesky); a prediction is then a product with
// the weights, and its variance comes from one triangular solve. The overall variance that makes
// the likelihood greatest is known in closed form; lengths, noise and the weight of the linear
// part are searched: a small grid at first, then one step up or down along each coordinate, with
// a prior that keeps the lengths of the dimensions near each other. That is repeated as the
// number of points has grown by a quarter. A believed value appends one row to the factor, so
// that several points can be proposed at once.
//
// Cost for n points: n^3 for each shape that is tried, n^2 for a prediction or a believed value.

#include "harness/search/gaussian_process.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLogPriorWidth = 1.5;  // of a dimension's log length around the common one

/// Cholesky in place, row by row, of the lower triangle; plain loops compile in no time.
bool cholesky(MatrixXd& a) {
  const Index n = a.rows();
  for (Index j = 0; j < n; ++j) {
    if (j > 0) {
      a.col(j).tail(n - j) -= a.block(j, 0, n - j, j) * a.row(j).head(j).transpose();
    }
    if (!(a(j, j) > 0.0)) return false;
    a.col(j).tail(n - j) /= std::sqrt(a(j, j));
  }
  return true;
}

/// lower^-1 x, and lower'^-1 x.
VectorXd solve_forward(const MatrixXd& lower, VectorXd x) {
  const Index n = x.size();
  for (Index j = 0; j < n; ++j) {
    x(j) /= lower(j, j);
    x.tail(n - j - 1) -= x(j) * lower.col(j).segment(j + 1, n - j - 1);
  }
  return x;
}
VectorXd solve_backward(const MatrixXd& lower, VectorXd x) {
  const Index n = x.size();
  for (Index j = n - 1; j >= 0; --j) {
    x(j) -= lower.col(j).segment(j + 1, n - j - 1).dot(x.tail(n - j - 1));
    x(j) /= lower(j, j);
  }
  return x;
}

VectorXd as_vector(const std::vector<double>& point) {
  return Eigen::Map<const VectorXd>(point.data(), static_cast<Index>(point.size()));
}

}  // namespace

GaussianProcess::GaussianProcess(std::size_t dimensions, Kind kind)
    : dimensions_(static_cast<Index>(dimensions)), kind_(kind) {}

double GaussianProcess::covariance(const VectorXd& a, const VectorXd& b, const Shape& shape) const {
  const double r = ((a - b).array() * shape.log_scales.array().exp()).matrix().norm();
  const double s = std::sqrt(5.0) * r;
  double out = (1.0 + s + s * s / 3.0) * std::exp(-s);
  if (kind_.linear) {
    out += std::exp(shape.log_linear) * (a.array() - 0.5).matrix().dot((b.array() - 0.5).matrix());
  }
  return out;
}

bool GaussianProcess::factor(const Shape& shape, MatrixXd& lower) const {
  lower.resize(count_, count_);
  const VectorXd scales = shape.log_scales.array().exp();
  MatrixXd scaled = scales.asDiagonal() * points_.leftCols(count_);
  const MatrixXd centred = (points_.leftCols(count_).array() - 0.5).matrix();
  const double linear = kind_.linear ? std::exp(shape.log_linear) : 0.0;
  const double noise = std::exp(shape.log_noise);
  const double root5 = std::sqrt(5.0);
  for (Index j = 0; j < count_; ++j) {
    for (Index i = j; i < count_; ++i) {
      const double s = root5 * (scaled.col(i) - scaled.col(j)).norm();
      double value = (1.0 + s + s * s / 3.0) * std::exp(-s);
      if (linear > 0.0) value += linear * centred.col(i).dot(centred.col(j));
      lower(i, j) = i == j ? value + noise : value;
    }
  }
  return cholesky(lower);
}

/// Log likelihood with the variance that makes it greatest, and the prior of the lengths.
double GaussianProcess::score(const Shape& shape) const {
  MatrixXd lower;
  if (!factor(shape, lower)) return -std::numeric_limits<double>::infinity();
  const VectorXd half = solve_forward(lower, values_.head(count_));
  const auto n = static_cast<double>(count_);
  const double variance = std::max(half.squaredNorm() / n, 1e-300);
  const double common = shape.log_scales.mean();
  const double apart = (shape.log_scales.array() - common).square().sum();
  return -0.5 * n * std::log(variance) - lower.diagonal().array().log().sum() -
         0.5 * apart / (kLogPriorWidth * kLogPriorWidth);
}

void GaussianProcess::choose_shape() {
  double best = -std::numeric_limits<double>::infinity();
  const auto consider = [&](const Shape& shape) {
    const double value = score(shape);
    if (!(value > best)) return false;
    best = value;
    shape_ = shape;
    return true;
  };
  if (fitted_at_ == 0) {
    for (const double length : {0.25, 0.5, 1.0, 2.0}) {
      for (const double linear : {1e-3, 1.0, 30.0}) {
        Shape shape;
        const double across = length * std::sqrt(static_cast<double>(dimensions_) / 4.0);
        shape.log_scales = VectorXd::Constant(dimensions_, -std::log(across));
        shape.log_linear = std::log(linear);
        shape.log_noise = std::log(1e-4);
        consider(shape);
        if (!kind_.linear) break;
      }
    }
  } else {
    consider(Shape(shape_));
  }
  // Once along each coordinate, twice as far or half as far.
  const auto along = [&](auto&& change) {
    for (const double step : {std::log(2.0), -std::log(2.0)}) {
      Shape shape = shape_;
      change(shape, step);
      if (consider(shape)) break;
    }
  };
  along([](Shape& shape, double step) { shape.log_scales.array() += step; });
  along([](Shape& shape, double step) {
    shape.log_noise = std::clamp(shape.log_noise + 3.0 * step, std::log(1e-8), std::log(1.0));
  });
  if (kind_.linear) {
    along([](Shape& shape, double step) {
      shape.log_linear = std::clamp(shape.log_linear + 2.0 * step, std::log(1e-4), std::log(1e3));
    });
  }
  if (!kind_.one_length) {
    for (Index d = 0; d < dimensions_; ++d) {
      along([d](Shape& shape, double step) { shape.log_scales(d) += step; });
    }
  }
  fitted_at_ = count_;
}

void GaussianProcess::fit(const Points& points, const std::vector<double>& values) {
  PARALLAX_REQUIRE(points.size() == values.size() && points.size() >= 2, "points with values");
  count_ = static_cast<Index>(points.size());
  points_.resize(dimensions_, count_);
  values_.resize(count_);
  for (Index i = 0; i < count_; ++i) {
    points_.col(i) = as_vector(*points[static_cast<std::size_t>(i)]);
    values_(i) = values[static_cast<std::size_t>(i)];
  }
  offset_ = values_.mean();
  unit_ = std::sqrt((values_.array() - offset_).square().mean());
  if (!(unit_ > 0.0)) unit_ = 1.0;
  values_ = (values_.array() - offset_) / unit_;
  if (fitted_at_ == 0 || 4 * count_ >= 5 * fitted_at_) choose_shape();
  while (!factor(shape_, lower_)) shape_.log_noise += std::log(10.0);
  solve();
}

void GaussianProcess::solve() {
  const VectorXd half = solve_forward(lower_, values_.head(count_));
  variance_ = std::max(half.squaredNorm() / static_cast<double>(count_), 1e-300);
  weights_ = solve_backward(lower_, half);
}

void GaussianProcess::believe(const std::vector<double>& point) {
  const VectorXd at = as_vector(point);
  VectorXd row(count_);
  for (Index i = 0; i < count_; ++i) row(i) = covariance(points_.col(i), at, shape_);
  const double mean = row.dot(weights_);
  const VectorXd half = solve_forward(lower_, row);
  const double rest = covariance(at, at, shape_) + std::exp(shape_.log_noise) - half.squaredNorm();
  const double kept = variance_;
  points_.conservativeResize(Eigen::NoChange, count_ + 1);
  points_.col(count_) = at;
  values_.conservativeResize(count_ + 1);
  values_(count_) = mean;
  lower_.conservativeResize(count_ + 1, count_ + 1);
  lower_.row(count_).head(count_) = half.transpose();
  lower_(count_, count_) = std::sqrt(std::max(rest, 1e-12));
  ++count_;
  solve();
  variance_ = kept;
}

GaussianProcess::Prediction GaussianProcess::predict(const std::vector<double>& point) const {
  const VectorXd at = as_vector(point);
  VectorXd row(count_);
  for (Index i = 0; i < count_; ++i) row(i) = covariance(points_.col(i), at, shape_);
  const double rest = covariance(at, at, shape_) - solve_forward(lower_, row).squaredNorm();
  return {offset_ + unit_ * row.dot(weights_), unit_ * std::sqrt(variance_ * std::max(rest, 0.0))};
}

}  // namespace parallax::harness
