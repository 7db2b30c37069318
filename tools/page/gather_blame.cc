#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "harness/campaign/judge.h"
#include "runtime/session/solver_session.h"
#include "tools/app/discrepancy.h"
#include "tools/app/evidence.h"
#include "tools/app/observed_path.h"
#include "tools/page/gather.h"
#include "tools/repair/repair.h"

namespace parallax::tools {
namespace {

/// Simulations that `explain` made; of those of another trace than the discrepancy's there are
/// none.
std::vector<harness::SampleRecord> further_records(const std::string& folder) {
  std::vector<harness::SampleRecord> out;
  const auto further = (std::filesystem::path(folder) / kFurtherRuns).string();
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::path(further) / harness::kJournalName, error)) {
    return out;
  }
  Context own;
  const auto journal = harness::read_journal(further, own.files(), own.sink());
  if (!journal) return out;
  for (const auto& [key, record] : journal->samples) out.push_back(record);
  return out;
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

void add_rule(const CauseEvidence& evidence, PageBlame& blame) {
  blame.cause = evidence.words();
  const auto& rule = evidence.finding.rule;
  if (!rule) return;
  for (const auto& border : rule->borders) {
    blame.rule.push_back({evidence.parameters[border.parameter], border.value, border.above});
  }
  blame.failures_inside = rule->failures_inside;
  blame.failures = rule->failures;
  blame.clean_inside = rule->clean_inside;
  blame.clean = rule->clean;
}

}  // namespace

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
  if (const auto evidence =
          gather_evidence(discrepancy, further_records(options.folder), context)) {
    add_rule(*evidence, blame);
  }
  if (context.stopped()) {
    page.banners.push_back("The explanation was stopped before it was finished.");
  }
  page.blame = std::move(blame);
}

void add_repair(const PageOptions& options, Context& context, PageData& page) {
  RepairOptions asked;
  asked.folder = {options.folder, options.scenario};
  page.repair_was_asked = true;
  const auto result = propose_repairs(asked, context);
  if (!result) {
    page.banners.push_back("No repair could be looked for. " + messages_of(context));
    return;
  }
  std::error_code error;
  const auto here = std::filesystem::current_path(error).string();
  for (const auto& proposal : result->proposals) {
    const auto& verdict = proposal.verdict;
    page.proposals.push_back(
        {proposal.words,
         fmt::format("consistent with {} of {} recorded runs, with {} of them to the end",
                     verdict.runs_consistent, result->runs, verdict.runs_whole),
         unified_diff(proposal.files, here)});
  }
  if (page.proposals.empty()) page.repair_words = repair_text(*result, asked);
}

void judge_executions(const harness::JournalText& journal, const ScenarioModel& loaded,
                      Context& context, PageData& page) {
  constexpr std::size_t kMost = 2000;
  const auto is_open = [](const PageSample& one) {
    return one.verdict == SampleVerdict::kNotJudged;
  };
  if (std::none_of(page.samples.begin(), page.samples.end(), is_open)) return;
  const auto paths = observed_paths(loaded, journal, context);
  if (!paths) return;
  std::map<std::pair<std::int64_t, std::int64_t>, const ObservedPath*> by_id;
  for (const auto& path : *paths) by_id[{path.id.trace, path.id.sample}] = &path;
  const auto& model = loaded.compilation.model;
  const PathFacts facts(model);
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  std::size_t judged = 0;
  for (auto& sample : page.samples) {
    const auto path = by_id.find({sample.trace, sample.sample});
    if (!is_open(sample) || path == by_id.end() || context.stopped()) continue;
    if (++judged > kMost) break;
    const auto parting = parting_of(*path->second, facts, session);
    if (parting.undecided) continue;
    sample.verdict = parting.after ? SampleVerdict::kDiscrepancy : SampleVerdict::kClean;
    if (!parting.after) continue;
    const auto& causes = page.traces.empty() ? std::vector<PageCause>() : page.traces[0].causes;
    const auto& steps = path->second->steps;
    if (causes.size() == 1) {
      sample.cause = causes.front().cause;
    } else if (*parting.after > 0 && *parting.after <= steps.size()) {
      const auto& step = steps[*parting.after - 1];
      sample.cause = step.name + (step.succeeded ? "" : ": " + harness::reason_word(step.outcome));
    }
  }
}

void add_further(const harness::JournalText& further, const ScenarioModel& loaded, Context& context,
                 PageData& page) {
  std::optional<harness::CampaignTrace> trace;
  std::optional<harness::ModelFluents> fluents;
  for (const auto& [key, record] : further.samples) {
    const auto [number, sample, phase] = key;
    if (phase == harness::DrawPhase::kConfirm || record.path) continue;
    const bool is_known = std::any_of(
        page.samples.begin(), page.samples.end(),
        [&](const auto& one) { return one.trace == record.trace && one.sample == record.sample; });
    if (is_known) continue;
    if (!trace || trace->number != number) {
      const auto checked =
          check_recorded_run(loaded, harness::recorded_run(further, {number, sample}), context);
      if (!checked) return;
      trace = *checked;
      fluents.emplace(*trace->symbols);
    }
    auto out = page_sample(record, page);
    out.further = true;
    const auto whole = record.observations.size() == trace->event_count() + 1;
    if (record.status == harness::SampleStatus::kOk && whole) {
      const auto comparison = loaded.scenario.comparison();
      const auto judged =
          harness::judge(*loaded.scenario.mapping, *fluents, *trace, record.observations);
      const bool clean = judged.matches(comparison);
      out.verdict = clean ? SampleVerdict::kClean : SampleVerdict::kDiscrepancy;
      if (!clean) out.cause = harness::cause_of(*trace, judged, comparison, record.outcomes).text;
    }
    page.samples.push_back(std::move(out));
  }
}

}  // namespace parallax::tools
