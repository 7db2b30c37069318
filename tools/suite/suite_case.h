#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/config/scenario.h"
#include "harness/config/suite_manifest.h"
#include "tools/history/history_file.h"

namespace parallax::tools {

/// A case of a suite: a scenario file with `expect`, or a case of a manifest.
struct SuiteCase {
  std::string file;   // the scenario or the manifest, as the user's path leads to it
  std::string id;     // of the case; of a scenario its file
  std::string group;  // what JUnit calls the class: the manifest, or the scenario's folder
  std::variant<harness::Expectation, harness::ManifestCase> check;
  std::vector<std::string> command = {};  // that the scenario names as its simulator
  bool is_broken = false;                 // a scenario that cannot be read; running it says why
  /// Hash of what the case is: its texts in the suite and the files that it names, whether or not
  /// it is run.
  std::string revision = {};
  std::uint32_t line = 0;   // of the case in `file`, from 1; 0: another file has it
  bool is_removed = false;  // no case any more: only the last suite had it

  /// Unique in a suite, and what --only looks at: `FILE`, or `FILE:ID`.
  std::string name() const { return id == file ? file : file + ':' + id; }
};

enum class Outcome : std::uint8_t {
  kPassed,
  kFailed,        // the answer is not the expected one
  kError,         // no answer: a crash, a limit, a refused input
  kInconclusive,  // as expected so far, but the run came to no verdict and none is expected
  kNotFinished,   // the suite ended first
  kSkipped,       // in another shard
  kRemoved,       // the last suite had it, this one has not
};
std::string_view to_string(Outcome outcome);

/// A file or folder that was looked at.
struct InputFile {
  std::string path;
  std::string sha256;  // of the content, of a folder its list; empty: nothing is there
};

struct CaseResult {
  Outcome outcome = Outcome::kNotFinished;
  std::vector<std::string> problems;  // a sentence each; further lines are details
  std::string messages;               // what the program wrote to standard error
  std::string golden_written;         // the file, if one was
  double wall_s = 0.0;
  std::uint32_t attempts = 1;     // that were made; a pass after the first one is flaky
  std::string reused;             // empty: it was run; else `cached` or `resumed`
  std::string answer;             // SHA-256 of what the program answered, timings left out
  std::vector<InputFile> inputs;  // what the program read, by path
  std::int64_t peak_memory_mb = 0;
  bool repeatable = false;               // the answer depends on no limit and no foreign program
  std::string ledger;                    // what it was judged by (ledger_digest_of); empty: by none
  std::string verdict;                   // of a scenario's run
  std::string where;                     // "in 1 of 6 initial states"; empty: in each
  std::string standing;                  // of its discrepancy: "not-asked", "stands", "in-doubt"
  std::vector<MeasuredRate> rates;       // of a scenario whose rate is expected
  std::vector<std::string> shown, gone;  // ids of the ledger: seen again, looked for in vain

  bool flaky() const { return outcome == Outcome::kPassed && attempts > 1; }
};

/// Finds the cases below the paths, sorted by group and id: manifests (a key `cases` at the
/// outermost level), scenarios with `expect`, and broken scenarios that are meant as a case, which
/// must not pass by being skipped. The kind of a file is decided by a YAML parser
/// (suite_file_kind). Reports a broken manifest, a missing path, and folders and YAML files that
/// cannot be read, are not text in UTF-8, or lie elsewhere. Files that are read, or will be, become
/// inputs of `files`.
base::Result<std::vector<SuiteCase>> find_cases(const std::vector<std::string>& paths,
                                                bool allow_outside, base::SourceFiles& files,
                                                base::DiagnosticSink& sink);

}  // namespace parallax::tools
