#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "compiler/base/descriptor.h"
#include "compiler/base/diagnostic.h"
#include "tools/mutate/mutant_judge.h"

namespace parallax::tools {

/// The file in the suite's output folder that --resume reads.
inline constexpr const char* kJudgedFile = "mutants.ndjson";

/// Judgements, a line each, kept while a suite is mutated. Thread-safe.
class JudgedMutants {
 public:
  /// `suite`: a hash of all that the judgements depend on. With `resume` the judgements in the file
  /// about the same suite are taken over, and another suite's are refused (kUsage); else the file
  /// is begun anew. A file in another format is never replaced (kUsage).
  static base::Result<JudgedMutants> open(const std::filesystem::path& file,
                                          const std::string& suite, bool resume,
                                          base::DiagnosticSink& sink);

  std::optional<MutantJudgement> find(const Mutant& mutant) const;
  void add(const Mutant& mutant, const MutantJudgement& judgement);
  /// The `errno` of the first line that could not be written; 0: all were.
  int write_error() const;

 private:
  std::map<std::string, MutantJudgement> known_;  // by key
  std::unique_ptr<std::mutex> mutex_ = std::make_unique<std::mutex>();
  base::Descriptor out_;
  int error_ = 0;
};

}  // namespace parallax::tools
