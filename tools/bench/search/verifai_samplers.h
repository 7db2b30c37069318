#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "harness/search/search_rng.h"
#include "harness/search/strategy.h"

namespace parallax::bench {

// Samplers that VerifAI offers (Dreossi et al. 2019; the bandit: Viswanadha et al. 2021), written
// anew after their description. All divide each coordinate into buckets and know of a sample only
// whether its margin is below a threshold, 0 unless the user says otherwise.

/// A distribution over the buckets of each coordinate. A sample below the threshold raises its
/// buckets' probability: q = alpha q, and 1 - alpha more for the bucket. alpha = 0.9, 5 buckets.
/// With the threshold 0 it is uniform until the first discrepancy; `adaptive` sets the threshold
/// that a user may choose by hand: the least tenth of the margins so far.
std::unique_ptr<harness::SearchStrategy> verifai_cross_entropy(std::size_t dimensions,
                                                               std::uint64_t seed, bool adaptive);

/// For each coordinate the bucket with the highest upper confidence bound (UCB1) on the share of
/// samples below the threshold, and a uniform point in it. 5 buckets.
std::unique_ptr<harness::SearchStrategy> verifai_bandit(std::size_t dimensions, std::uint64_t seed);

/// Bayesian optimization as GPyOpt does it: 5 uniform points, a Gaussian process with a Matern
/// covariance of one length, expected improvement. Uniform beyond 200 points.
std::unique_ptr<harness::SearchStrategy> verifai_bayesian(std::size_t dimensions,
                                                          std::uint64_t seed);

}  // namespace parallax::bench
