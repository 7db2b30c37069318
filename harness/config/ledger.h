#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/source_file.h"
#include "compiler/base/word_table.h"

namespace parallax::harness {

enum class LedgerStatus : std::uint8_t { kOpen, kRepaired, kAccepted };
inline constexpr auto kLedgerStatusWords =
    base::word_table<LedgerStatus>("open", "repaired", "accepted");
constexpr std::string_view to_string(LedgerStatus status) { return kLedgerStatusWords.of(status); }

/// A known discrepancy, and what was decided about it. It is known again by its scenario, its event
/// and those of outcome, fluents and trace that the entry has; the rest is told to people.
struct LedgerEntry {
  std::string id;
  std::string scenario;  // starts at the ledger's folder
  std::string event;     // the last one before model and world part; "start": they never agreed
  std::optional<std::string> outcome;               // what became of the event: "path-blocked"
  std::optional<std::vector<std::string>> fluents;  // what differs, as observed: "not F(a)"
  std::optional<std::vector<std::string>> trace;    // the events before it
  std::string says, cause, model, first_seen;
  LedgerStatus status = LedgerStatus::kOpen;
  std::string decision;  // the revision that repaired it, or why it is accepted

  base::SourceRange source;  // of the whole entry's first token
  base::SourceRange id_source, status_source;
};

/// "open", "repaired in 3f2a1c0", "accepted because ...": as the file has it, and people read it.
std::string status_text(const LedgerEntry& entry);

/// The known discrepancies of a project, in the order of the file (docs/reference/suites.md).
struct Ledger {
  base::FileId file;
  std::vector<LedgerEntry> entries;

  const LedgerEntry* find(std::string_view id) const;
};

/// Reads a ledger. Ids are distinct. Refuses, at their places, unknown keys, a status other than
/// the three, and an entry without a decision that is required.
base::Result<Ledger> load_ledger(const std::filesystem::path& path, base::SourceFiles& files,
                                 base::DiagnosticSink& sink);
/// Reads the same from a text that is not yet a file.
base::Result<Ledger> parse_ledger(base::FileId file, base::SourceFiles& files,
                                  base::DiagnosticSink& sink);

/// The name of a scenario in a ledger: its path relative to the ledger's folder, links resolved.
std::string ledger_name(const std::filesystem::path& scenario, const std::filesystem::path& ledger);

}  // namespace parallax::harness
