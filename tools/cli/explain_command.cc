#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "compiler/base/diagnostic_codes.h"
#include "tools/app/explain.h"
#include "tools/app/scenario_model.h"
#include "tools/cli/command.h"
#include "tools/cli/explain_text.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct ExplainOptions {
  ModelOptions model;
  SetOptions sets;
  WhyQuery why;
  bool asks_why = false;
  std::string sample, scenario;  // of a run folder
};

/// The model with every axiom's clauses as it says them, whatever other axioms settle; if it is too
/// large for that, as it is solved.
std::optional<compiler::CompiledModel> compile(const ExplainOptions& options,
                                               Invocation& invocation) {
  Invocation attempt(invocation.options());
  auto compiled = compile_plain_models(options.model, attempt);
  if (compiled) return std::move(compiled->model);
  auto usual = compile_models(options.model, invocation);
  if (!usual) return std::nullopt;
  invocation.remark(
      "the model is too large to be grounded in full: what some axioms settle for others is not "
      "shown");
  return std::move(usual->model);
}

/// Minimal sets of contradictory axioms, each printed as soon as it was looked at.
int explain_contradiction(const compiler::CompiledModel& model,
                          const std::optional<ObservedRun>& run, const SetOptions& options,
                          Invocation& invocation) {
  const bool as_json = invocation.options().json;
  const auto* observed = run ? &*run : nullptr;
  ContradictionSearch search(model, run, invocation);
  const auto found = search.sets(options);
  if (!found) return 0;
  if (found->sets.empty()) {
    as_json ? invocation.document(no_contradiction_json())
            : invocation.result(no_contradiction_text(model, observed));
    return 0;
  }
  if (!as_json) invocation.result(contradiction_head(*found, options, observed));
  std::vector<Contradiction> sets;
  for (const auto& set : found->sets) {
    sets.push_back(search.look_at(set));
    if (!as_json) invocation.result(contradiction_text(model, sets.size(), sets.back()));
  }
  if (as_json) {
    invocation.document(contradictions_json(model, *found, options, observed, sets));
  }
  if (!invocation.stopped()) return 1;
  invocation.sink().error_about(base::DiagnosticCode::kExplanationCutShort, "",
                                found->proven ? "not every instance shown is needed"
                                              : "the sets may not be what was asked for");
  return 0;
}

int explain_run(const ExplainOptions& options, Invocation& invocation) {
  if (options.asks_why || !options.model.until.empty()) {
    invocation.sink().error_about(
        base::DiagnosticCode::kUsage, options.model.models.front(),
        "--why and --until ask about models and scenarios, not about folders of runs");
    return 0;
  }
  const auto found = load_discrepancy({options.model.models.front(), options.scenario},
                                      options.sample, invocation);
  if (!found) return 0;
  if (!*found) {
    invocation.options().json
        ? invocation.document(no_contradiction_json())
        : invocation.result("The run found no discrepancy: there is nothing to explain.\n");
    return 0;
  }
  const auto& [loaded, run] = **found;
  return explain_contradiction(loaded.compilation.model, run, options.sets, invocation);
}

int explain(const ExplainOptions& options, Invocation& invocation) {
  std::error_code ignored;
  const auto& first = options.model.models.front();
  if (std::filesystem::is_directory(first, ignored)) return explain_run(options, invocation);
  if (!options.sample.empty() || !options.scenario.empty()) {
    invocation.sink().error_about(base::DiagnosticCode::kUsage, first,
                                  "--sample and --scenario are for folders of runs");
    return 0;
  }
  const auto model = compile(options, invocation);
  if (!model) return 0;
  if (!options.asks_why) {
    return explain_contradiction(*model, std::nullopt, options.sets, invocation);
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
  command.flag("--all", options->sets.all,
               "All minimal sets of axioms; with --why: further causes as well");
  command.option("--limit", options->sets.limit, "With --all: stop after this many sets; 0: all")
      .check(NonNegative{});
  command
      .option("--why", options->why.fact,
              "Tell what is behind this fact: HoldsAt(F(a),3), Happens(E(),2), or !...")
      .given(options->asks_why);
  command.option("--trace", options->why.trace, "The trace that --why is about")
      .check(Positive{})
      .show_default();
  command.option("--sample", options->sample,
                 "Of a run folder: TRACE.SAMPLE; default: the first discrepancy");
  add_recorded_scenario_option(command, options->scenario);
  return {std::move(command),
          [options](Invocation& invocation) { return explain(*options, invocation); }};
}

}  // namespace parallax::tools
