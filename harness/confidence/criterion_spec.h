#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace parallax::harness {

enum class CriterionKind : std::uint8_t {
  kCleanRuns,       // stop after ceil(ln(1-C) / ln(1-eps)) clean, independent, uniform runs
  kPaper,           // Meywerk et al., Section III-C
  kAnytime,         // stop when the mixture's bound is below eps, whatever failed before
  kClopperPearson,  // so many runs, fixed in advance; then one look
};
/// As they are typed and recorded, by value.
inline constexpr std::array<std::string_view, 4> kCriterionWords = {"clean-runs", "paper",
                                                                    "anytime", "clopper-pearson"};
inline std::string_view to_string(CriterionKind kind) {
  return kCriterionWords[static_cast<std::size_t>(kind)];
}

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
  double epsilon = 0.05;           // all but paper: the discrepancy probability to exclude
  std::int64_t runs = 0;           // clopper-pearson: 0 for as many as suffice if all are clean
  PaperRuleSpec paper;             // also computed, for the report, with the other kinds
};

}  // namespace parallax::harness
