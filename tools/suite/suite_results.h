#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "tools/suite/shard.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// Settings that make the results of two suites comparable.
struct SuiteIdentity {
  std::string version;     // of the program, for people
  std::string program;     // program_hash()
  std::string arithmetic;  // of the processor (arithmetic_digits); empty: it is not known
  std::uint64_t seed = 1;
  Shard shard;
  std::vector<std::string> paths;
  std::string only;
  bool fast = false;
  bool allow_commands = false, allow_outside = false;
  std::string ledger{};  // SHA-256 of the ledger that cases were judged by; empty: by none

  /// Is it the same except for permissions, of which it has more?
  bool permits_more_than(const SuiteIdentity& other) const;
};

/// The difference of two suites, "seed 1 and seed 2"; empty: they differ in nothing but the index
/// of their shards.
std::string difference(const SuiteIdentity& a, const SuiteIdentity& b);

/// A case as a results file keeps it; of `expect` only its part in `revision` is kept.
struct StoredCase {
  SuiteCase one;
  CaseResult result;
};

/// By the name of the case.
using StoredCases = std::map<std::string, StoredCase>;

struct StoredResults {
  SuiteIdentity identity;
  StoredCases cases;
  /// All names that earlier suites of the same paths knew, where this one looked at fewer cases.
  std::set<std::string> known = {};
  /// Names of cases that this suite has told to be gone, for a merge of shards.
  std::set<std::string> removed = {};
};

/// Paths of a suite, however they are written: `./a/` is `a`, and their order says nothing.
std::vector<std::string> normal_paths(std::vector<std::string> paths);

/// The file in the suite's output folder that --resume, --rerun-failed and --merge read.
inline constexpr const char* kResultsFile = "results.json";

/// Reads the results of an earlier suite; kNoEarlierResults if there are none or they are broken.
base::Result<StoredResults> read_results(const std::filesystem::path& folder,
                                         base::DiagnosticSink& sink);

/// Writes `stored` with the given results laid over it.
base::Status write_results(const std::filesystem::path& folder, StoredResults stored,
                           const std::vector<SuiteCase>& cases,
                           const std::vector<CaseResult>& results, base::DiagnosticSink& sink);

/// A result as a JSON object on one line, and back; none if the text is not a result.
std::string result_text(const CaseResult& result);
std::optional<CaseResult> result_from_text(std::string_view text);

}  // namespace parallax::tools
