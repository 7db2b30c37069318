#include "harness/confidence/regression.h"

#include <Eigen/QR>
#include <cmath>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

Eigen::VectorXd with_one(const Eigen::VectorXd& x) {
  Eigen::VectorXd v(x.size() + 1);
  v << 1.0, x;
  return v;
}

}  // namespace

double LinearFit::leverage(const Eigen::VectorXd& x) const {
  return has_intercept ? (half_inverse * with_one(x)).squaredNorm()
                       : (half_inverse * x).squaredNorm();
}

RunningRegression::RunningRegression(Eigen::Index parameters, Eigen::Index outcomes,
                                     bool with_intercept)
    : with_intercept_(with_intercept),
      columns_(parameters + (with_intercept ? 1 : 0)),
      triangle_(Eigen::MatrixXd::Zero(columns_ + outcomes, columns_ + outcomes)) {}

void RunningRegression::add(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Eigen::Index lead = with_intercept_ ? 1 : 0;
  PARALLAX_REQUIRE(x.size() + lead == columns_ && x.size() + lead + y.size() == triangle_.cols(),
                   "a row as wide as the first");
  Eigen::VectorXd row(triangle_.cols());
  if (with_intercept_) row(0) = 1.0;
  row.segment(lead, x.size()) = x;
  row.tail(y.size()) = y;
  for (Eigen::Index j = 0; j < triangle_.cols(); ++j) {
    const double length = std::hypot(triangle_(j, j), row(j));
    if (length == 0.0) continue;
    const double cosine = triangle_(j, j) / length, sine = row(j) / length;
    for (Eigen::Index column = j; column < triangle_.cols(); ++column) {
      const double above = triangle_(j, column), below = row(column);
      triangle_(j, column) = cosine * above + sine * below;
      row(column) = cosine * below - sine * above;
    }
  }
  ++runs_;
}

std::optional<LinearFit> RunningRegression::fit(Eigen::Index outcome) const {
  if (columns_ == 0 || runs_ < columns_) return std::nullopt;
  const Eigen::MatrixXd design = triangle_.topLeftCorner(columns_, columns_);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design);
  if (qr.rank() < columns_) return std::nullopt;
  const Eigen::Index column = columns_ + outcome;
  const Eigen::VectorXd b = qr.solve(triangle_.col(column).head(columns_));

  LinearFit fit;
  fit.coefficients = with_intercept_ ? b.tail(columns_ - 1) : b;
  fit.intercept = with_intercept_ ? b(0) : 0.0;
  fit.has_intercept = with_intercept_;
  // What of the outcome is not in the space of D.
  fit.sse = triangle_.col(column).segment(columns_, outcome + 1).squaredNorm();
  fit.runs = runs_;
  fit.parameters = columns_;
  // D P = Q R gives (D'D)^-1 = P R^-1 R^-T P', so H = R^-T P'.
  const Eigen::MatrixXd r = qr.matrixR().topLeftCorner(columns_, columns_);
  const Eigen::MatrixXd permutation_t = Eigen::MatrixXd(qr.colsPermutation()).transpose();
  fit.half_inverse = r.triangularView<Eigen::Upper>().transpose().solve(permutation_t);
  return fit;
}

std::optional<LinearFit> fit_line(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                  bool with_intercept) {
  PARALLAX_REQUIRE(x.rows() == y.size(), "one outcome per run");
  RunningRegression rows(x.cols(), 1, with_intercept);
  for (Eigen::Index row = 0; row < x.rows(); ++row) rows.add(x.row(row), y.segment(row, 1));
  return rows.fit(0);
}

}  // namespace parallax::harness
