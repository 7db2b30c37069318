#include "tools/suite/suite_ledger.h"

#include <algorithm>
#include <set>

#include "tools/ledger/ledger_check.h"

namespace parallax::tools {
namespace {

void add_once(const std::string& id, std::vector<std::string>& into) {
  if (std::find(into.begin(), into.end(), id) == into.end()) into.push_back(id);
}

}  // namespace

std::string SuiteLedger::digest_of(const SuiteCase& one) const {
  if (!std::holds_alternative<harness::Expectation>(one.check)) return {};
  return ledger_digest(ledger, harness::ledger_name(one.file, file));
}

std::string ledger_digest_of(const SuiteLedger* ledger, const SuiteCase& one) {
  return ledger == nullptr ? "" : ledger->digest_of(one);
}

void SuiteLedger::judge(const SuiteCase& one, const std::optional<ShownRun>& run,
                        CaseResult& result) const {
  if (!run) return;
  const auto verdict = hold_against(ledger, harness::ledger_name(one.file, file), *run);
  for (const auto& finding : verdict.findings) {
    if (finding.is_wrong()) result.problems.push_back(finding.words());
    if (finding.entry != nullptr) add_once(finding.entry->id, result.shown);
  }
  for (const auto* entry : verdict.gone) add_once(entry->id, result.gone);
}

std::vector<std::string> SuiteLedger::stale(const std::vector<CaseResult>& results) const {
  std::set<std::string> shown, gone;
  for (const auto& result : results) {
    shown.insert(result.shown.begin(), result.shown.end());
    gone.insert(result.gone.begin(), result.gone.end());
  }
  std::vector<std::string> out;
  for (const auto& entry : ledger.entries) {
    if (shown.contains(entry.id)) continue;
    if (gone.contains(entry.id)) out.push_back(gone_text(entry));
    if (lacks_scenario(entry, file)) out.push_back(lost_text(entry));
  }
  return out;
}

}  // namespace parallax::tools
