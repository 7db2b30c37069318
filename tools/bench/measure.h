#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/child_run.h"

namespace parallax::tools {

/// One program's part of a row.
struct Side {
  std::string program;       // "parallax", "clingo"
  std::string command;       // as a user would type it, folders left out
  std::optional<Cost> cost;  // medians; none: see `remark`
  int runs = 0;
  std::string answer;  // what it found, for comparison: a number of traces, "satisfiable"
  std::string remark;  // why there is no cost: "not installed", "no end within 60 s"
};

/// One measurement: what one program needs, beside its peers if there are any.
struct Row {
  std::string section;
  std::string name;
  std::vector<Side> sides;              // ours first
  std::optional<std::string> expected;  // the answer that is known
  std::string note;                     // other figures of the row, in words

  /// Processor time of a side relative to the first; none for the first, or unless both have one.
  /// All programs use one thread, and wall time would also measure other work on the machine.
  std::optional<double> ratio(std::size_t side) const;
  /// All answers agree with each other and with the known one.
  bool agrees() const;
};

/// A line for each side, under the row's name.
std::string to_text(const Row& row);

/// Summarizes the rows of a section that have peers: for every peer, the geometric mean of its cost
/// relative to ours, and the row where that ratio is least; the same for the best of clingo's
/// configurations, where several took part. Rows in which the peer did not end are counted apart.
std::string summary_text(const std::vector<Row>& rows);

/// All rows with times, memory, answers and commands as one JSON document.
std::string to_json(const std::vector<Row>& rows);

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

/// Runs the contestants in turn, round by round, so that load on the machine affects both alike,
/// and gives the medians. Standard output goes to `output`, a file that is written anew each time.
std::vector<Side> measure(const std::vector<Contestant>& contestants, const std::string& output,
                          const MeasureOptions& options);

/// The middle value; of an even number of values the upper one. `values` is not empty.
double median(std::vector<double> values);

}  // namespace parallax::tools
