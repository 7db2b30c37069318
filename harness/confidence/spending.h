#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace parallax::harness {

/// With this confidence, the probability of a discrepancy is below epsilon.
struct CertifiedBound {
  double confidence_level = 0.0;
  double epsilon = 1.0;  // 1: nothing is known
};

/// How several traces share the error 1-C, so that what is claimed of each holds of all of them
/// together (Bonferroni: whatever the traces have to do with each other, the chance that some
/// claim is false is at most the sum of their chances). What a trace may spend must not depend on
/// what runs showed: it follows from the number of traces, or from the trace's place among them.
class SpendingRule {
 public:
  /// `traces` of them in all, known before the first claim: 1/K each. None: the number is not
  /// known, and the k-th may spend 6/(pi^2 k^2), which sums to 1 over all k.
  explicit SpendingRule(std::optional<std::int64_t> traces) : traces_(traces) {}

  /// The share of the error for the k-th trace, from 1 on.
  double share(std::int64_t k) const;
  const std::optional<std::int64_t>& traces() const { return traces_; }
  /// "1/3 of the error for each of 3 traces"
  std::string text() const;

 private:
  std::optional<std::int64_t> traces_;
};

}  // namespace parallax::harness
