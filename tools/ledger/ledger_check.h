#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "harness/config/ledger.h"
#include "tools/ledger/shown.h"

namespace parallax::tools {

/// Is this discrepancy, of the entry's scenario, the one in the entry? Outcome, fluents and trace
/// must match as far as the entry has them.
bool is_known_as(const ShownDiscrepancy& shown, const harness::LedgerEntry& entry);

/// Entry of the ledger for one discrepancy.
struct LedgerFinding {
  enum class Kind : std::uint8_t {
    kUnknown,
    kKnown,  // open or accepted
    kBack,   // the entry says that it was repaired
  };
  Kind kind = Kind::kUnknown;
  ShownDiscrepancy shown;
  const harness::LedgerEntry* entry = nullptr;  // kKnown, kBack
  /// kUnknown: an entry about the same event of the same scenario, which differs in more.
  const harness::LedgerEntry* nearest = nullptr;

  /// One sentence: what is wrong, or the entry that it is known by.
  std::string words() const;
  bool is_wrong() const { return kind != Kind::kKnown; }
};

/// The comparison of one run with a ledger. Points into the ledger.
struct LedgerVerdict {
  std::vector<LedgerFinding> findings;  // a row for each discrepancy, without repetitions
  /// Open and accepted entries of the scenario that this run does not show any more, although it
  /// went where they were.
  std::vector<const harness::LedgerEntry*> gone;

  bool is_wrong() const;
};

/// `scenario`: the name that the run's scenario has in the ledger (ledger_name).
LedgerVerdict hold_against(const harness::Ledger& ledger, std::string_view scenario,
                           const ShownRun& run);

/// Is the entry still undecided although its scenario no longer exists?
bool lacks_scenario(const harness::LedgerEntry& entry, const std::filesystem::path& ledger);

/// "ID is open, and no run shows it any more", "ID is open, and there is no scenario X".
std::string gone_text(const harness::LedgerEntry& entry);
std::string lost_text(const harness::LedgerEntry& entry);

/// A hash of the ledger's statements about a scenario: a result judged by it stays valid as long as
/// this is the same.
std::string ledger_digest(const harness::Ledger& ledger, std::string_view scenario);

}  // namespace parallax::tools
