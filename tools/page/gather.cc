#include "tools/page/gather.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "harness/campaign/journal.h"
#include "harness/report/text_layout.h"
#include "tools/app/evidence.h"
#include "tools/app/recorded_run.h"
#include "tools/confirm/confirm.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxReportBytes = std::size_t{256} << 20U;

bool has(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// A context of its own, whose messages become banners.
Context::Form quiet(const Context& outer) {
  auto form = outer.form();
  form.json = false;
  return form;
}

std::optional<harness::JournalText> journal_of(const std::string& folder, Context& context,
                                               PageData& page) {
  if (!has(fs::path(folder) / harness::kJournalName)) {
    page.banners.push_back(
        "The folder has no journal: single simulations, timelines and the map of starts are "
        "missing.");
    return std::nullopt;
  }
  auto journal = harness::read_journal(folder, context.files(), context.sink());
  if (!journal) {
    page.banners.push_back(
        "The journal cannot be read; single simulations, timelines and the map of starts are "
        "missing. " +
        messages_of(context));
    return std::nullopt;
  }
  if (context.sink().warning_count() > 0) page.banners.push_back(messages_of(context));
  if (!journal->header) {
    page.banners.push_back("The journal ends before its first line is complete.");
    return std::nullopt;
  }
  return std::move(*journal);
}

/// Simulations that `explain` added beside the run; none if there are none, or they cannot be read.
std::optional<harness::JournalText> further_of(const std::string& folder, Context& context) {
  const auto place = fs::path(folder) / kFurtherRuns;
  if (!has(place / harness::kJournalName)) return std::nullopt;
  auto further = harness::read_journal(place, context.files(), context.sink());
  if (!further || !further->header) return std::nullopt;
  return std::move(*further);
}

void read_report(const std::string& folder, Context& context, PageData& page) {
  if (!has(fs::path(folder) / "report.json")) {
    page.running = true;
    page.banners.push_back(
        "There is no report.json yet: the run goes on, or was ended before it wrote one. "
        "`parallax run SCENARIO --out " +
        harness::shell_word(folder) + " --resume` continues it.");
    return;
  }
  const auto text = base::read_file_of(folder, "report.json", context.sink(), kMaxReportBytes);
  if (!text || !add_report(*text, page)) {
    page.banners.push_back(
        "report.json is no report of a run, or only half of one: verdict and claims are missing. " +
        messages_of(context));
  }
  // The folder may have been moved since the report named it.
  for (std::size_t i = 0; i < page.discrepancies.size(); ++i) {
    auto& found = page.discrepancies[i];
    if (found.standing.is != harness::Standing::kNotAsked) continue;
    found.standing =
        harness::standing_not_asked(folder, found.found.trace, found.found.sample, i == 0);
  }
}

/// Adds the findings that `confirm` and `threshold` left in the folder about the report's
/// discrepancies.
void add_findings(const harness::JournalText& journal, PageData& page) {
  constexpr std::size_t kMost = 50;  // discrepancies that are asked about
  for (std::size_t i = 0; i < page.discrepancies.size() && i < kMost; ++i) {
    auto& found = page.discrepancies[i];
    const auto record =
        journal.samples.find({found.found.trace, found.found.sample, harness::DrawPhase::kCertify});
    if (record == journal.samples.end()) continue;
    auto kept = kept_findings(page.folder, record->second);
    found.standing = harness::both_standings(found.standing, kept.standing);
    PageFinding finding{found.id(), std::move(kept.confirmed)};
    finding.sentences.insert(finding.sentences.end(), kept.thresholds.begin(),
                             kept.thresholds.end());
    if (!finding.sentences.empty()) page.findings.push_back(std::move(finding));
  }
}

/// The scenario of the run, if it is still what it was; else a banner says what is missing.
std::optional<ScenarioModel> scenario_of(const PageOptions& options,
                                         const harness::JournalHeader& header, Context& context,
                                         PageData& page) {
  auto loaded = load_recorded_scenario({options.folder, options.scenario}, header,
                                       ScenarioUse::kRun, context);
  if (loaded) return std::move(*loaded);
  page.banners.push_back(
      "The scenario of the run cannot be read any more as it was: sources, axioms, regions and "
      "what was observed of each fluent are missing. " +
      messages_of(context));
  return std::nullopt;
}

}  // namespace

std::string messages_of(const Context& context) {
  std::string out;
  for (const auto& diagnostic : context.sink().sorted()) {
    if (out.size() > 2000) break;
    const auto text = base::to_text(diagnostic, context.files(), {});
    out += (out.empty() ? "" : " ") + text.substr(0, text.find('\n'));
  }
  return out;
}

base::Result<PageData> gather_page(const PageOptions& options, Context& context) {
  const auto& folder = options.folder;
  std::error_code error;
  if (!fs::is_directory(folder, error) ||
      (!has(fs::path(folder) / harness::kJournalName) && !has(fs::path(folder) / "report.json"))) {
    return context.sink().error_about(codes::kNoJournal, folder);
  }
  PageData page;
  page.folder = folder;
  {
    Context own(quiet(context), context.stop());
    read_report(folder, own, page);
  }
  // One context for journal and scenario: messages about a simulation may point into both.
  Context own(quiet(context), context.stop());
  const auto journal = journal_of(folder, own, page);
  if (!journal) return page;
  const auto& header = *journal->header;
  if (page.scenario.empty()) page.scenario = header.scenario;
  if (page.simulator.empty()) page.simulator = header.simulator.name;
  const auto loaded = scenario_of(options, header, own, page);
  if (!options.ledger.empty()) {
    const auto named = options.scenario.empty() ? scenario_path(header).string() : options.scenario;
    if (!loaded && !options.properties.empty()) {
      return context.sink().error_about(codes::kReplayImpossible, folder,
                                        "its scenario is not the one that was run, so nothing can "
                                        "be said of its properties");
    }
    if (!add_ledger(options, named, context, page)) return context.sink().already_reported();
  }
  const auto further = loaded ? further_of(folder, own) : std::nullopt;
  for (const auto& [key, record] : journal->samples) {
    page.closed_loop = page.closed_loop || record.path.has_value();
  }
  add_journal(*journal, further ? &*further : nullptr, page);
  if (loaded && page.closed_loop && !page.running) {
    judge_executions(*journal, *loaded, own, page);
  }
  add_findings(*journal, page);
  add_timelines(*journal, loaded ? &*loaded : nullptr, page);
  add_motion(page);
  add_proofs(options, header, page);
  if (!loaded) return page;
  add_world(*loaded, own.files(), page);
  if (further) add_further(*further, *loaded, own, page);
  add_rule(page);
  const bool was_explained = further.has_value();
  if ((options.explain || was_explained) && !page.discrepancies.empty()) {
    Context blame(quiet(context), context.stop());
    add_blame(options, blame, page);
  }
  if (options.repair && !context.stopped()) {
    Context repair(quiet(context), context.stop());
    add_repair(options, repair, page);
  }
  return page;
}

}  // namespace parallax::tools
