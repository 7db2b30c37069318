#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "harness/campaign/judge.h"
#include "harness/campaign/loop_judge.h"
#include "tools/app/closed_loop.h"
#include "tools/app/discrepancy.h"
#include "tools/app/evidence.h"
#include "tools/page/gather.h"
#include "tools/repair/experiments.h"
#include "tools/repair/repair.h"

namespace parallax::tools {
namespace {

/// Simulations that `explain` made, from a folder of the run folder; empty for another trace than
/// the discrepancy's.
FurtherRecords records_of(const std::string& folder, const char* name) {
  FurtherRecords out;
  const auto further = (std::filesystem::path(folder) / name).string();
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::path(further) / harness::kJournalName, error)) {
    return out;
  }
  Context own;
  const auto journal = harness::read_journal(further, own.files(), own.sink());
  if (!journal) return out;
  for (const auto& [key, record] : journal->samples) out.samples.push_back(record);
  out.starts = journal->starts;
  return out;
}

/// Does it happen again from the failing start?
std::optional<harness::Persistence> persistence(const RecordedDiscrepancy& found,
                                                const std::string& folder, const char* name,
                                                Context& context) {
  const auto records = of_same_start(found, records_of(folder, name).samples);
  if (records.empty()) return std::nullopt;
  const auto counted = count_failures(found, records, context);
  return counted ? std::optional(*counted) : std::nullopt;
}

PagePlace place_of(const compiler::Origin& origin) {
  PagePlace out;
  if (!origin.place.file.empty()) {
    out.place = fmt::format("{}:{}", origin.place.file, origin.place.begin.line);
  }
  out.text = origin.kind == compiler::OriginKind::kFrameAxiom ? "inertia of " + origin.text
             : origin.text.empty()                            ? std::string(to_string(origin.kind))
                                                              : origin.text;
  return out;
}

PageRule rule_of(const harness::FailureRule& rule, const std::vector<std::string>& parameters) {
  PageRule out;
  for (const auto& border : rule.borders) {
    out.borders.push_back({parameters[border.parameter], border.value, border.above});
  }
  out.failures_inside = rule.failures_inside;
  out.failures = rule.failures;
  out.clean_inside = rule.clean_inside;
  out.clean = rule.clean;
  return out;
}

}  // namespace

void add_rule(PageData& page) {
  constexpr std::size_t kMost = 200;  // of either kind; the search takes their square
  if (page.discrepancies.empty()) return;
  const auto& found = page.discrepancies.front().found;
  std::vector<harness::CauseRun> runs;
  std::size_t failed = 0, clean = 0;
  for (const auto& sample : page.samples) {
    const bool fails =
        sample.verdict == PageVerdict::kDiscrepancy && sample.cause == found.cause.text;
    if (sample.trace != found.trace || (!fails && sample.verdict != PageVerdict::kClean)) continue;
    if (++(fails ? failed : clean) <= kMost) runs.push_back({sample.start, fails});
  }
  // Those that are numbers in each of the runs.
  std::vector<std::string> parameters;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < page.variables.size(); ++i) {
    const auto is_number = [&](const auto& run) { return std::isfinite(run.start[i]); };
    if (!std::all_of(runs.begin(), runs.end(), is_number)) continue;
    kept.push_back(i);
    parameters.push_back(page.variables[i]);
  }
  for (auto& run : runs) {
    std::vector<double> start;
    for (const auto i : kept) start.push_back(run.start[i]);
    run.start = std::move(start);
  }
  if (const auto rule = harness::failure_rule(runs)) page.rule = rule_of(*rule, parameters);
}

void add_blame(const PageOptions& options, Context& context, PageData& page) {
  const auto fail = [&] {
    page.banners.push_back("Why the model cannot follow was not to be found out. " +
                           messages_of(context));
  };
  const auto found = load_discrepancy({options.folder, options.scenario}, {}, context);
  if (!found) return fail();
  if (!*found || !(*found)->parting) return;
  const auto& discrepancy = **found;
  const auto& model = discrepancy.loaded.compilation.model;
  ContradictionSearch search(model, observed_run(discrepancy), context);
  const auto sets = blamed_sets(discrepancy, {}, search);
  if (!sets) return fail();
  PageBlame blame;
  std::vector<std::size_t> clauses;
  if (!sets->sets.empty()) {
    const auto contradiction = search.look_at(sets->sets.front());
    clauses = contradiction.clauses;
    for (const auto& axiom : contradiction.axioms) {
      blame.axioms.push_back(place_of(model.origins[axiom.origin]));
    }
  }
  blame.words = blame_words(model, discrepancy.path, *discrepancy.parting, clauses);
  blame.more = consequence_words(discrepancy.path, *discrepancy.parting);
  if (auto evidence = gather_evidence(options.folder, discrepancy,
                                      records_of(options.folder, kFurtherRuns), context)) {
    harness::weigh_persistence(persistence(discrepancy, options.folder, kOtherSeeds, context),
                               persistence(discrepancy, options.folder, kHalfStep, context),
                               evidence->finding);
    blame.where = evidence->where();
    blame.cause = evidence->words();
    blame.cause_first = evidence->finding.contradictory_starts > 0;
    if (const auto& rule = evidence->finding.rule) page.rule = rule_of(*rule, evidence->parameters);
  }
  if (context.stopped()) {
    page.banners.push_back("The explanation was stopped before it was finished.");
  }
  page.blame = std::move(blame);
}

void add_repair(const PageOptions& options, Context& context, PageData& page) {
  RepairOptions asked;
  asked.folder = {options.folder, options.scenario};
  asked.plan = true;
  page.repair_was_asked = true;
  ExperimentOptions experiments;
  experiments.runs = 0;
  auto result = repair_with_experiments(asked, experiments, context);
  if (!result) {
    page.banners.push_back("No repair could be looked for. " + messages_of(context));
    return;
  }
  for (const auto& proposal : result->proposals) {
    page.proposals.push_back({proposal.words, patch_from_here(proposal.files),
                              proposal_sentences(proposal, *result), proposal.tied,
                              proposal.precaution, name_of(proposal.changes)});
  }
  if (!result->why_tied.empty()) {
    result->why_tied =
        "nothing is simulated for a page, and `parallax repair` makes runs that may tell them "
        "apart";
  }
  if (!page.proposals.empty()) {
    const auto words = tie_words(*result);
    page.repair_notes = words.refuted;
    page.repair_notes.insert(page.repair_notes.end(), words.open.begin(), words.open.end());
  }
  if (page.proposals.empty()) page.repair_words = repair_text(*result, asked);
}

void judge_executions(const harness::JournalText& journal, const ScenarioModel& loaded,
                      Context& context, PageData& page) {
  constexpr std::size_t kMost = 2000;
  const auto is_open = [](const PageSample& one) { return one.verdict == PageVerdict::kNotJudged; };
  if (std::none_of(page.samples.begin(), page.samples.end(), is_open)) return;
  auto loop = ClosedLoop::make(loaded, context);
  if (!loop) return;
  const compiler::SymbolTable symbols(loaded.compilation.model);
  const harness::ModelFluents fluents(symbols);
  std::size_t judged = 0;
  for (auto& sample : page.samples) {
    if (!is_open(sample) || context.stopped()) continue;
    const auto record = journal.samples.find(
        harness::SampleKey(sample.trace, sample.sample, harness::DrawPhase::kCertify));
    if (record == journal.samples.end() || !record->second.path) continue;
    if (++judged > kMost) break;
    const auto judgement = harness::judge_path(*loaded.scenario.mapping, fluents, **loop,
                                               record->second, loaded.scenario.comparison());
    if (!judgement.missing.empty() || judgement.admitted == base::Known::kUndecided) continue;
    const bool clean = judgement.admitted == base::Known::kYes;
    sample.verdict = clean ? PageVerdict::kClean : PageVerdict::kDiscrepancy;
    if (!clean) sample.cause = judgement.cause.text;
  }
}

void add_further(const harness::JournalText& further, const ScenarioModel& loaded, Context& context,
                 PageData& page) {
  std::optional<harness::CampaignTrace> trace;
  std::optional<harness::ModelFluents> fluents;
  for (const auto& [key, record] : further.samples) {
    const auto [number, sample, phase] = key;
    if (phase == harness::DrawPhase::kConfirm) continue;
    const bool is_known = std::any_of(
        page.samples.begin(), page.samples.end(),
        [&](const auto& one) { return one.trace == record.trace && one.sample == record.sample; });
    if (is_known) continue;
    if (record.path) {
      page.samples.push_back(page_sample(record, page));
      page.samples.back().origin = SampleOrigin::kFurther;
      continue;
    }
    if (!trace || trace->number != number) {
      const auto checked =
          check_recorded_run(loaded, harness::recorded_run(further, {number, sample}), context);
      if (!checked) return;
      trace = *checked;
      fluents.emplace(*trace->symbols);
    }
    auto out = page_sample(record, page);
    out.origin = SampleOrigin::kFurther;
    const auto whole = record.observations.size() == trace->event_count() + 1;
    if (record.status == harness::SampleStatus::kOk && whole) {
      const auto comparison = loaded.scenario.comparison();
      const auto judged =
          harness::judge(*loaded.scenario.mapping, *fluents, *trace, record.observations);
      const bool clean = judged.matches(comparison);
      out.verdict = clean ? PageVerdict::kClean : PageVerdict::kDiscrepancy;
      if (!clean) out.cause = harness::cause_of(*trace, judged, comparison, record.outcomes).text;
    }
    page.samples.push_back(std::move(out));
  }
  if (page.closed_loop) judge_executions(further, loaded, context, page);
}

}  // namespace parallax::tools
