#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/config/ledger.h"
#include "tools/ledger/shown.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// The known discrepancies with which the scenarios of a suite are compared.
struct SuiteLedger {
  harness::Ledger ledger;
  std::string file;

  /// Hash of the ledger's statements about the case; empty for a case that simulates nothing.
  std::string digest_of(const SuiteCase& one) const;
  /// Notes as problems discrepancies that the ledger does not know, or knows as repaired; also
  /// notes the entries that are shown and those that could have been. None: the run gave no
  /// document to judge.
  void judge(const SuiteCase& one, const std::optional<ShownRun>& run, CaseResult& result) const;
  /// Open and accepted entries that runs of these results looked for and none has shown, and those
  /// whose scenario no longer exists. A sentence each.
  std::vector<std::string> stale(const std::vector<CaseResult>& results) const;
};

/// The digest of an absent ledger is empty.
std::string ledger_digest_of(const SuiteLedger* ledger, const SuiteCase& one);

}  // namespace parallax::tools
