#pragma once

#include <optional>
#include <string>
#include <vector>

namespace parallax::tools {

/// Cost of one run of a program.
struct Cost {
  double wall_s = 0.0;
  double cpu_s = 0.0;      // user and system
  double peak_mb = 0.0;    // largest resident set, in 10^6 bytes
  double output_mb = 0.0;  // what it wrote on standard output
};

struct ChildRun {
  Cost cost;
  int code = -1;         // exit code, 128 + signal, 127 if there is no such program
  bool stopped = false;  // killed at a time limit
  std::string tail;      // the end of its standard output, at most kTailBytes
};

inline constexpr std::size_t kTailBytes = 8192;

struct ChildOptions {
  std::string output;          // file for standard output; written anew
  std::string folder = {};     // working directory; empty: ours
  double time_limit_s = 60.0;  // of processor time, rounded up; of wall time ten times as much
};

/// Runs a program (looked up in PATH, no shell) to its end with standard error discarded. Memory
/// is what the kernel reports of this child alone (wait4); it is never less than this process used
/// before the call, so large things are measured in children. nullopt if no process or file can be
/// had.
std::optional<ChildRun> run_child(const std::vector<std::string>& command,
                                  const ChildOptions& options);

// Answers of other programs, read from the end of their output; empty if there is none.

/// The number in `Models       : 3488` of clingo's statistics.
std::string clingo_answer(const std::string& tail);

/// The number in `Optimization : 82`, if the optimum was found.
std::string clingo_optimum(const std::string& tail);

/// The number in `"optimum":82`.
std::string optimum_answer(const std::string& tail);

/// How many atoms stay as they are in every model, or are in some: `Consequences : 11`.
std::string clingo_consequences(const std::string& tail);

/// The sum of these numbers in the closing `"counts"` of `parallax consequences --json`.
std::string consequences_answer(const std::string& tail, const std::vector<std::string>& extents);

/// The number of traces in the closing object of a list in jsonl.
std::string jsonl_answer(const std::string& tail);

/// The number that is the whole of the first line.
std::string count_answer(const std::string& tail);

}  // namespace parallax::tools
