#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "harness/campaign/sample_record.h"

namespace parallax::harness {

/// The result of one simulation as a row of a table. Repetitions of discrepancies have no row.
struct SampleRow {
  std::int64_t trace = 0, sample = 0;
  std::uint64_t seed = 0;             // handed to the simulator at reset
  std::int64_t rejected = 0;          // invalid starts that were drawn before
  std::int64_t retries = 0;           // attempts that were lost and made again
  std::int64_t start_state = 0;       // number of the trace's initial state; 0: it has one
  bool drawn = true;                  // else the start was chosen for what it leads to
  const char* outcome = "clean";      // "clean", "admitted", "discrepancy", "unfinished", "lost"
  std::optional<std::int64_t> event;  // after which it left what is predicted; from 0
  std::string cause, reason;          // of a discrepancy; the reason of a loss, too
  double sim_time_s = 0.0;
  State start;
  std::vector<State> margins;  // by event
  std::string kind;            // as in SampleRecord
};

/// Called for each simulation in the order in which they count, in the caller's thread.
using SampleListener = std::function<void(SampleRow)>;

/// The row of a simulation without its judgement.
SampleRow sample_row(const SampleRecord& record, const char* outcome);

}  // namespace parallax::harness
