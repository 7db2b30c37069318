#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "compiler/base/word_table.h"

namespace parallax::harness {

/// The timepoints at which the observed fluents are compared with those of the trace.
enum class Comparison : std::uint8_t {
  kEveryStep,  // at the first difference prediction and physics part, wherever the run ends
  kFinal,      // at the last timepoint only, as in the paper of Meywerk et al.
};
inline constexpr auto kComparisons = base::word_table<Comparison>("every-step", "final");
constexpr std::string_view to_string(Comparison comparison) { return kComparisons.of(comparison); }

/// The object of the simulation: the events of the model's traces one after the other, whatever
/// comes of them, or the plan itself, which goes on as it does on the robot.
enum class Execution : std::uint8_t { kOpenLoop, kClosedLoop };
inline constexpr auto kExecutions = base::word_table<Execution>("open-loop", "closed-loop");
constexpr std::string_view to_string(Execution execution) { return kExecutions.of(execution); }

/// Where executions of a plan begin: in any initial state, each equally likely, or at first in
/// those from which the solver finds a way to what no execution went through yet.
enum class Starts : std::uint8_t { kUniform, kGuided };
inline constexpr auto kStartsWords = base::word_table<Starts>("uniform", "guided");
constexpr std::string_view to_string(Starts starts) { return kStartsWords.of(starts); }

/// The initial states that the simulations of a trace begin in: all that lead to its events, each
/// equally likely or by weights; or only the first in the model's order.
enum class Initial : std::uint8_t { kAll, kWeights, kFirst };
inline constexpr auto kInitialWords = base::word_table<Initial>("all", "weights", "first");
constexpr std::string_view to_string(Initial initial) { return kInitialWords.of(initial); }

/// So many initial states of a trace are listed; of more some are drawn.
inline constexpr std::int64_t kMostInitialStates = 10'000;

/// The law of the initial states in records: "uniform", "weights", "first".
constexpr std::string_view law_word(Initial initial) {
  return initial == Initial::kAll ? "uniform" : to_string(initial);
}

/// The comparison of the fluents of one symbol.
struct ComparedFluents {
  enum class How : std::uint8_t { kEveryStep, kAtTheEnd, kAtTheStart, kIgnored };
  std::string fluent;  // "Holding(..)", "Tired()"
  How how = How::kEveryStep;
  std::string why;  // of an ignored one, in the scenario's words; may be empty
};

constexpr std::string_view to_string(ComparedFluents::How how) {
  switch (how) {
    case ComparedFluents::How::kEveryStep:
      break;
    case ComparedFluents::How::kAtTheEnd:
      return "final";
    case ComparedFluents::How::kAtTheStart:
      return "start";
    case ComparedFluents::How::kIgnored:
      return "ignored";
  }
  return "every-step";
}

}  // namespace parallax::harness
