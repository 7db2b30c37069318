#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/file_io.h"
#include "tools/app/rests_on.h"
#include "tools/ledger/ledger_check.h"
#include "tools/page/gather.h"

namespace parallax::tools {
namespace {

std::string how_it_stands(const LedgerFinding& finding) {
  if (finding.kind == LedgerFinding::Kind::kUnknown) return "not known";
  const auto status = harness::status_text(*finding.entry);
  return finding.kind == LedgerFinding::Kind::kBack ? status + ", and back" : status;
}

PageLedger::Property property_row(const std::string& formula, const PropertyAnswer& answer) {
  using Verdict = PropertyAnswer::Verdict;
  PageLedger::Property out;
  out.formula = formula;
  out.holds = answer.verdict == Verdict::kHolds;
  out.answer = answer.verdict == Verdict::kViolated
                   ? fmt::format("violated at timepoint {}", answer.horizon)
               : out.holds ? fmt::format("holds up to horizon {}", answer.horizon)
                           : "stopped before the end: nothing is known";
  for (const auto& one : answer.rests_on) {
    out.rests_on.push_back(rests_on_words(one));
    out.asks_for_review = out.asks_for_review || one.entry->status == harness::LedgerStatus::kOpen;
  }
  return out;
}

}  // namespace

base::Status add_ledger(const PageOptions& options, const std::string& scenario, Context& context,
                        PageData& page) {
  auto& sink = context.sink();
  const auto ledger = harness::load_ledger(options.ledger, context.files(), sink);
  if (!ledger) return sink.already_reported();
  PageLedger out;
  out.file = options.ledger;
  const auto name = harness::ledger_name(scenario, options.ledger);
  base::DiagnosticSink unread;  // a report that is missing has its banner
  const auto text = base::read_file_of(options.folder, "report.json", unread);
  if (const auto run = text ? shown_run(*text) : std::nullopt) {
    const auto verdict = hold_against(*ledger, name, *run);
    for (const auto& finding : verdict.findings) {
      out.rows.push_back({finding.entry == nullptr ? "" : finding.entry->id, how_it_stands(finding),
                          fmt::format("{}: {}", finding.shown.sample, finding.shown.words),
                          finding.is_wrong()});
    }
    for (const auto* entry : verdict.gone) out.gone.push_back(gone_text(*entry));
  }
  for (const auto& formula : options.properties) {
    const auto answer = ask_property(scenario, formula, *ledger, name, context);
    if (!answer) return sink.already_reported();
    out.properties.push_back(property_row(formula, *answer));
  }
  page.ledger = std::move(out);
  return base::Unit{};
}

}  // namespace parallax::tools
