#include <algorithm>
#include <filesystem>
#include <memory>

#include "compiler/artifact/artifact_writer.h"
#include "compiler/artifact/path_map.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/pipeline/compile_report.h"
#include "tools/app/certify.h"
#include "tools/app/emit_stage.h"
#include "tools/app/scenario_model.h"
#include "tools/cli/command.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct CompileOptions {
  ModelOptions model;
  std::string out;
  std::string emit = "cnf";
  bool no_projection = false;
  std::vector<std::string> path_map;
};

/// The tables go to standard error: standard output may hold the artifact.
void report_costs(const CompileOptions& options, const compiler::Compilation& compilation,
                  Invocation& invocation) {
  if (options.model.stats && !invocation.options().json) {
    write_error(compiler::cost_table(compilation.costs, invocation.files()) + '\n' +
                compiler::pass_table(compilation.passes));
  }
}

int write_front_end_stage(const CompileOptions& options, Invocation& invocation) {
  const auto text = front_end_text(options.emit, options.model, invocation);
  if (!text) return 0;
  if (options.out.empty() && invocation.options().json) {
    invocation.sink().error_about(codes::kUsage, "", "--json needs --output: the text is no JSON");
  } else if (options.out.empty()) {
    invocation.result(*text);
  } else if (base::write_output(options.out, *text, invocation.files(), invocation.sink()) &&
             invocation.options().json) {
    invocation.document("{\"status\":\"ok\"}\n");
  }
  return 0;
}

bool is_pass(std::string_view stage) {
  const auto passes = compiler::compile_passes();
  return std::any_of(passes.begin(), passes.end(),
                     [&](const auto& pass) { return pass.name == stage; });
}

int compile_and_write(CompileOptions& options, Invocation& invocation) {
  if (options.emit == "help") {
    invocation.result(stage_list());
    return 0;
  }
  if (options.model.models.empty()) {
    invocation.sink().error_about(codes::kUsage, "", "models is required");
    return 0;
  }
  if (options.emit != "cnf" && names_artifact(options.model)) {
    invocation.sink().error_about(
        codes::kUsage, options.model.models.front(),
        fmt::format("--emit={} needs the texts of the model", options.emit));
    return 0;
  }
  std::error_code error;
  compiler::PathMap paths(std::filesystem::current_path(error));
  for (const auto& rule : options.path_map) {
    if (paths.add(rule)) continue;
    invocation.sink().error_about(codes::kUsage, "--path-map",
                                  fmt::format("`{}` is not of the form FROM=TO", rule));
    return 0;
  }
  if (options.model.best && !options.model.minimize.empty()) {
    invocation.sink().error_about(
        codes::kUsage, "--best",
        "takes the model's own objectives; it does not go with --minimize");
    return 0;
  }
  const bool has_objectives = options.model.best || !options.model.minimize.empty();
  if (has_objectives && (options.emit != "cnf" || names_artifact(options.model))) {
    invocation.sink().error_about(
        codes::kUsage, options.model.best ? "--best" : "--minimize",
        "goes with the texts of a model, and into what is compiled of them (--emit=cnf)");
    return 0;
  }
  if (is_front_end_stage(options.emit)) return write_front_end_stage(options, invocation);
  auto& sink = invocation.sink();
  if (is_pass(options.emit)) options.model.emit_pass = options.emit;
  options.model.folded = true;
  auto compilation = compile_models(options.model, invocation);
  if (!compilation) return 0;
  if (options.model.best && compilation->model.objectives.empty()) {
    sink.error_about(codes::kUsage, "--best", "the model has no `minimize` statement");
    return 0;
  }
  if (options.emit == "cnf" && compilation->plan && !compilation->plan->gaps.empty()) {
    const auto& gap = compilation->plan->gaps.front();
    sink.error(
        codes::kUsage, gap.source,
        gap.kind == compiler::GapKind::kOrder
            ? fmt::format("{} are not explored, which a compiled model does not tell: what "
                          "is claimed of it would claim too much; --par=interleave explores "
                          "the orders of branches",
                          gap.text)
            : fmt::format("{}: approximated, which a compiled model does not tell: what is "
                          "claimed of it would claim too much; see docs/reference/plan_language.md",
                          gap.text));
    return 0;
  }
  if (options.emit == "cnf") tell_reservations(*compilation, invocation);
  report_costs(options, *compilation, invocation);
  compiler::map_paths(compilation->model, paths);
  const auto& model = compilation->model;
  std::string text;  // if it is not the artifact
  const base::TextPieces pieces = [&](const std::function<void(std::string_view)>& take) {
    if (options.emit != "cnf") return take(text);
    compiler::write_artifact(model, {.projection_line = !options.no_projection}, take);
  };
  if (compilation->passes.text) {
    text = base::shown_lines(*compilation->passes.text);
  } else if (options.emit != "cnf" && !compilation->plan) {
    sink.error_about(
        codes::kUsage, "",
        fmt::format("--emit={} needs a plan (--plan, or a scenario with one)", options.emit));
    return 0;
  } else if (options.emit == "cfg") {
    text = base::shown_lines(compiler::dump_text(*compilation->plan, invocation.files()));
  } else if (options.emit != "cnf") {
    text = base::shown_lines(compiler::dump_dot(*compilation->plan, invocation.files()));
  }
  if (options.out.empty() && invocation.options().json) {
    sink.error_about(codes::kUsage, "", "--json needs --output: the text is no JSON");
  } else if (options.out.empty()) {
    pieces([&](std::string_view piece) { invocation.exact_result(std::string(piece)); });
  } else if (base::write_output(options.out, pieces, invocation.files(), sink)) {
    invocation.remark(fmt::format("{}: {} variables, {} clauses, horizon {}", options.out,
                                  model.variable_count(), model.clause_count(), model.horizon));
    if (invocation.options().json) {
      const auto axioms =
          options.model.stats
              ? ",\"axioms\":" + compiler::cost_json(compilation->costs, invocation.files()) +
                    ",\"passes\":" + compiler::pass_json(compilation->passes)
              : "";
      invocation.document(fmt::format("{{\"status\":\"ok\",\"variables\":{},\"clauses\":{}{}}}\n",
                                      model.variable_count(), model.clause_count(), axioms));
    }
  }
  return 0;
}

std::vector<std::string> stage_names() {
  std::vector<std::string> names;
  for (const auto& stage : emit_stages()) names.emplace_back(stage.name);
  names.emplace_back("help");
  return names;
}

}  // namespace

Command compile_command() {
  auto options = std::make_shared<CompileOptions>();
  OptionTable command("compile",
                      "Compile a model (or a scenario's model and plan) to DIMACS with symbols");
  command.footer(
      "Examples:\n"
      "  parallax compile domain.e start.e --horizon 6 -o start.dec.cnf\n"
      "  parallax compile domain.e --stats -o domain.dec.cnf\n"
      "  parallax compile domain.e --minimize \"count Happens(event,time)\" -o domain.dec.cnf\n"
      "  parallax compile scenarios/two_regions/edge.yaml --emit=cfg\n"
      "  parallax compile domain.e start.e --plan fetch.lisp --bind robot.bind \\\n"
      "      --regions scenario.yaml --emit=cfg-dot -o plan.dot");
  add_model_options(command, options->model).is_required = false;  // --emit=help needs none
  add_plan_options(command, options->model);
  command.heading("What is written");
  command
      .option("--path-map", options->path_map,
              "FROM=TO: write TO for FROM where names of files begin with it; may be given again")
      .list(ListForm::kOneEachTime);
  command.flag("--no-projection-line", options->no_projection,
               "Leave out `c t pmc` and `c p show`, for readers that take no comment there");
  command
      .option(
          "--minimize", options->model.minimize,
          "Keep an objective for `traces --best` of what is compiled; again: a less important one")
      .list(ListForm::kOneEachTime);
  command.flag("--best", options->model.best,
               "The same with what the model's `minimize` statements say, in their order");
  command.flag(
      "--stats", options->model.stats,
      "Show on standard error what each axiom costs, dearest first, and what each pass took");
  command.option("-o,--output", options->out, "File to write; default: standard output").file();
  command
      .option("--emit", options->emit,
              "What to print: a stage, or the value after a pass; `help` lists them")
      .check(OneOf{stage_names()})
      .show_default();
  return command_of(std::move(command), options, compile_and_write);
}

}  // namespace parallax::tools
