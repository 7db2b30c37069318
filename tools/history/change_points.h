#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/history/history_file.h"

namespace parallax::tools {

/// A change in the history of one suite.
struct ChangePoint {
  enum class Kind : std::uint8_t {
    kOutcome,  // outcome or verdict of a case
    kRate,     // more or fewer failures than chance explains
    kCases,    // a case came, or left
    kValues,   // what a case reads changed by these values, and its outcome did not
  };
  Kind kind = Kind::kOutcome;
  std::size_t line = 0;  // index into the suite's lines: the first with what is new
  std::string name;      // of the case
  std::string words;     // "passed (no-discrepancy), then failed (discrepancy)"
  double p_value = 0.0;  // kRate: adjusted for all comparisons and looks
};

/// Confidence with which changes of rates are named.
inline constexpr double kHistoryConfidence = 0.95;

struct Changes {
  std::vector<ChangePoint> points;  // by line, then by name
  std::size_t comparisons = 0;      // of rates, over all lines
  double confidence = kHistoryConfidence;
};

/// The changes in the lines of one suite, `suite` being indices into the history. Rates are
/// compared with the first measurement since their last change by Fisher's two-sided exact test.
/// Each line is a look, and look k spends 6/(pi^2 k^2) of the error (SpendingRule), shared equally
/// by the rates that are known then. So the probability that any change is ever named although none
/// happened is at most 1 - confidence, however long the history grows, and a change that was named
/// stays named. Lost runs count as the less remarkable answer.
Changes find_changes(const History& history, const std::vector<std::size_t>& suite,
                     double confidence);

/// A rate of a case. A cause that was not seen has count 0 in all runs of its trace; none: the
/// trace was not measured.
std::optional<MeasuredRate> measured_rate(const HistoryCase& one, const std::string& of);

/// Remarks about times, which depend on the machine: cases that took more than three times as long
/// as in the line before, and more than a second longer.
std::vector<std::string> slower_cases(const History& history,
                                      const std::vector<std::size_t>& suite);

/// A line for people: "3f2a1c0: scenarios/edge.yaml: passed, then failed".
std::string change_text(const ChangePoint& point, const History& history,
                        const std::vector<std::size_t>& suite);

}  // namespace parallax::tools
