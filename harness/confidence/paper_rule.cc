#include "harness/confidence/paper_rule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compiler/base/contract.h"
#include "harness/confidence/quantiles.h"

namespace parallax::harness {
namespace {

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
  /// Of each final parameter, the initial one that it has been equal to so far.
  std::vector<std::optional<std::size_t>> inherited_from_;
  std::vector<bool> is_finite_;        // of each final parameter, so far
  std::vector<double> shift_;          // of each of them
  std::vector<Interval> range_;        // of each of them, shifted
  std::vector<std::size_t> outcomes_;  // tested final parameters
};

}  // namespace

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
