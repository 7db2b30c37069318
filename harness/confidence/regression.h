#pragma once

#include <Eigen/Core>
#include <optional>

namespace parallax::harness {

/// Ordinary least squares for one outcome.
struct LinearFit {
  Eigen::VectorXd coefficients;  // (n)
  double intercept = 0.0;        // 0 without one
  bool has_intercept = false;
  double sse = 0.0;              // e'e, squared units of the outcome
  Eigen::Index runs = 0;         // s
  Eigen::Index parameters = 0;   // k = n, plus 1 with an intercept
  Eigen::MatrixXd half_inverse;  // H (k x k) with (D'D)^-1 = H'H, D the design matrix

  Eigen::Index degrees_of_freedom() const { return runs - parameters; }
  double at(const Eigen::VectorXd& x) const { return intercept + coefficients.dot(x); }
  /// v'(D'D)^-1 v for v = x, with a leading 1 if there is an intercept.
  double leverage(const Eigen::VectorXd& x) const;
};

/// Fits y (s) = D b, D = x (s x n) with a leading column of ones if asked for, by QR with column
/// pivoting; the normal equations are never formed. None if the columns are not independent.
std::optional<LinearFit> fit_line(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                  bool with_intercept);

}  // namespace parallax::harness
