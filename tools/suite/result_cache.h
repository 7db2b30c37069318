#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/suite/input_hashes.h"
#include "tools/suite/suite_case.h"
#include "tools/suite/suite_ledger.h"

namespace parallax::tools {

/// The part of a case that is in the suite's own files and on its command line: a result belongs to
/// the case only as long as this is the same. Contents of files are not in it: they are inputs.
struct CaseKey {
  std::string program;  // program_hash()
  std::uint64_t seed = 1;
  bool allow_outside = false;
  const SuiteLedger* ledger = nullptr;  // of known discrepancies; outlives what has the key
};
std::string case_definition(const SuiteCase& one, const CaseKey& key);

/// Passed cases on disk, a file each. One is found again where the case's definition is the same
/// and every file that the run had read still has the same content. An entry carries a SHA-256 of
/// itself: one that was changed by hand or half written is not used.
class ResultCache {
 public:
  ResultCache(std::filesystem::path folder, CaseKey key) : folder_(std::move(folder)), key_(key) {}

  struct Hit {
    CaseResult result;
    std::filesystem::path file;
    std::int64_t age_order = 0;  // the lower, the longer ago it was made or verified
  };
  const CaseKey& key() const { return key_; }
  /// `damaged` counts entries that have been altered.
  std::optional<Hit> find(const SuiteCase& one, InputHashes& hashes, std::size_t& damaged) const;
  /// Keeps a pass; other results, and those that another run need not repeat, are skipped. False if
  /// it could not be written. Safe from several threads for different cases.
  bool store(const SuiteCase& one, const CaseResult& result) const;

 private:
  std::filesystem::path folder_of(const SuiteCase& one) const;

  std::filesystem::path folder_;
  CaseKey key_;
};

/// Compares the result of a case that was run again with the cached one; returns the differences in
/// words.
std::string disagreement(const CaseResult& cached, const CaseResult& again);

}  // namespace parallax::tools
