#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/word_table.h"
#include "tools/mutate/cpu_watch.h"
#include "tools/mutate/suite_files.h"
#include "tools/suite/scratch_copy.h"
#include "tools/suite/suite_runner.h"

namespace parallax::tools {

/// Verdict of a suite on a mutant.
enum class MutantOutcome : std::uint8_t {
  kOpen,        // not judged yet
  kNoticed,     // some case does not pass
  kUnnoticed,   // all pass, though some case's traces are others
  kEquivalent,  // every case that reads the file has the same traces, which was proved
  kInvalid,     // it does not compile
  kUnknown,     // a limit came first
};
inline constexpr auto kMutantOutcomeWords = base::word_table<MutantOutcome>(
    "open", "noticed", "unnoticed", "equivalent", "invalid", "unknown");
constexpr std::string_view to_string(MutantOutcome outcome) {
  return kMutantOutcomeWords.of(outcome);
}

struct MutantJudgement {
  MutantOutcome outcome = MutantOutcome::kOpen;
  std::string by = {};   // the first case that notices it
  std::string why = {};  // what that case says, what does not compile, what is not known
  /// For a mutant that is not noticed: a case whose traces differ, and a shortest trace that shows
  /// it.
  std::string told_in = {};
  bool gained = false;           // it is one of the mutant; else one that the mutant has not
  std::int64_t excluded_by = 0;  // the timepoint by which the other side rules it out
  std::string trace = {};        // up to there, in lines
  std::string trace_json = {};   // all of it
};

/// Data that all judges of a suite share.
struct JudgedSuite {
  const std::vector<SuiteCase>& cases;
  const std::vector<std::optional<CaseModel>>& originals;  // by case
  const std::vector<double>& wall_s;  // by case: what it took with the original
  RunnerOptions runner;               // `out` is the judge's own
  bool allow_outside = false;
  double compare_s = 60.0;  // processor time for comparing the traces of a case
};

/// Judges one mutant after the other, in a copy of its own.
class MutantJudge {
 public:
  /// Everything outlives it. `own_cases`: the cases of the copy, parallel to those of the suite.
  MutantJudge(const JudgedSuite& suite, const ScratchCopy& copy, std::vector<SuiteCase> own_cases,
              CpuWatch& watch, std::size_t thread, const std::atomic<bool>& stop);

  /// kOpen if `stop` was raised meanwhile. Reports what cannot be written.
  base::Result<MutantJudgement> judge(const Mutant& mutant, base::DiagnosticSink& sink);

  /// A case in the copy, as it is now.
  CaseResult run(std::size_t index);
  /// The files that a case of the copy reads beside it: what it names by absolute names.
  std::vector<std::string> outside(std::size_t index);

 private:
  struct Told {
    enum class Answer : std::uint8_t { kSame, kDiffers, kUnknown, kInvalid };
    Answer answer = Answer::kUnknown;
    std::string why = {};
    MutantJudgement judgement = {};  // kDiffers
  };
  Told compare(std::size_t index);
  /// The answer is kUnknown if `flag` ends it early.
  Told compare_models(const CaseModel& original, const CaseModel& mutated,
                      const std::atomic<bool>& flag);
  MutantJudgement look_at(const Mutant& mutant);

  const JudgedSuite& suite_;
  const ScratchCopy& copy_;
  std::vector<SuiteCase> own_cases_;
  CpuWatch& watch_;
  std::size_t thread_;
  const std::atomic<bool>& stop_;
  /// Comparisons for the mutant at hand, by the keys of two models, as several cases may have the
  /// same.
  std::map<std::pair<std::string, std::string>, Told> compared_;
};

/// The cases of a suite in a copy of its files.
std::vector<SuiteCase> cases_of_copy(std::vector<SuiteCase> cases, const ScratchCopy& copy);

}  // namespace parallax::tools
