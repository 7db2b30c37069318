#pragma once

#include <array>
#include <vector>

namespace parallax::harness {

/// Bounds of the probability p that a valid start gives a discrepancy, from draws that have a
/// density q of their own, each with the weight w = 1/q.
///
/// With f = 1 for a discrepancy and v = 1 for a valid start, the expectation of w (f - p v) is 0
/// whatever q is. So for any P >= p the wealth that starts at 1 and takes the factor
/// 1 + b w (P v - f) with each draw may be too small, but one with P <= p has expectation 1 at
/// most, and reaches 1/error with probability `error` at most (Ville 1939; Waudby-Smith and Ramdas
/// 2024). The upper bound is the least P whose wealth got there, the lower one likewise with bets
/// on discrepancies. Nothing is asked of q but that q >= `share` > 0 everywhere, which keeps every
/// factor above zero; q and bets may depend on earlier draws.
class WeightedBounds {
 public:
  struct Draw {
    double weight = 1.0;  // 1 / q
    double share = 1.0;   // of the law of starts in q: weight <= 1 / share
    bool valid = true;
    bool failed = false;
    bool lost = false;  // the worst is assumed, at either end
  };
  /// `bet` in (0, 1): of the lower bound, chosen before the draw.
  void add(const Draw& draw, double bet);

  double upper(double error) const;
  double lower(double error) const;

 private:
  /// Bet sizes for the upper bound. The largest bet gives the tightest bound when all discrepancies
  /// lie where q is large.
  static constexpr std::array<double, 3> kBets = {0.99, 0.5, 0.15};
  static constexpr std::array<double, 3> kShares = {0.94, 0.04, 0.02};

  struct Failure {
    double scaled = 0.0;  // weight * share, in (0, 1]
    double bet = 0.0;
    bool lost = false;
  };
  double log_wealth_above(double probability) const;
  double log_wealth_below(double probability) const;

  std::vector<Failure> failures_;
  double sum_ = 0.0, squares_ = 0.0;  // of `scaled` over clean draws
  double log_below_ = 0.0;            // factors of clean and lost draws in the lower bound's wealth
};

}  // namespace parallax::harness
