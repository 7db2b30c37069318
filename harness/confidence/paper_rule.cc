// The stop rule of Meywerk et al., Section III-C, in several readings.
//
// Final parameters are regressed on the initial ones that vary (regression.cc). For each tested
// one an interval is taken over the whole cuboid of starts; the rule holds if every interval
// lies in its expected cell. The paper's interval is the range of the fitted mean, widened by z
// sigma / sqrt(s). A prediction interval is extreme at corners of the cuboid, since the mean is
// linear and the half-width convex; up to 16 parameters the corners are visited in the order of
// a Gray code, where one step changes one coordinate, beyond that they are bounded by the
// triangle inequality. Parameters that a run only hands on unchanged can be exempt.
//
// Cost: evaluating does not depend on the number of runs; n parameters take 2^n * k steps for k
// coefficients, or n * k when bounded.

#include "harness/confidence/paper_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "compiler/base/contract.h"
#include "harness/confidence/quantiles.h"

namespace parallax::harness {
namespace {

// The prediction intervals are taken over a whole cuboid of starts. Both ends of them are extreme
// at corners: the mean is linear and the half-width convex in x.

/// Beyond this many parameters the 2^n corners are bounded instead of visited.
constexpr std::size_t kMaxCornerParameters = 16;

Eigen::VectorXd lowest_corner(std::span<const Interval> range) {
  Eigen::VectorXd corner(std::ssize(range));
  for (std::size_t j = 0; j < range.size(); ++j) {
    corner(static_cast<Eigen::Index>(j)) = range[j].lower;
  }
  return corner;
}

/// Visits the corners in the order of a Gray code: from one to the next a single coordinate
/// changes, so mean and leverage follow in k steps instead of k^2.
Interval hull_of_corners(const LinearFit& fit, std::span<const Interval> range, double q,
                         double sigma) {
  const Eigen::Index lead = fit.has_intercept ? 1 : 0;
  const Eigen::VectorXd start = lowest_corner(range);
  double mean = fit.at(start);
  Eigen::VectorXd leverage_root = fit.half_inverse.rightCols(start.size()) * start;
  if (fit.has_intercept) leverage_root += fit.half_inverse.col(0);
  Interval hull;
  const std::uint32_t corners = 1U << range.size();
  for (std::uint32_t visited = 0;;) {
    const double half_width = q * sigma * std::sqrt(1.0 + leverage_root.squaredNorm());
    hull.lower = visited == 0 ? mean - half_width : std::min(hull.lower, mean - half_width);
    hull.upper = visited == 0 ? mean + half_width : std::max(hull.upper, mean + half_width);
    if (++visited == corners) return hull;
    const auto j = static_cast<std::size_t>(std::countr_zero(visited));
    const std::uint32_t gray = visited ^ (visited >> 1U);
    const double step = (gray >> j & 1U) != 0 ? range[j].width() : -range[j].width();
    mean += step * fit.coefficients(static_cast<Eigen::Index>(j));
    leverage_root += step * fit.half_inverse.col(lead + static_cast<Eigen::Index>(j));
  }
}

/// Never shorter than the hull: the mean's extremes by the signs of its coefficients, and the
/// leverage's square root bounded by the triangle inequality from the midpoint outwards.
Interval bound_of_corners(const LinearFit& fit, std::span<const Interval> range, double q,
                          double sigma) {
  Eigen::VectorXd middle(std::ssize(range));
  const Eigen::Index lead = fit.has_intercept ? 1 : 0;
  double reach = 0.0;
  for (std::size_t j = 0; j < range.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    middle(column) = range[j].midpoint();
    reach += 0.5 * range[j].width() * fit.half_inverse.col(lead + column).norm();
  }
  reach += std::sqrt(fit.leverage(middle));
  const Interval mean = mean_interval(fit.coefficients, fit.intercept, range, 0.0, 0.0, 1);
  const double half_width = q * sigma * std::sqrt(1.0 + reach * reach);
  return {mean.lower - half_width, mean.upper + half_width, true};
}

std::string name_of(const std::vector<std::string>& names, std::size_t index, char letter) {
  return index < names.size() ? names[index] : fmt::format("{}{}", letter, index + 1);
}

/// The rule over runs that come one at a time: the varying columns, moved to the midpoints if
/// centred. Evaluated after any of them, at a cost that does not depend on how many there were.
class PaperFit {
 public:
  PaperFit(const RegressionInput& input, const PaperRuleSpec& spec, double confidence_level)
      : input_(input),
        spec_(spec),
        confidence_level_(confidence_level),
        columns_(varying_columns(input)),
        regression_(std::ssize(columns_), std::ssize(input.y_cell),
                    spec.intercept == InterceptKind::kFree),
        inherited_from_(input.y_cell.size()),
        is_finite_(input.y_cell.size(), true) {
    const bool centred = spec.intercept == InterceptKind::kCentred;
    for (const std::size_t column : columns_) {
      const Interval& range = input.x_range[column];
      const double shift = centred ? range.midpoint() : 0.0;
      shift_.push_back(shift);
      range_.push_back({range.lower - shift, range.upper - shift, range.closed});
    }
    for (std::size_t outcome = 0; outcome < input.y_names.size(); ++outcome) {
      const auto& names = input.x_names;
      const auto same = std::find(names.begin(), names.end(), input.y_names[outcome]);
      if (same == names.end()) continue;
      inherited_from_[outcome] = static_cast<std::size_t>(same - names.begin());
    }
  }

  void add(const std::vector<double>& initial, const std::vector<double>& last) {
    Eigen::VectorXd x(std::ssize(columns_)), y(std::ssize(last));
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      x(static_cast<Eigen::Index>(j)) = initial[columns_[j]] - shift_[j];
    }
    starts_finite_ = starts_finite_ && x.allFinite();
    for (std::size_t outcome = 0; outcome < last.size(); ++outcome) {
      auto& source = inherited_from_[outcome];
      if (source && !(std::abs(last[outcome] - initial[*source]) <= spec_.tolerance_m)) {
        source.reset();
      }
      is_finite_[outcome] = is_finite_[outcome] && std::isfinite(last[outcome]);
      y(static_cast<Eigen::Index>(outcome)) =
          is_finite_[outcome] ? last[outcome] - cell_shift(outcome) : 0.0;
    }
    ++runs_;
    if (starts_finite_) regression_.add(x, y);
  }

  PaperVerdict evaluate() {
    PaperVerdict verdict;
    outcomes_.clear();
    select_outcomes(verdict);
    verdict.why_not = refusal();
    if (!verdict.why_not.empty()) return verdict;
    verdict.z = quantile();
    for (const std::size_t outcome : outcomes_) {
      const auto interval = judge(outcome, verdict.z, verdict.why_not);
      if (!interval) return verdict;
      verdict.intervals.push_back(*interval);
    }
    verdict.stop = verdict.why_not.empty();
    return verdict;
  }

 private:
  /// A column of zero width carries no information and would make the fit singular.
  static std::vector<std::size_t> varying_columns(const RegressionInput& input) {
    std::vector<std::size_t> columns;
    for (std::size_t i = 0; i < input.x_range.size(); ++i) {
      if (input.x_range[i].width() > 0.0) columns.push_back(i);
    }
    return columns;
  }
  double cell_shift(std::size_t outcome) const {
    const auto& cell = input_.y_cell[outcome];
    return cell && spec_.intercept == InterceptKind::kCentred ? cell->midpoint() : 0.0;
  }
  std::int64_t coefficients() const {
    return std::ssize(columns_) + (spec_.intercept == InterceptKind::kFree ? 1 : 0);
  }
  bool needs_residual_freedom() const {
    return spec_.interval == IntervalKind::kPrediction || spec_.sigma == SigmaKind::kResidualSd;
  }

  /// Was the final value the initial one, run by run? The plan never touched it.
  bool inherited(std::size_t outcome) const { return inherited_from_[outcome].has_value(); }

  void select_outcomes(PaperVerdict& verdict) {
    for (std::size_t j = 0; j < input_.y_cell.size(); ++j) {
      if (!input_.y_cell[j]) continue;
      if (spec_.exempt_inherited && inherited(j)) {
        verdict.exempt.push_back(name_of(input_.y_names, j, 'y'));
      } else {
        outcomes_.push_back(j);
      }
    }
  }

  std::string refusal() const {
    if (columns_.empty()) return "no initial parameter varies";
    if (outcomes_.empty()) return "no final parameter to test";
    const std::int64_t least = std::ssize(columns_) + spec_.extra_runs;
    if (runs_ < least) return fmt::format("{} runs, {} needed at least", runs_, least);
    if (needs_residual_freedom() && runs_ <= coefficients()) {
      return fmt::format("{} runs leave nothing over for {} coefficients", runs_, coefficients());
    }
    return {};
  }

  double quantile() const {
    const std::int64_t count =
        spec_.root == RootKind::kInitial ? std::ssize(columns_) : std::ssize(outcomes_);
    const double level = interval_level(confidence_level_, count, spec_.bonferroni);
    if (spec_.interval == IntervalKind::kMean) return two_sided_z(level);
    return student_t_quantile(0.5 * (1.0 + level), static_cast<double>(runs_ - coefficients()));
  }

  std::optional<ParameterInterval> judge(std::size_t outcome, double z,
                                         std::string& why_not) const {
    const auto name = name_of(input_.y_names, outcome, 'y');
    const Interval& cell = *input_.y_cell[outcome];
    const double shift = cell_shift(outcome);
    if (!starts_finite_ || !is_finite_[outcome]) {
      why_not = fmt::format("`{}` or a start value is not a number in some run", name);
      return std::nullopt;
    }
    const auto fit = regression_.fit(static_cast<Eigen::Index>(outcome));
    if (!fit) {
      why_not = "the initial parameters of these runs are not linearly independent";
      return std::nullopt;
    }
    const double sigma = sigma_of(spec_.sigma, fit->sse, fit->runs, fit->parameters);
    const Interval span =
        spec_.interval == IntervalKind::kMean
            ? mean_interval(fit->coefficients, fit->intercept, range_, z, sigma, runs_)
            : prediction_hull(*fit, range_, z, sigma);
    auto result = describe(name, *fit, shift);
    result.lower = span.lower + shift;
    result.upper = span.upper + shift;
    result.sigma = sigma;
    result.cell = cell;
    result.inside = result.lower >= cell.lower - spec_.tolerance_m &&
                    result.upper <= cell.upper + spec_.tolerance_m;
    if (!result.inside && why_not.empty()) {
      why_not = fmt::format("`{}` may end in [{:.6g}, {:.6g}], its cell is [{}, {}]", name,
                            result.lower, result.upper, cell.lower, cell.upper);
    }
    return result;
  }

  ParameterInterval describe(const std::string& name, const LinearFit& fit, double shift) const {
    ParameterInterval result;
    result.name = name;
    result.coefficients.assign(input_.x_range.size(), 0.0);
    result.intercept = fit.intercept + shift;
    result.sse = fit.sse;
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const double b = fit.coefficients(static_cast<Eigen::Index>(j));
      result.coefficients[columns_[j]] = b;
      result.intercept -= b * shift_[j];
    }
    return result;
  }

  const RegressionInput& input_;
  const PaperRuleSpec& spec_;
  double confidence_level_;
  std::vector<std::size_t> columns_;  // varying initial parameters
  RunningRegression regression_;      // of all final parameters on those
  std::int64_t runs_ = 0;
  bool starts_finite_ = true;
  /// For each final parameter, the initial one that it has been equal to so far.
  std::vector<std::optional<std::size_t>> inherited_from_;
  std::vector<bool> is_finite_;        // by final parameter, so far
  std::vector<double> shift_;          // by final parameter
  std::vector<Interval> range_;        // by final parameter, shifted
  std::vector<std::size_t> outcomes_;  // tested final parameters
};

}  // namespace

Interval prediction_interval(const LinearFit& fit, const Eigen::VectorXd& x, double q,
                             double sigma) {
  const double half_width = q * sigma * std::sqrt(1.0 + fit.leverage(x));
  return {fit.at(x) - half_width, fit.at(x) + half_width, true};
}

Interval prediction_hull(const LinearFit& fit, std::span<const Interval> range, double q,
                         double sigma) {
  return range.size() > kMaxCornerParameters ? bound_of_corners(fit, range, q, sigma)
                                             : hull_of_corners(fit, range, q, sigma);
}

double interval_level(double confidence_level, std::int64_t count, bool bonferroni) {
  PARALLAX_REQUIRE(confidence_level > 0.0 && confidence_level < 1.0, "a confidence in (0, 1)");
  PARALLAX_REQUIRE(count > 0, "at least one interval");
  const auto intervals = static_cast<double>(count);
  if (bonferroni) return 1.0 - (1.0 - confidence_level) / intervals;
  return std::pow(confidence_level, 1.0 / intervals);
}

double two_sided_z(double level) { return normal_quantile(0.5 * (1.0 + level)); }

double sigma_of(SigmaKind kind, double sse, std::int64_t runs, std::int64_t parameters) {
  switch (kind) {
    case SigmaKind::kSse:
      return sse;
    case SigmaKind::kRmse:
      return std::sqrt(sse / static_cast<double>(runs));
    case SigmaKind::kResidualSd:
      PARALLAX_REQUIRE(runs > parameters, "more runs than coefficients");
      return std::sqrt(sse / static_cast<double>(runs - parameters));
  }
  return sse;
}

Interval mean_interval(const Eigen::VectorXd& coefficients, double intercept,
                       std::span<const Interval> x_range, double z, double sigma,
                       std::int64_t runs) {
  PARALLAX_REQUIRE(coefficients.size() == std::ssize(x_range), "one range per coefficient");
  double lower = intercept, upper = intercept;
  for (Eigen::Index i = 0; i < coefficients.size(); ++i) {
    const Interval& range = x_range[static_cast<std::size_t>(i)];
    const double b = coefficients(i);
    lower += b * (b > 0.0 ? range.lower : range.upper);
    upper += b * (b > 0.0 ? range.upper : range.lower);
  }
  const double half_width = z * sigma / std::sqrt(static_cast<double>(runs));
  return {lower - half_width, upper + half_width, true};
}

PaperVerdict paper_rule(const RegressionInput& input, const PaperRuleSpec& spec,
                        double confidence_level) {
  PARALLAX_REQUIRE(input.x.size() == input.y.size(), "one final row per initial row");
  for (std::size_t row = 0; row < input.x.size(); ++row) {
    PARALLAX_REQUIRE(input.x[row].size() == input.x_range.size(), "rows as wide as the ranges");
    PARALLAX_REQUIRE(input.y[row].size() == input.y_cell.size(), "rows as wide as the cells");
  }
  PaperFit fit(input, spec, confidence_level);
  for (std::size_t row = 0; row < input.x.size(); ++row) fit.add(input.x[row], input.y[row]);
  return fit.evaluate();
}

PaperVerdict paper_rule(const Tally& tally, const PaperRuleSpec& spec, double confidence_level) {
  const RegressionFrame& frame = tally.frame();
  if (tally.elsewhere() > 0) {
    PaperVerdict verdict;
    verdict.why_not = "a run ended in another state that the model admits";
    return verdict;
  }
  return paper_rule(
      {tally.x(), tally.y(), frame.x_range, frame.y_cell, frame.x_names, frame.y_names}, spec,
      confidence_level);
}

PaperFigures paper_figures(const Tally& tally, const PaperRuleSpec& spec, double confidence_level) {
  const auto& frame = tally.frame();
  return {frame.x_names, frame.x_range, std::ssize(tally.x()),
          paper_rule(tally, spec, confidence_level)};
}

std::optional<std::int64_t> paper_stopped_at(const Tally& tally, const PaperRuleSpec& spec,
                                             double confidence_level) {
  if (tally.elsewhere() > 0) return std::nullopt;
  const RegressionFrame& frame = tally.frame();
  const RegressionInput input{{}, {}, frame.x_range, frame.y_cell, frame.x_names, frame.y_names};
  PaperFit fit(input, spec, confidence_level);
  for (std::size_t row = 0; row < tally.x().size(); ++row) {
    fit.add(tally.x()[row], tally.y()[row]);
    if (fit.evaluate().stop) return static_cast<std::int64_t>(row) + 1;
  }
  return std::nullopt;
}

}  // namespace parallax::harness
