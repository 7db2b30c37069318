#pragma once

#include <Eigen/Core>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "harness/confidence/tally.h"
#include "harness/region/state_mapping.h"

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

/// Least squares of several outcomes over the same rows, which come one at a time: y (s) = D b with
/// D = x (s x n) and a leading column of ones if asked for. Kept is the triangle of the QR
/// decomposition of [D Y], turned on with each row, so a row costs O((k + m)^2) and a fit O(k^3)
/// whatever s is. The normal equations are never formed.
class RunningRegression {
 public:
  RunningRegression(Eigen::Index parameters, Eigen::Index outcomes, bool with_intercept);
  /// One row of finite numbers: x (n), y (m).
  void add(const Eigen::VectorXd& x, const Eigen::VectorXd& y);
  Eigen::Index runs() const { return runs_; }
  /// None if the columns of D are not independent.
  std::optional<LinearFit> fit(Eigen::Index outcome) const;

 private:
  bool with_intercept_;
  Eigen::Index columns_;      // k, of D
  Eigen::Index runs_ = 0;     // s
  Eigen::MatrixXd triangle_;  // (k + m x k + m), upper
};

/// The same for one outcome y (s) over x (s x n).
std::optional<LinearFit> fit_line(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                  bool with_intercept);

/// The continuous parameters of one trace: the start cuboid's dimensions on one side, and on the
/// other the variables that the expected final state (`final_true` among `fluents`) pins to a
/// region. Booleans never enter a regression; the fluents that rest on them, or that say where a
/// body is not, end in `not_covered`.
RegressionFrame regression_frame(const StateMapping& mapping, const StartCuboid& start,
                                 const std::vector<GroundFluent>& fluents,
                                 const std::set<std::string>& final_true);

/// The values of `names` in `state`; NaN where the state has no number. Angles are unwrapped to
/// within half a turn of the midpoint of their interval in `around` (same length, or empty).
std::vector<double> row_of(const State& state, std::span<const std::string> names,
                           std::span<const Interval> around);

/// One clean run: the start that was drawn and the last observation.
void add_clean_run(Tally& tally, const State& initial, const State& last);

}  // namespace parallax::harness
