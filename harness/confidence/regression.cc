#include "harness/confidence/regression.h"

#include <Eigen/QR>

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

std::optional<LinearFit> fit_line(const Eigen::MatrixXd& x, const Eigen::VectorXd& y,
                                  bool with_intercept) {
  PARALLAX_REQUIRE(x.rows() == y.size(), "one outcome per run");
  const Eigen::Index lead = with_intercept ? 1 : 0;
  Eigen::MatrixXd design(x.rows(), x.cols() + lead);
  if (with_intercept) design.col(0).setOnes();
  design.rightCols(x.cols()) = x;
  const Eigen::Index k = design.cols();
  if (k == 0 || design.rows() < k) return std::nullopt;

  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design);
  if (qr.rank() < k) return std::nullopt;
  const Eigen::VectorXd b = qr.solve(y);

  LinearFit fit;
  fit.coefficients = b.tail(x.cols());
  fit.intercept = with_intercept ? b(0) : 0.0;
  fit.has_intercept = with_intercept;
  fit.sse = (y - design * b).squaredNorm();
  fit.runs = design.rows();
  fit.parameters = k;
  // D P = Q R gives (D'D)^-1 = P R^-1 R^-T P', so H = R^-T P'.
  const Eigen::MatrixXd r = qr.matrixR().topLeftCorner(k, k);
  const Eigen::MatrixXd permutation_t = Eigen::MatrixXd(qr.colsPermutation()).transpose();
  fit.half_inverse = r.triangularView<Eigen::Upper>().transpose().solve(permutation_t);
  return fit;
}

}  // namespace parallax::harness
