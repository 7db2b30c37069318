#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "compiler/base/word_table.h"

namespace parallax::harness {

enum class CriterionKind : std::uint8_t {
  kCleanRuns,       // stop after ceil(ln(1-C) / ln(1-eps)) clean, independent, uniform runs
  kPaper,           // Meywerk et al., Section III-C
  kAnytime,         // stop when the mixture's bound is below eps, whatever failed before
  kClopperPearson,  // a number of runs fixed in advance; then one look
};
inline constexpr auto kCriterionWords =
    base::word_table<CriterionKind>("clean-runs", "paper", "anytime", "clopper-pearson");
constexpr std::string_view to_string(CriterionKind kind) { return kCriterionWords.of(kind); }

/// The source of the criterion: "Hanley and Lippman-Hand 1983: ...".
std::string_view source_of(CriterionKind kind);
/// May one look after every run without spoiling what is stated?
bool may_be_watched(CriterionKind kind);

enum class SigmaKind : std::uint8_t { kSse, kRmse, kResidualSd };
enum class RootKind : std::uint8_t { kInitial, kFinal };
enum class InterceptKind : std::uint8_t { kNone, kCentred, kFree };
enum class IntervalKind : std::uint8_t { kMean, kPrediction };
inline constexpr auto kSigmaWords = base::word_table<SigmaKind>("sse", "rmse", "residual-sd");
inline constexpr auto kRootWords = base::word_table<RootKind>("initial", "final");
inline constexpr auto kInterceptWords = base::word_table<InterceptKind>("none", "centred", "free");
inline constexpr auto kIntervalWords = base::word_table<IntervalKind>("mean", "prediction");

/// The readings of the paper's rule (docs/internals/statistics.md has the table of ambiguities).
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

/// The claims that hold with confidence C: that of each trace by itself, or those of all traces.
enum class Family : std::uint8_t {
  kPerTrace,   // each by itself
  kAllTraces,  // all of them together: each trace may spend a share of the error 1-C
};
inline constexpr auto kFamilyWords = base::word_table<Family>("per-trace", "all-traces");
constexpr std::string_view to_string(Family family) { return kFamilyWords.of(family); }

struct CriterionSpec {
  CriterionKind kind = CriterionKind::kCleanRuns;
  double confidence_level = 0.99;  // C
  double epsilon = 0.05;           // all but paper: the discrepancy probability to exclude
  std::int64_t runs = 0;           // clopper-pearson: 0 for as many as suffice if all are clean
  PaperRuleSpec paper;             // also computed, for the report, with the other kinds
  Family family = Family::kAllTraces;
  double share = 1.0;  // of the error 1-C that one trace may spend; derived (SpendingRule)

  /// 1 less the error that the trace may spend. The paper's rule keeps C itself.
  double trace_level() const {
    constexpr double kMost = 1.0 - 0x1.0p-53;  // the last number below 1
    if (share >= 1.0) return confidence_level;
    return std::min(1.0 - (1.0 - confidence_level) * share, kMost);
  }
};

/// Runs after which it stops if all are clean; 0: it cannot be told (`paper`).
std::int64_t planned_runs(const CriterionSpec& spec);

}  // namespace parallax::harness
