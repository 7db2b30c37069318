#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "harness/confidence/criterion_spec.h"
#include "harness/confidence/regression.h"
#include "harness/confidence/tally.h"
#include "harness/region/region.h"

namespace parallax::harness {

/// s clean runs: initial parameters x (s x n), final parameters y (s x m). A final parameter
/// without a cell is not tested.
struct RegressionInput {
  std::vector<std::vector<double>> x;
  std::vector<std::vector<double>> y;
  std::vector<Interval> x_range;                // (n)
  std::vector<std::optional<Interval>> y_cell;  // (m)
  std::vector<std::string> x_names, y_names;    // may be empty: x1.., y1..
};

/// The regression result for one final parameter.
struct ParameterInterval {
  std::string name;
  std::vector<double> coefficients;  // (n); 0 for an initial parameter of zero width
  double intercept = 0.0;
  double sse = 0.0;    // e'e
  double sigma = 0.0;  // in the reading of the rule
  double lower = 0.0;  // the interval of the rule, same unit as the parameter
  double upper = 0.0;
  bool inside = false;  // within the expected cell, up to the tolerance
  Interval cell;
};

struct PaperVerdict {
  bool stop = false;
  double z = 0.0;  // the normal quantile, or Student's t for prediction intervals
  std::vector<ParameterInterval> intervals;  // tested parameters, in order
  std::vector<std::string> exempt;           // inherited parameters that were left out
  std::string why_not;                       // empty if `stop`
};

/// The stop rule of Meywerk et al., Section III-C, in the reading `spec`
/// (docs/internals/statistics.md). Stop: every tested final parameter's interval lies in its
/// expected cell. It is neither valid under repeated looks nor a probability of error.
/// `confidence_level` in (0, 1). Refuses, with `why_not`, fewer than n + extra_runs runs, dependent
/// columns, a start that does not vary and a final state without continuous parameters.
PaperVerdict paper_rule(const RegressionInput& input, const PaperRuleSpec& spec,
                        double confidence_level);
/// Refuses besides when a run ended in another state that the model admits: the rule supposes one.
PaperVerdict paper_rule(const Tally& tally, const PaperRuleSpec& spec, double confidence_level);

/// The result of the rule, with all figures that are needed to check it by hand.
struct PaperFigures {
  std::vector<std::string> x_names;  // (n) initial parameters, in the order of the coefficients
  std::vector<Interval> x_range;     // (n)
  std::int64_t runs = 0;             // s
  PaperVerdict verdict;
};
PaperFigures paper_figures(const Tally& tally, const PaperRuleSpec& spec, double confidence_level);

/// The first number of clean runs at which the rule holds, looking after every run; none where it
/// is refused or never does. Linear in the number of runs.
std::optional<std::int64_t> paper_stopped_at(const Tally& tally, const PaperRuleSpec& spec,
                                             double confidence_level);

/// Confidence of one of `count` intervals that are to hold together with `confidence_level`:
/// C^(1/count), or 1 - (1-C)/count (Bonferroni).
double interval_level(double confidence_level, std::int64_t count, bool bonferroni);

/// Z = Phi^-1((1 + level) / 2).
double two_sided_z(double level);

/// The reading of sigma, from SSE of s runs and k coefficients.
double sigma_of(SigmaKind kind, double sse, std::int64_t runs, std::int64_t parameters);

/// The paper's interval: sum b_i x_i at the ends of the ranges that make it least and greatest,
/// widened by z sigma / sqrt(s).
Interval mean_interval(const Eigen::VectorXd& coefficients, double intercept,
                       std::span<const Interval> x_range, double z, double sigma,
                       std::int64_t runs);

/// fit(x) +- q sigma sqrt(1 + v'(D'D)^-1 v): where one further outcome at x is to be expected.
Interval prediction_interval(const LinearFit& fit, const Eigen::VectorXd& x, double q,
                             double sigma);

/// The hull of the prediction intervals of all starts in the cuboid `range` (n). Up to 16
/// parameters exact, O(2^n n); beyond them a bound that is never shorter.
Interval prediction_hull(const LinearFit& fit, std::span<const Interval> range, double q,
                         double sigma);

}  // namespace parallax::harness
