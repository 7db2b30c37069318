#pragma once

#include <cstdint>
#include <string>

namespace parallax::harness {

enum class CriterionKind : std::uint8_t {
  kCleanRuns,  // stop after ceil(ln(1-C) / ln(1-eps)) clean, independent, uniform runs
  kPaper,      // Meywerk et al., Section III-C
};

enum class SigmaKind : std::uint8_t { kSse, kRmse, kResidualSd };
enum class RootKind : std::uint8_t { kInitial, kFinal };
enum class InterceptKind : std::uint8_t { kNone, kCentred, kFree };
enum class IntervalKind : std::uint8_t { kMean, kPrediction };

/// The readings of the paper's rule (docs/statistics.md has the table of ambiguities).
struct PaperRuleSpec {
  SigmaKind sigma = SigmaKind::kSse;
  RootKind root = RootKind::kInitial;
  InterceptKind intercept = InterceptKind::kNone;
  IntervalKind interval = IntervalKind::kMean;
  std::int64_t extra_runs = 1;    // first stop allowed at s = n + extra_runs
  bool exempt_inherited = false;  // drop parameters whose final value equals the initial one
  double tolerance_m = 0.0;       // how far an interval may stick out of its cell
  std::string preset = "paper-literal";
  bool bonferroni = false;  // 1 - (1-C)/count per interval instead of C^(1/count)
};

/// {sse, root initial, no intercept, mean interval, s >= n + 1, exact borders}.
PaperRuleSpec paper_literal();
/// {residual-sd, root final, free intercept, prediction interval, s >= n + 2, inherited parameters
/// exempt, tolerance 1 cm}.
PaperRuleSpec paper_repaired();

struct CriterionSpec {
  CriterionKind kind = CriterionKind::kCleanRuns;
  double confidence_level = 0.99;  // C
  double epsilon = 0.05;           // clean-runs: the discrepancy probability to exclude
  PaperRuleSpec paper;             // also computed, for the report, when kind is clean-runs
};

}  // namespace parallax::harness
