#include <filesystem>
#include <memory>
#include <optional>

#include "tools/app/explain.h"
#include "tools/app/scenario_model.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct ExplainOptions {
  ModelOptions model;
  SetOptions sets;
  WhyCommand why;
  bool asks_why = false;
  std::string sample;  // of a run folder
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

int explain(const ExplainOptions& options, Invocation& invocation) {
  const auto& first = options.model.models.front();
  std::error_code ignored;
  if (std::filesystem::is_directory(first, ignored)) {
    return explain_run(first, options.sample, options.sets, invocation);
  }
  const auto model = compile(options, invocation);
  if (!model) return 0;
  if (!options.asks_why) return explain_sets(*model, options.sets, std::nullopt, invocation);
  auto why = options.why;
  why.all = options.sets.all;
  return explain_why(*model, why, invocation);
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
  return {std::move(command),
          [options](Invocation& invocation) { return explain(*options, invocation); }};
}

}  // namespace parallax::tools
