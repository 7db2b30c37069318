#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "tools/app/discrepancy.h"
#include "tools/app/evidence.h"
#include "tools/app/explain.h"
#include "tools/app/plan_reservations.h"
#include "tools/app/scenario_model.h"
#include "tools/cli/command.h"
#include "tools/cli/explain_text.h"
#include "tools/cli/limits.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct ExplainOptions {
  ModelOptions model;
  SetOptions sets;
  WhyQuery why;
  bool asks_why = false;
  std::string sample, scenario;  // of a run folder
  FurtherRunsOptions further;
  CommandPermission commands;
};

/// The model with every axiom's clauses unsimplified by other axioms; if it is too large for that,
/// as it is solved.
std::optional<compiler::Compilation> compile(const ExplainOptions& options,
                                             Invocation& invocation) {
  const auto kept = [](base::Result<compiler::Compilation> compiled) {
    return compiled ? std::optional(*std::move(compiled)) : std::nullopt;
  };
  // A compiled model was settled when it was compiled.
  if (names_artifact(options.model)) return kept(compile_models(options.model, invocation));
  Invocation attempt(invocation.options());
  auto compiled = compile_plain_models(options.model, attempt);
  for (const auto& input : attempt.files().inputs()) invocation.files().note_input(input);
  if (compiled) return kept(std::move(compiled));
  auto usual = compile_models(options.model, invocation);
  if (!usual) return std::nullopt;
  invocation.remark(
      "the model is too large to be grounded in full: what some axioms settle for others is not "
      "shown");
  return kept(std::move(usual));
}

void report_cut_short(const runtime::MinimalSets& found, Invocation& invocation) {
  invocation.sink().error_about(codes::kExplanationCutShort, "",
                                found.proven ? "not every instance shown is needed"
                                             : "the sets may not be what was asked for");
}

/// Notes that nothing is proved by a set that blames a plan which was not explored in full.
void note_reservations(const compiler::Compilation& compilation, Contradiction& set) {
  const auto reservations = reservations_of(compilation);
  const auto& model = compilation.model;
  const bool blames_plan =
      std::any_of(set.axioms.begin(), set.axioms.end(), [&](const BlamedAxiom& axiom) {
        return model.origins[axiom.origin].kind == compiler::OriginKind::kPlanStep;
      });
  if (reservations.any() && blames_plan) set.no_proof = reservations.verdict();
}

/// Minimal sets of contradictory axioms, each printed as soon as it was examined.
int explain_contradiction(const compiler::Compilation& compilation, const SetOptions& options,
                          Invocation& invocation) {
  const auto& model = compilation.model;
  const bool as_json = invocation.options().json;
  ContradictionSearch search(model, std::nullopt, invocation);
  const auto found = search.sets(options);
  if (!found) return 0;
  if (found->sets.empty()) {
    as_json ? invocation.document(no_contradiction_json())
            : invocation.result(no_contradiction_text(model, nullptr));
    return 0;
  }
  if (!as_json) invocation.result(contradiction_head(*found, options, nullptr));
  std::vector<Contradiction> sets;
  for (const auto& set : found->sets) {
    sets.push_back(search.look_at(set));
    note_reservations(compilation, sets.back());
    if (!as_json) invocation.result(contradiction_text(model, sets.size(), sets.back()));
  }
  if (as_json) {
    invocation.document(contradictions_json(model, *found, options, nullptr, sets));
  }
  if (!invocation.stopped()) return 1;
  report_cut_short(*found, invocation);
  return 0;
}

/// Makes further simulations, if they are permitted and needed; a remark tells why not. The first
/// time, also repeats the very start that failed.
base::Result<FurtherRecords> make_further_runs(const ExplainOptions& options,
                                               const RecordedDiscrepancy& found,
                                               std::string& not_made, SameStart& persistence,
                                               Invocation& invocation) {
  const auto& sink = invocation.sink();
  FurtherRecords none;
  if (options.further.runs == 0) return none;
  // Uses the name under which the scenario was found, which a remark has told.
  const auto folder = found_again(options.model.models.front(), found.loaded);
  auto loaded =
      load_recorded_scenario(folder, *found.journal.header, ScenarioUse::kRun, invocation);
  if (!loaded) return sink.already_reported();
  if (!loaded->scenario.simulator.command.empty() && !options.commands.allow) {
    not_made = "the simulator is a command; --allow-commands permits it";
    return none;
  }
  std::error_code ignored;
  const auto place = std::filesystem::path(folder.folder) / kFurtherRuns;
  if (::access(folder.folder.c_str(), W_OK) != 0 || std::filesystem::is_symlink(place, ignored)) {
    not_made = "nothing can be written into the folder";
    return none;
  }
  const auto simulator = permitted_simulator(*loaded, true, invocation);
  if (!simulator) return sink.already_reported();
  auto further = options.further;
  further.progress = progress_on_terminal(invocation.options());
  // Executions begin where the discrepancy did, whatever the run would have chosen.
  loaded->scenario.starts = harness::Starts::kUniform;
  auto made =
      found.path.executed
          ? further_executions(folder.folder, found, *loaded, *simulator, further, invocation)
          : further_runs(folder.folder, found, *loaded, *simulator, further, invocation);
  if (made && loaded->world == nullptr && !persistence.other_seeds && !invocation.stopped()) {
    const auto again =
        same_start_runs(folder.folder, found, *loaded, *simulator,
                        half_step_simulator(*loaded, invocation), further, invocation);
    if (!again) return sink.already_reported();
    persistence = *again;
  }
  if (further.progress) clear_progress();
  return made;
}

/// The kind of cause, by the recorded runs and, where these are too few, by further ones.
base::Result<CauseEvidence> with_further_runs(const ExplainOptions& options,
                                              const RecordedDiscrepancy& found,
                                              CauseEvidence evidence, Invocation& invocation) {
  const auto& on_record = evidence.finding;
  const bool tells =
      on_record.kind != harness::CauseKind::kUnknown &&
      is_enough(options.further, on_record.failures, on_record.runs - on_record.failures);
  if (tells || !on_record.borders.empty() || on_record.contradictory_starts > 0 ||
      invocation.stopped())
    return evidence;
  SameStart persistence;
  // Doubles the number of runs for as long as they do not tell.
  for (auto asked = options; true; asked.further.enough *= 2) {
    std::string not_made;
    const auto further = make_further_runs(asked, found, not_made, persistence, invocation);
    if (!further) return invocation.sink().already_reported();
    const auto known = evidence.further;
    if (invocation.stopped()) {
      not_made = "stopped before there were enough";
    } else if (!further->samples.empty()) {
      auto more = gather_evidence(options.model.models.front(), found, *further, invocation);
      if (!more) return more;
      evidence = *std::move(more);
    }
    evidence.not_made = not_made;
    harness::weigh_persistence(persistence.other_seeds, persistence.half_step, evidence.finding);
    const bool is_known = evidence.finding.kind != harness::CauseKind::kUnknown;
    if (is_known || evidence.further == known || invocation.stopped()) return evidence;
  }
}

/// Does the trace of the discrepancy begin in several initial states?
bool has_other_starts(const RecordedDiscrepancy& found) {
  const auto line = found.journal.traces.find(found.path.id.trace);
  return line != found.journal.traces.end() && !line->second.initial_states.empty();
}

/// Explains why the model excludes the observations: in words first, then the sets, then the kind
/// of cause.
int explain_discrepancy(const RecordedDiscrepancy& found, const ExplainOptions& all_options,
                        Invocation& invocation) {
  const auto& options = all_options.sets;
  const bool as_json = invocation.options().json, verbose = invocation.options().verbosity > 0;
  const auto& model = found.loaded.compilation.model;
  const auto run = observed_run(found);
  ContradictionSearch search(model, run, invocation);
  const auto sets_found = found.parting
                              ? blamed_sets(found, options, search)
                              : base::Result<runtime::MinimalSets>(runtime::MinimalSets{});
  if (!sets_found) return 0;
  if (sets_found->sets.empty()) {
    if (as_json) {
      invocation.document(no_contradiction_json());
      return 0;
    }
    if (found.parting) {
      invocation.result(run_words_text(found, blame_words(model, found.path, *found.parting, {})));
    }
    invocation.result(no_contradiction_text(model, &run));
    return 0;
  }
  auto recorded = gather_evidence(all_options.model.models.front(), found, {}, invocation);
  // Where it may depend on the initial state, that is told first.
  const bool runs_first = recorded && has_other_starts(found);
  if (runs_first) recorded = with_further_runs(all_options, found, *recorded, invocation);
  if (!recorded) return 0;
  // Contradictory runs are reported first: then no axiom has to change at once.
  const bool cause_first = recorded->finding.contradictory_starts > 0;
  if (cause_first && !as_json) invocation.result(cause_text(*recorded) + '\n');
  if (!as_json) invocation.result(where_text(*recorded));
  std::vector<Contradiction> sets;
  std::vector<std::string> words;
  for (const auto& set : sets_found->sets) {
    sets.push_back(search.look_at(set));
    note_reservations(found.loaded.compilation, sets.back());
    words.push_back(blame_words(model, found.path, *found.parting, sets.back().clauses));
    if (as_json) continue;
    const bool is_first = sets.size() == 1;
    if (is_first) {
      invocation.result(run_words_text(found, words.front()));
      invocation.result(contradiction_head(*sets_found, options, &run, verbose));
    }
    invocation.result(contradiction_text(model, sets.size(), sets.back(),
                                         verbose ? Instances::kShort : Instances::kNone,
                                         is_first ? std::string() : words.back()));
  }
  const bool was_cut_short = invocation.stopped();
  const auto cause =
      runs_first ? recorded : with_further_runs(all_options, found, *recorded, invocation);
  if (!cause) return 0;
  if (as_json) {
    invocation.document(
        run_contradictions_json(found, *sets_found, options, run, sets, words, *cause));
  } else if (!cause_first) {
    invocation.result('\n' + cause_text(*cause));
  }
  if (!was_cut_short) {
    invocation.answered();
    return 1;
  }
  report_cut_short(*sets_found, invocation);
  return 0;
}

int explain_run(const ExplainOptions& options, Invocation& invocation) {
  if (options.asks_why || !options.model.until.empty()) {
    invocation.sink().error_about(
        codes::kUsage, options.model.models.front(),
        "--why and --until ask about models and scenarios, not about folders of runs");
    return 0;
  }
  const auto found = load_discrepancy({options.model.models.front(), options.scenario},
                                      options.sample, invocation);
  if (!found) return 0;
  if (!*found) {
    invocation.options().json
        ? invocation.document(no_contradiction_json())
        : invocation.result(
              "The run found no discrepancy: there is nothing to explain. A run "
              "with --seed or --epsilon looks further; why a fact holds in a trace "
              "is told by `parallax explain SCENARIO --why FACT`.\n");
    return 0;
  }
  return explain_discrepancy(**found, options, invocation);
}

int explain(const ExplainOptions& options, Invocation& invocation) {
  std::error_code ignored;
  const auto& first = options.model.models.front();
  if (std::filesystem::is_directory(first, ignored)) return explain_run(options, invocation);
  if (!options.sample.empty() || !options.scenario.empty()) {
    invocation.sink().error_about(codes::kUsage, first,
                                  "--sample and --scenario are for folders of runs");
    return 0;
  }
  const auto compilation = compile(options, invocation);
  if (!compilation) return 0;
  const auto* model = &compilation->model;
  if (!options.asks_why) {
    return explain_contradiction(*compilation, options.sets, invocation);
  }
  auto why = options.why;
  why.all = options.sets.all;
  const auto explanation = explain_why(*model, why, invocation);
  if (!explanation) return 0;
  invocation.options().json ? invocation.document(why_json(*model, *explanation))
                            : invocation.result(why_text(*model, *explanation));
  return 0;
}

}  // namespace

Command explain_command() {
  auto options = std::make_shared<ExplainOptions>();
  OptionTable command("explain",
                      "Say which axioms contradict each other or a run's "
                      "discrepancy, or why a fact holds in a trace");
  command.footer(
      "Examples:\n"
      "  parallax explain domain.e start.e\n"
      "  parallax explain domain.e start.e --all --time-limit 60\n"
      "  parallax explain domain.e --why \"HoldsAt(Filled(cup),3)\" --trace 2\n"
      "  parallax explain out/plan2                the first discrepancy of a run\n"
      "  parallax explain domain.e --until \"HoldsAt(At(kitchen),time)\"\n"
      "Exit code 1 if there is a contradiction, 0 if there is none or a fact was explained.");
  add_model_options(command, options->model);
  command.heading("Contradictions");
  command.flag("--all", options->sets.all,
               "All minimal sets of axioms; with --why: further causes as well");
  command.option("--limit", options->sets.limit, "With --all: stop after this many sets; 0: all")
      .check(NonNegative{});
  command.heading("Why a fact holds");
  command
      .option("--why", options->why.fact,
              "Tell what is behind this fact: HoldsAt(F(a),3), Happens(E(),2), or !...")
      .given(options->asks_why);
  command.option("--trace", options->why.trace, "The trace that --why is about")
      .check(Positive{})
      .show_default();
  command.heading("Discrepancies of a run");
  command.option("--sample", options->sample,
                 "Of a run folder: TRACE.SAMPLE; default: the first discrepancy");
  add_recorded_scenario_option(command, options->scenario);
  command
      .option("--runs", options->further.runs,
              "Most further simulations of a run's trace, to find the kind of cause; 0: none")
      .details("Simulates until ten runs have failed and ten (or none) have not.")
      .check(WholeNumber{0, 1'000'000})
      .show_default();
  command.option("-j,--jobs", options->further.jobs, "Of --runs: simulations at the same time")
      .check(WholeNumber{1, 256})
      .show_default();
  add_command_options(command, options->commands, false);
  return command_of(std::move(command), options, explain);
}

}  // namespace parallax::tools
