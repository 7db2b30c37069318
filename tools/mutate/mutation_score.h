#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tools/mutate/mutant_judge.h"
#include "tools/suite/result_cache.h"
#include "tools/suite/suite_loop.h"

namespace parallax::tools {

struct MutationOptions {
  std::filesystem::path out;  // the file of judged mutants lies there
  RunnerOptions runner;       // of the suite itself
  std::int64_t jobs = 1;
  std::size_t at_most = 0;  // limit on mutants to judge; 0: all
  std::string only_files;   // mutants of files whose names contain this
  bool resume = false;
  const ResultCache* cache = nullptr;  // of the suite's passes
};

/// Mutation score of a suite: the mistakes in its models and plans that it would notice.
struct MutationScore {
  std::vector<std::string> red;  // lines about cases that do not pass; then nothing was mutated
  std::size_t cases = 0;
  std::size_t made = 0;                     // mutants, of which `mutants` are looked at
  std::vector<Mutant> mutants;              // by file and line
  std::vector<MutantJudgement> judgements;  // parallel
  std::vector<std::string> passed_over;     // files that are not read from copies, in words

  std::size_t count(MutantOutcome outcome) const;
  std::size_t observable() const {
    return count(MutantOutcome::kNoticed) + count(MutantOutcome::kUnnoticed);
  }
};

/// Judges every mutant. First the suite itself is run: one that does not pass cannot be scored.
/// Mutants live in a new temporary folder, which is removed; no file of the suite is written. The
/// answer does not depend on `jobs`. Judgements are written to OUT/mutants.ndjson as they come;
/// `resume` takes them over if nothing else has changed since. Reports results of another suite
/// there (kUsage), and files that cannot be read or written.
base::Result<MutationScore> score_suite(const std::vector<SuiteCase>& cases,
                                        const MutationOptions& options, Context& context);

/// The answer as text: mutants that are not noticed, and numbers.
std::string mutation_text(const MutationScore& score);
/// The same as JSON, with every mutant.
std::string mutation_document(const MutationScore& score);

}  // namespace parallax::tools
