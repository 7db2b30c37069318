#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "compiler/base/subprocess.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// Inputs, memory and answers of the processes of one case.
class Footprint {
 public:
  /// `out` is the suite's folder, for a file while the case runs; what lies below it is no input.
  Footprint(const SuiteCase& one, const std::filesystem::path& out);
  ~Footprint();
  Footprint(const Footprint&) = delete;
  Footprint& operator=(const Footprint&) = delete;

  /// Name of the file that a process is to write (option --footprint).
  std::string file() const { return file_.string(); }
  /// Adds a process that has ended.
  void add(const base::Captured& child);
  /// Adds a file that the suite itself reads.
  void add_input(const std::string& path) { inputs_.insert(path); }
  /// Paths of files that were read, or that were looked for in vain.
  const std::set<std::string>& inputs() const { return inputs_; }
  /// Writes all of it to the result. No inputs are recorded if one has changed since the beginning:
  /// then nobody knows what was read.
  void into(CaseResult& result) const;

 private:
  std::filesystem::path out_, file_;
  std::filesystem::file_time_type begin_;
  std::set<std::string> inputs_;
  std::set<std::string> absent_;  // of them, those that a process looked for in vain
  std::string answers_;
  std::int64_t peak_memory_mb_ = 0;
  bool complete_ = true;  // every process said what it read
  bool repeatable_ = true;
};

/// A document of --json without its members `timing`, at any depth; another text as it is.
std::string without_timings(const std::string& answer);

}  // namespace parallax::tools
