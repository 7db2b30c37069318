#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/conformance/run_record.h"
#include "harness/simulator/process_simulator.h"
#include "harness/simulator/simulator.h"

namespace parallax::harness {

/// The checks, in the order in which they are made.
enum class CheckKind : std::uint8_t {
  kHandshake,
  kReset,
  kActions,
  kDeterminism,
  kSeeds,
  kWear,
  kInvalidStart,
  kUnknown,
  kTimeLimit,
  kStartUp,
  kTiming,
  kUnits,
  kEnd,
};
std::string_view to_string(CheckKind kind);

/// How many of the initial states of a scenario's trace the starts are of.
struct TriedStates {
  std::optional<std::int64_t> all;  // none: more than are listed
  std::int64_t tried = 0;
};

struct ConformanceOptions {
  ProcessOptions process;  // the command, its limits, the stop flag
  /// Starts and actions to try; empty: from what the simulator says of itself.
  std::vector<State> starts;
  /// Set where the starts are of a trace with several initial states.
  std::optional<TriedStates> states;
  std::vector<TriedAction> actions;
  double tolerance = 1e-3;  // what still counts as the same, in the unit of each variable
  /// Asked once it has said what it is; false ends the check.
  std::function<bool(const SimulatorInfo&)> on_info;
};

struct CheckResult {
  CheckKind kind;
  bool was_made = false;
  std::string said;  // what was seen, or why it was not made
};

struct ConformanceFinding {
  CheckKind kind;
  bool is_fault = false;  // else a warning
  std::string text;
};

/// The repeatability of runs with the same start and seed.
enum class Repeatability : std::uint8_t { kUnknown, kNone, kTolerance, kBitwise };
std::string_view to_string(Repeatability repeatability);

/// The claims that runs with this simulator can support, as measured; docs/guide/simulators.md.
struct SupportedClaims {
  std::string replay, retries, independence, jobs, search, recordings;
};

struct ConformanceReport {
  SimulatorInfo info;
  std::optional<TriedStates> states;  // as the options have it
  std::vector<CheckResult> checks;    // one of each kind
  std::vector<ConformanceFinding> findings;
  Repeatability repeatability = Repeatability::kUnknown;
  double largest_deviation = 0.0;   // of an observed start from the asked one
  double largest_difference = 0.0;  // of runs with the same start and seed
  double round_trip_s = 0.0;        // median
  double real_time_factor = 0.0;    // simulated over wall time of the actions; 0: unknown
  SupportedClaims claims;
  bool complete = false;  // false: given up, stopped, or `on_info` said no

  std::size_t faults() const;
};

/// Starts the simulator, several times, and asks it what a campaign asks and what none should.
/// Every request is bounded by its limit and a simulator that is lost three times is given up;
/// nothing that was started is left.
ConformanceReport check_conformance(const ConformanceOptions& options);

std::string conformance_text(const ConformanceReport& report, const std::string& command);
std::string conformance_json(const ConformanceReport& report,
                             const std::vector<std::string>& command);

}  // namespace parallax::harness
