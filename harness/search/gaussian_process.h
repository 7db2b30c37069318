#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace parallax::harness {

/// Regression by a Gaussian process (Rasmussen and Williams 2006, algorithm 2.1): constant mean,
/// Matern covariance of smoothness 5/2, with a length for each dimension, plus, if wanted, a linear
/// one. Lengths, weights and noise are those of the greatest likelihood that a search along the
/// coordinates finds; it is repeated as the number of points grows by a quarter.
class GaussianProcess {
 public:
  struct Kind {
    bool one_length = false;  // the same in all dimensions
    bool linear = true;
  };
  GaussianProcess(std::size_t dimensions, Kind kind);

  using Points = std::vector<const std::vector<double>*>;
  void fit(const Points& points, const std::vector<double>& values);
  /// Takes the mean at the point for a value that was seen there.
  void believe(const std::vector<double>& point);

  struct Prediction {
    double mean = 0.0, deviation = 0.0;
  };
  Prediction predict(const std::vector<double>& point) const;
  std::size_t size() const { return static_cast<std::size_t>(count_); }

 private:
  struct Shape {
    Eigen::VectorXd log_scales;  // of the inverse lengths
    double log_linear = 0.0;     // weight of the linear part
    double log_noise = 0.0;
  };
  double covariance(const Eigen::VectorXd& a, const Eigen::VectorXd& b, const Shape& shape) const;
  /// Cholesky factor of the points' covariance; false: not positive definite.
  bool factor(const Shape& shape, Eigen::MatrixXd& lower) const;
  double score(const Shape& shape) const;
  void choose_shape();
  void solve();

  Eigen::Index dimensions_;
  Kind kind_;
  Shape shape_;
  Eigen::Index fitted_at_ = 0;  // number of points when the shape was chosen
  Eigen::Index count_ = 0;
  Eigen::MatrixXd points_;  // (dimensions x count)
  Eigen::VectorXd values_;  // standardized
  double offset_ = 0.0, unit_ = 1.0;
  Eigen::MatrixXd lower_;    // (count x count), its lower triangle
  Eigen::VectorXd weights_;  // covariance^-1 values
  double variance_ = 1.0;
};

}  // namespace parallax::harness
