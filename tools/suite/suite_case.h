#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "harness/config/scenario.h"
#include "harness/config/suite_manifest.h"

namespace parallax::tools {

/// One thing that a suite checks: a scenario file with `expect`, or a case of a manifest.
struct SuiteCase {
  std::string file;   // the scenario or the manifest, as the user's path leads to it
  std::string id;     // of the case; of a scenario its file
  std::string group;  // what JUnit calls the class: the manifest, or the scenario's folder
  std::variant<harness::Expectation, harness::ManifestCase> check;
  std::vector<std::string> command = {};  // that the scenario names as its simulator

  /// Unique in a suite, and what --only looks at: `FILE`, or `FILE:ID`.
  std::string name() const { return id == file ? file : file + ':' + id; }
};

enum class Outcome : std::uint8_t {
  kPassed,
  kFailed,       // the answer is another one than expected
  kError,        // no answer: a crash, a limit, a refused input
  kNotFinished,  // the suite ended first
  kSkipped,      // in another shard
};
std::string_view to_string(Outcome outcome);

struct CaseResult {
  Outcome outcome = Outcome::kNotFinished;
  std::vector<std::string> problems;  // a sentence each; further lines are details
  std::string messages;               // what the program wrote to standard error
  std::string golden_written;         // the file, if one was
  double wall_s = 0.0;
};

/// The cases below the paths, sorted by group and id: manifests (a key `cases` at the outermost
/// level), scenarios with `expect`, and scenarios that are broken but meant as a case, which must
/// not pass by being skipped. Reported are a broken manifest, a missing path, and folders and YAML
/// files that cannot be read or lie elsewhere. What is read, or will be, becomes an input of
/// `files`.
base::Result<std::vector<SuiteCase>> find_cases(const std::vector<std::string>& paths,
                                                bool allow_outside, base::SourceFiles& files,
                                                base::DiagnosticSink& sink);

/// The part `index` of `count`, counted from 1.
struct Shard {
  std::uint32_t index = 1;
  std::uint32_t count = 1;
};

inline constexpr std::uint32_t kMaxShards = 10'000;

/// "2/5"; nothing for anything else than 1 <= i <= n <= kMaxShards.
std::optional<Shard> parse_shard(std::string_view text);

/// Whether the case belongs to the shard. It depends on the case's id and on the count alone
/// (FNV-1a of the id, 64 bits, folded), so that new cases move no other.
bool in_shard(std::string_view id, const Shard& shard);

}  // namespace parallax::tools
