#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/search/search_history.h"

namespace parallax::harness {

enum class RareEventMethod : std::uint8_t {
  kImportance,  // importance sampling from a fitted law, mixed with the law of starts
  kSplitting,   // adaptive multilevel splitting
};
inline constexpr auto kRareEventMethodWords =
    base::word_table<RareEventMethod>("importance", "splitting");
constexpr std::string_view to_string(RareEventMethod method) {
  return kRareEventMethodWords.of(method);
}

struct RareEventOptions {
  RareEventMethod method = RareEventMethod::kImportance;
  std::size_t dimensions = 1;
  std::int64_t budget = 10'000;  // simulations at most
  double confidence = 0.95;
  std::uint64_t seed = 1;
};

enum class RareEventEnd : std::uint8_t {
  kEstimated,
  kUnreached,   // no discrepancy among what was simulated: importance then has an upper end alone
  kFlat,        // splitting: margins are constant, so they do not lead anywhere
  kUnresolved,  // splitting: the estimates differ by more than an interval can be made of
  kLost,        // splitting: runs were lost, for which it has no worst case
  kInvalid,     // hardly any start is valid
  kUnequal,     // by the caller: starts were not valid, and the law is of several parts
  kStopped,     // by the caller
};
inline constexpr auto kRareEventEndWords =
    base::word_table<RareEventEnd>("estimated", "not-reached", "flat", "not-resolved", "lost",
                                   "invalid-starts", "unequal-starts", "stopped");
constexpr std::string_view to_string(RareEventEnd end) { return kRareEventEndWords.of(end); }

struct RareEventResult {
  RareEventEnd end = RareEventEnd::kEstimated;
  double probability = 0.0;
  double lower = 0.0, upper = 1.0;
  std::int64_t runs = 0;     // simulations, lost ones included
  std::int64_t lost = 0;     // importance: discrepancies for the upper end, none for the lower
  std::int64_t invalid = 0;  // points that were no valid starts

  std::int64_t exploring = 0;  // runs that the interval does not rest on

  // Importance only.
  std::int64_t uniform = 0;  // runs that it rests on, drawn from the law of starts itself
  std::int64_t found = 0;    // discrepancies among those that it rests on
  double effective = 0.0;    // as many equally weighted ones say as much (Kish 1965)
  double standard_error = 0.0;

  // Splitting only.
  std::vector<double> estimates;  // the independent ones
  double acceptance = 0.0;        // share of moves that were made
  /// Variance of the estimates' logarithms over what it is where moves forget where they began.
  double excess = 0.0;
};

/// Runs that the method takes at the least; fewer cannot resolve anything.
std::int64_t least_runs(RareEventMethod method);

/// Simulates from the points, in order. None: stopped.
using BatchEvaluator =
    std::function<std::optional<std::vector<Evaluation>>(std::span<const UnitPoint>)>;

/// Adds them to the counts `runs`, `lost` and `invalid`.
void count_runs(const std::vector<Evaluation>& evaluations, RareEventResult& result);

/// The probability that a valid start, uniform in the unit cube, gives a discrepancy.
///
/// Importance sampling (importance.cc): the interval holds with the stated confidence whatever the
/// simulator and its margins are. A poor fit makes it wide, not wrong.
///
/// Splitting (splitting.cc): the interval supposes that moves reach every place where there are
/// discrepancies, and that estimates have about a lognormal law.
///
/// `options.budget` must be least_runs() at least. What is simulated follows from the options and
/// the answers alone.
RareEventResult estimate_rare_event(const RareEventOptions& options,
                                    const BatchEvaluator& evaluate);

}  // namespace parallax::harness
