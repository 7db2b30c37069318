#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/monitor/belief.h"
#include "tests/support/random_model.h"

namespace parallax::test {

/// A trace as the oracle sees it: the fluents that hold at 0 .. n, the events at 0 .. n - 1, and
/// the outcome of the plan's perform there (0: there was none, 1 it succeeded, -1 it failed).
struct PlainTrace {
  std::vector<std::vector<bool>> holds, happens;
  std::vector<int> performed;
};

/// All traces of the model with n steps: a solver that is handed the clauses of that horizon as
/// they stand, and a blocking clause for each trace. None: there are more than `limit`.
std::optional<std::vector<PlainTrace>> plain_traces(const compiler::CompiledModel& model,
                                                    compiler::Timepoint n, std::size_t limit);

/// A line of a log: an observation, or a step.
struct LogItem {
  std::optional<runtime::Observation> observed;
  runtime::ToldStep told;
  std::vector<runtime::OneOfFluents> one_of{};  // of an observation
};
using Log = std::vector<LogItem>;

/// A log of a trace of `traces`, made wrong at some place as often as not, or of nothing at all.
Log random_log(const compiler::CompiledModel& model, const std::vector<PlainTrace>& traces,
               const std::vector<bool>& unobserved, FuzzRandom& random);

/// Number of lines of the log with which some trace of `lengths` (by number of steps) agrees.
std::size_t admitted_lines(const std::vector<std::vector<PlainTrace>>& lengths, const Log& log,
                           const std::vector<bool>& unobserved);

}  // namespace parallax::test
