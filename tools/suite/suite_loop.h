#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <string>

#include "tools/suite/input_hashes.h"
#include "tools/suite/last_pass.h"
#include "tools/suite/result_cache.h"
#include "tools/suite/suite_record.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {

/// Receives what a running suite has to tell, from one thread at a time.
struct SuiteVoice {
  std::function<void(const std::string&)> remark;
  std::function<void(const SuiteCase&, const CaseResult&)> finished;
};

/// A finished case in a line, what is wrong with it in further ones. Sentences are broken at
/// kSuiteColumns; what is indented (axioms, differences of files) stays as it is. Nothing in it
/// steers a terminal but the mark's colour.
std::string line_of(const SuiteCase& one, const CaseResult& result, bool color = false);

inline constexpr std::size_t kSuiteColumns = 80;

/// Takes over earlier results of a suite's cases, and tells which cases are left to do.
class Reuse {
 public:
  Reuse(SuiteRecord& record, const ResultCache& cache, const LastPasses& passes, SuiteVoice voice)
      : record_(record), cache_(cache), passes_(passes), voice_(std::move(voice)) {}

  /// Takes over the results of an interrupted suite whose files have not changed. If `permits_more`
  /// than in that suite, cases without an answer are run again: that may have been refused. If this
  /// suite `starts_commands`, so are cases of other simulators: nobody knows what those read.
  void resume(const StoredCases& earlier, bool permits_more, bool starts_commands);
  /// Takes over cached passes, which then count as the last ones of their cases; `verified_share`
  /// of them, from 0 to 1, is run all the same, those verified longest ago first.
  void look_up(double verified_share);

  /// Has the case no result yet?
  bool is_open(std::size_t i) const;
  /// Compares the result of a case that was run with the cached one. Thread-safe.
  void verify(std::size_t i, CaseResult& result) const;

 private:
  void take(std::size_t i, CaseResult result);

  SuiteRecord& record_;
  const ResultCache& cache_;
  const LastPasses& passes_;
  SuiteVoice voice_;
  InputHashes hashes_;
  std::map<std::size_t, ResultCache::Hit> to_verify_;
};

struct LoopOptions {
  RunnerOptions runner;
  std::int64_t jobs = 1;
  bool spread = false;  // cases at the same time begin at different places of those elsewhere
  std::int64_t memory_mb = 0;  // that the cases at the same time may need; 0: any
  bool keep_passes = true;     // in the cache
};

/// Runs the cases that are open, in processes of their own, until `stop` is raised. `earlier` tells
/// how long they took.
void run_open_cases(SuiteRecord& record, const LoopOptions& options, const StoredCases& earlier,
                    const Reuse& reuse, const ResultCache& cache, const LastPasses& passes,
                    const SuiteVoice& voice, const std::atomic<bool>& stop);

}  // namespace parallax::tools
