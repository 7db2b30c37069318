#pragma once

#include <cstdint>

namespace parallax::harness {

/// Clean, independent, uniform runs after which P(discrepancy) >= epsilon is excluded with
/// confidence C: ceil(ln(1-C) / ln(1-epsilon)). Both in (0, 1).
std::int64_t runs_needed(double confidence_level, double epsilon);

/// The same backwards: the bound 1 - (1-C)^(1/s) after s clean runs and no failure; 1 after none.
/// Valid under any stop rule: a false claim at any time needs the first n runs to be clean, where
/// n is the first count at which the bound is below the true probability.
double bound_after(std::int64_t clean_runs, double confidence_level);

/// log of the uniform-mixture wealth against "P(failure) >= epsilon" after `failures` of `runs`:
/// 1/eps times the integral over q in (0, eps) of the likelihood ratio of q to eps. Its expectation
/// never exceeds 1 under the hypothesis, so (Ville) it ever reaches 1/(1-C) with probability at
/// most 1-C, whenever one looks.
double log_mixture_wealth(std::int64_t failures, std::int64_t runs, double epsilon);

/// The anytime-valid upper bound: the least epsilon whose wealth has reached 1/(1-C); 1 if none.
double mixture_upper(std::int64_t failures, std::int64_t runs, double confidence_level);

/// Runs after which mixture_upper reaches epsilon if no further one fails.
std::int64_t mixture_runs_needed(std::int64_t failures, double confidence_level, double epsilon);

/// Clopper and Pearson 1934: exact for a number of runs fixed in advance, not under repeated looks.
double clopper_pearson_upper(std::int64_t failures, std::int64_t runs, double confidence_level);

}  // namespace parallax::harness
