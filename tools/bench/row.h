#pragma once

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

  /// Processor time of a side in units of the first's; none for the first, or unless both have one.
  /// All programs use one thread, and wall time would also measure what else the machine does.
  std::optional<double> ratio(std::size_t side) const;
  /// No two answers, and no answer and the known one, differ.
  bool agrees() const;
};

/// A line for each side, under the row's name.
std::string to_text(const Row& row);

/// All rows with times, memory, answers and commands as one JSON document.
std::string to_json(const std::vector<Row>& rows);

}  // namespace parallax::tools
