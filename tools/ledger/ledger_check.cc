#include "tools/ledger/ledger_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "compiler/base/json.h"
#include "compiler/base/sha256.h"

namespace parallax::tools {
namespace {

using harness::LedgerEntry;
using harness::LedgerStatus;

std::vector<std::string> in_order(std::vector<std::string> list) {
  std::sort(list.begin(), list.end());
  return list;
}

/// Do `events` begin with `trace`, followed by `event`?
bool goes_through(const std::vector<std::string>& events, const std::vector<std::string>& trace,
                  const std::string& event) {
  if (event == "start") return true;
  return events.size() > trace.size() && std::equal(trace.begin(), trace.end(), events.begin()) &&
         events[trace.size()] == event;
}

/// Does the entry match a counted cause, of which only the event, a word and the trace are known?
bool is_counted_as(const ShownDiscrepancy& shown, const LedgerEntry& entry) {
  if (shown.event != entry.event) return false;
  if (entry.outcome && *entry.outcome != shown.outcome) return false;
  const auto& fluents = entry.fluents;
  if (fluents && !shown.outcome.empty() &&
      std::find(fluents->begin(), fluents->end(), shown.outcome) == fluents->end()) {
    return false;
  }
  return !entry.trace || goes_through(shown.trace, *entry.trace, entry.event);
}

/// The number of conditions of an entry: the more, the better it fits.
int precision(const LedgerEntry& entry) {
  return (entry.outcome ? 1 : 0) + (entry.fluents ? 1 : 0) + (entry.trace ? 1 : 0);
}

/// Where two entries fit equally well the repaired one counts, wherever it stands: that
/// it is back must not be hidden by the other.
bool is_stricter(const LedgerEntry& entry, const LedgerEntry& than) {
  return entry.status == LedgerStatus::kRepaired && than.status != LedgerStatus::kRepaired;
}

LedgerFinding find_in(const harness::Ledger& ledger, std::string_view scenario,
                      const ShownDiscrepancy& shown) {
  LedgerFinding out;
  out.shown = shown;
  for (const auto& entry : ledger.entries) {
    if (entry.scenario != scenario) continue;
    if (!is_known_as(shown, entry)) {
      if (entry.event == shown.event && out.nearest == nullptr) out.nearest = &entry;
      continue;
    }
    if (out.entry == nullptr || precision(entry) > precision(*out.entry) ||
        (precision(entry) == precision(*out.entry) && is_stricter(entry, *out.entry))) {
      out.entry = &entry;
    }
  }
  if (out.entry != nullptr) {
    out.nearest = nullptr;
    out.kind = out.entry->status == LedgerStatus::kRepaired ? LedgerFinding::Kind::kBack
                                                            : LedgerFinding::Kind::kKnown;
  }
  return out;
}

/// Did the run go where the entry's discrepancy was, and would it have shown it?
bool was_looked_for(const LedgerEntry& entry, const ShownRun& run) {
  if (!run.is_complete) return false;
  if (run.is_executed) return true;
  return std::all_of(run.traces.begin(), run.traces.end(), [&](const ShownRun::Trace& trace) {
    const bool elsewhere = entry.trace && !goes_through(trace.events, *entry.trace, entry.event);
    return trace.is_clean || elsewhere;
  });
}

/// How the entry about the same event differs from the discrepancy.
std::string difference_words(const ShownDiscrepancy& shown, const LedgerEntry& entry) {
  std::vector<std::string> parts;
  if (entry.outcome && *entry.outcome != shown.outcome) parts.emplace_back("outcome");
  if (entry.fluents && in_order(*entry.fluents) != shown.fluents) parts.emplace_back("fluents");
  if (entry.trace && *entry.trace != shown.trace) parts.emplace_back("trace");
  std::string out;
  for (const auto& part : parts) out += (out.empty() ? "`" : ", `") + part + '`';
  return out;
}

}  // namespace

bool is_known_as(const ShownDiscrepancy& shown, const LedgerEntry& entry) {
  if (shown.counted) return is_counted_as(shown, entry);
  return shown.event == entry.event && (!entry.outcome || *entry.outcome == shown.outcome) &&
         (!entry.fluents || in_order(*entry.fluents) == shown.fluents) &&
         (!entry.trace || *entry.trace == shown.trace);
}

std::string LedgerFinding::words() const {
  auto what = shown.sample.empty() ? shown.words : fmt::format("{}: {}", shown.sample, shown.words);
  if (kind == Kind::kKnown) return fmt::format("{} ({}: {})", what, entry->id, status_text(*entry));
  if (kind == Kind::kBack) {
    return fmt::format("{} is {}, and comes back: {}", entry->id, status_text(*entry), what);
  }
  auto out = "a discrepancy that the ledger does not know: " + what;
  if (nearest != nullptr) {
    out += fmt::format("; {} is about the same event, with another {}", nearest->id,
                       difference_words(shown, *nearest));
  }
  return out;
}

bool LedgerVerdict::is_wrong() const {
  return std::any_of(findings.begin(), findings.end(),
                     [](const LedgerFinding& one) { return one.is_wrong(); });
}

LedgerVerdict hold_against(const harness::Ledger& ledger, std::string_view scenario,
                           const ShownRun& run) {
  LedgerVerdict out;
  std::set<std::string> told;
  std::set<const LedgerEntry*> seen;
  for (const auto& shown : run.discrepancies) {
    auto finding = find_in(ledger, scenario, shown);
    for (const auto& entry : ledger.entries) {
      const bool fits = finding.entry != nullptr && entry.scenario == scenario &&
                        precision(entry) == precision(*finding.entry) && is_known_as(shown, entry);
      if (fits) seen.insert(&entry);
    }
    const auto which = finding.entry != nullptr ? finding.entry->id : "?" + identity_text(shown);
    if (told.insert(which).second) out.findings.push_back(std::move(finding));
  }
  for (const auto& entry : ledger.entries) {
    if (entry.scenario != scenario || entry.status == LedgerStatus::kRepaired) continue;
    if (!seen.contains(&entry) && was_looked_for(entry, run)) out.gone.push_back(&entry);
  }
  return out;
}

bool lacks_scenario(const LedgerEntry& entry, const std::filesystem::path& ledger) {
  std::error_code error;
  return entry.status != LedgerStatus::kRepaired &&
         !std::filesystem::exists(ledger.parent_path() / entry.scenario, error);
}

std::string gone_text(const LedgerEntry& entry) {
  return fmt::format("{} is {}, and no run shows it any more", entry.id, status_text(entry));
}

std::string lost_text(const LedgerEntry& entry) {
  return fmt::format("{} is {}, and there is no scenario {}", entry.id, status_text(entry),
                     entry.scenario);
}

std::string ledger_digest(const harness::Ledger& ledger, std::string_view scenario) {
  auto list = nlohmann::json::array();
  for (const auto& entry : ledger.entries) {
    if (entry.scenario != scenario) continue;
    nlohmann::json item = {{"id", entry.id}, {"event", entry.event}, {"is", status_text(entry)}};
    if (entry.outcome) item["outcome"] = *entry.outcome;
    if (entry.fluents) item["fluents"] = *entry.fluents;
    if (entry.trace) item["trace"] = *entry.trace;
    list.push_back(std::move(item));
  }
  return base::sha256_hex(base::json_text(list));
}

}  // namespace parallax::tools
