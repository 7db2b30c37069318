#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <set>
#include <string>

#include "compiler/base/subprocess.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// What the processes of one case read, used and answered.
class Footprint {
 public:
  /// `out` is the suite's folder, for a file while the case runs; what lies below it is no input.
  Footprint(const SuiteCase& one, const std::filesystem::path& out);
  ~Footprint();
  Footprint(const Footprint&) = delete;
  Footprint& operator=(const Footprint&) = delete;

  /// That a process is to write (option --footprint).
  std::string file() const { return file_.string(); }
  /// Of a process that has ended.
  void add(const base::Captured& child);
  /// A file that the suite itself looks at.
  void add_input(const std::string& path) { inputs_.insert(path); }
  /// Paths of files that were read, or that were looked for in vain.
  const std::set<std::string>& inputs() const { return inputs_; }
  /// Notes all of it in the result. No inputs are noted where one has changed since the beginning:
  /// nobody knows what was read then.
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
