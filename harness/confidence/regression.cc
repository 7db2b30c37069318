// Least squares over rows that come one at a time.
//
// Only the triangle of the QR decomposition of [D Y] is kept. A row is turned into it by Givens
// rotations, each of which makes one entry of the row zero. The triangle has the coefficients,
// the squared residuals (what is left of an outcome's column below the design's) and the inverse
// that leverages need; the normal equations, which would square the condition number, are never
// formed. Columns that depend on each other show in a pivoted decomposition of the triangle, and
// there is no fit then.
//
// Cost for k columns and m outcomes: (k + m)^2 for a row and k^3 for a fit, however many rows
// came before.

#include "harness/confidence/regression.h"

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <numbers>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

Eigen::VectorXd with_one(const Eigen::VectorXd& x) {
  Eigen::VectorXd v(x.size() + 1);
  v << 1.0, x;
  return v;
}

double number_in(const State& state, const std::string& name) {
  const auto found = state.find(name);
  if (found == state.end()) return std::numeric_limits<double>::quiet_NaN();
  if (const auto* real = std::get_if<double>(&found->second)) return *real;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*whole);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// Does some regressed variable belong to the body that the fluent is about?
bool is_covered(const GroundFluent& fluent, const InsideBinding& binding,
                const std::map<std::string, Interval>& cells) {
  const std::string prefix = with_arguments(binding.body, fluent) + ".";
  const auto first = cells.lower_bound(prefix);
  return first != cells.end() && first->first.starts_with(prefix);
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
  // The part of the outcome outside the column space of D.
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

RegressionFrame regression_frame(const StateMapping& mapping, const StartCuboid& start,
                                 const std::vector<GroundFluent>& fluents,
                                 const std::set<std::string>& final_true) {
  RegressionFrame frame;
  for (const auto& dimension : start.dimensions) {
    frame.x_names.push_back(dimension.variable);
    frame.x_range.push_back(dimension.interval);
  }
  const auto cells = mapping.cells(fluents, final_true);
  for (const auto& [variable, cell] : cells) {
    frame.y_names.push_back(variable);
    frame.y_cell.emplace_back(cell);
  }
  for (const auto& fluent : fluents) {
    const FluentBinding* binding = mapping.find(fluent.symbol);
    PARALLAX_REQUIRE(binding != nullptr, "the mapping was checked against the model's fluents");
    if (binding->is_ignored() || binding->at_start_only()) continue;
    const auto* inside = binding->inside();
    if (inside != nullptr && is_covered(fluent, *inside, cells)) continue;
    frame.not_covered.push_back(fluent.text);
  }
  return frame;
}

std::vector<double> row_of(const State& state, std::span<const std::string> names,
                           std::span<const Interval> around) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  std::vector<double> row;
  for (std::size_t i = 0; i < names.size(); ++i) {
    double value = number_in(state, names[i]);
    if (is_angle(names[i]) && i < around.size()) {
      value -= kTurn * std::round((value - around[i].midpoint()) / kTurn);
    }
    row.push_back(value);
  }
  return row;
}

void add_clean_run(Tally& tally, const State& initial, const State& last) {
  const RegressionFrame& frame = tally.frame();
  std::vector<Interval> cells;
  for (const auto& cell : frame.y_cell) cells.push_back(cell.value_or(Interval{}));
  tally.add_clean(row_of(initial, frame.x_names, frame.x_range),
                  row_of(last, frame.y_names, cells));
}

}  // namespace parallax::harness
