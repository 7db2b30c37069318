#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/bench/child_run.h"
#include "tools/bench/row.h"

namespace parallax::tools {

struct MeasureOptions {
  int repetitions = 5;
  double enough_s = 10.0;  // a program that has run this long in all is not run again
  double time_limit_s = 60.0;
};

/// One side of a row before it is run.
struct Contestant {
  std::string program;               // "parallax"
  std::vector<std::string> command;  // as for run_child
  std::string folder;                // working directory; empty: ours
  std::vector<int> good_codes = {0};
  /// Reads the answer out of a run; may be empty.
  std::function<std::string(const ChildRun&)> answer;
};

/// Runs the contestants in turn, round by round, so that both see the machine alike, and gives the
/// medians. Standard output goes to `output`, a file that is written anew each time.
std::vector<Side> measure(const std::vector<Contestant>& contestants, const std::string& output,
                          const MeasureOptions& options);

/// The middle value; of an even number of values the upper one. `values` is not empty.
double median(std::vector<double> values);

}  // namespace parallax::tools
