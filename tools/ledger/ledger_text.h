#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "compiler/base/source_file.h"
#include "harness/config/ledger.h"

namespace parallax::tools {

/// The text of a ledger without entries.
std::string new_ledger_text();

/// An entry as the file has it, in the order in which people read it; `indent` blanks before its
/// dash.
std::string entry_text(const harness::LedgerEntry& entry, std::size_t indent);

/// The text with one more entry, before the first whose scenario and id sort after its own;
/// everything else stays as it is, comments included. `ledger` is the one read from `text`. None
/// where the layout of the text does not allow that line by line.
std::optional<std::string> with_entry(std::string_view text, const harness::Ledger& ledger,
                                      const harness::LedgerEntry& entry);

/// The text with the status of `entry`, as `entry` has it, in place of the old one.
std::optional<std::string> with_status(std::string_view text, const harness::Ledger& ledger,
                                       const harness::LedgerEntry& entry);

/// An id that no entry has, made of scenario and event: "edge.place-r1".
std::string free_id(const harness::Ledger& ledger, const harness::LedgerEntry& entry);

}  // namespace parallax::tools
