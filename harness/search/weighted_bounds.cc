// Bounds on a probability from weighted draws, valid whenever one looks (Ville 1939;
// Waudby-Smith and Ramdas 2024).
//
// Someone bets on each draw against the claim that the probability is P; under a true claim the
// wealth has expectation 1 at most, so it ever reaches 1/error with probability `error` at most.
// The upper bound is the least P refuted. Its wealth is a mixture of three fixed bets; ln(1 + t)
// >= t - t^2/2 bounds the factors of clean draws from below, so that two sums stand for all of
// them, and only failures are kept. The lower bound uses the bet that the caller chose before
// each draw. A lost draw is the worse of both for either bound. Wealth is monotone in P, so both
// bounds are found by bisection on a logarithmic scale.
//
// Cost: a draw is added at once; a bound takes 45 evaluations, linear in the failures.

#include "harness/search/weighted_bounds.h"

#include <algorithm>
#include <cmath>

#include "compiler/base/contract.h"

namespace parallax::harness {
namespace {

constexpr double kLeast = 1e-15;
constexpr int kHalvings = 45;

/// Where a monotone function on (kLeast, 1], looked at on a logarithmic scale, becomes true.
template <typename Condition>
std::pair<double, double> border_of(Condition is_above) {
  double low = std::log(kLeast), high = 0.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (is_above(std::exp(middle)) ? high : low) = middle;
  }
  return {std::exp(low), std::exp(high)};
}

}  // namespace

void WeightedBounds::add(const Draw& draw, double bet) {
  if (!draw.valid) return;
  const double scaled = draw.weight * draw.share;
  PARALLAX_REQUIRE(scaled > 0.0 && scaled <= 1.0 + 1e-9, "a weight within its bound");
  if (draw.failed || draw.lost) failures_.push_back({scaled, bet, draw.lost});
  if (draw.failed) return;
  log_below_ += std::log1p(-bet * scaled);
  if (draw.lost) return;
  sum_ += scaled;
  squares_ += scaled * scaled;
}

double WeightedBounds::log_wealth_above(double probability) const {
  std::array<double, kBets.size()> logs{};
  for (std::size_t i = 0; i < kBets.size(); ++i) {
    // ln(1 + t) >= t - t^2 / 2: less wealth than there is, so that clean draws need not be kept.
    const double step = kBets[i] * probability;
    logs[i] = std::log(kShares[i]) + step * sum_ - 0.5 * step * step * squares_;
    for (const auto& one : failures_) {
      logs[i] += std::log1p(kBets[i] * one.scaled * (probability - 1.0));
    }
  }
  const double most = *std::max_element(logs.begin(), logs.end());
  double sum = 0.0;
  for (const double one : logs) sum += std::exp(one - most);
  return most + std::log(sum);
}

double WeightedBounds::log_wealth_below(double probability) const {
  double out = log_below_;
  for (const auto& one : failures_) {
    if (!one.lost) out += std::log1p(one.bet * one.scaled * (1.0 / probability - 1.0));
  }
  return out;
}

double WeightedBounds::upper(double error) const {
  const double enough = -std::log(error);
  if (log_wealth_above(1.0) < enough) return 1.0;
  return border_of([&](double p) { return log_wealth_above(p) >= enough; }).second;
}

double WeightedBounds::lower(double error) const {
  const double enough = -std::log(error);
  if (log_wealth_below(kLeast) < enough) return 0.0;
  return border_of([&](double p) { return log_wealth_below(p) < enough; }).first;
}

}  // namespace parallax::harness
