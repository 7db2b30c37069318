#include "tools/cli/model_options.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/artifact/artifact_writer.h"
#include "compiler/base/diagnostic_codes.h"
#include "tools/cli/signals.h"
#include "tools/cli/version.h"

namespace parallax::tools {

void add_model_options(OptionTable& command, ModelOptions& options) {
  command
      .option("models", options.models, "Model files (.e), or one that `compile` wrote (.dec.cnf)")
      .required();
  // One value each time, so that a model may follow.
  command.option("-I,--include", options.include_dirs, "Folder in which `load` looks")
      .list(ListForm::kOneEachTime);
  command.flag("--allow-outside", options.allow_outside,
               "Let `load` leave the folders of the models");
  command.option("--compat", options.compat, "Meaning of the 2005 reasoner where it differs")
      .check(OneOf{{"decreasoner"}});
  command.option("--horizon", options.horizon, "Last timepoint; replaces the range of `time`")
      .check(IntRange{0, 1'000'000});
  command
      .option("--until", options.until,
              "Formula over `time`: traces end where it holds for the first time")
      .list(ListForm::kOneEachTime);
}

void add_plan_options(OptionTable& command, ModelOptions& options) {
  command.option("--plan", options.plan, "Plan to unroll with the models (.lisp)").needs("--bind");
  command.option("--bind", options.bind, "What the plan's designators mean").needs("--plan");
  command.option("--plan-entry", options.plan_entry, "The plan's function to run").needs("--plan");
  command.option("--regions", options.regions, "Scenario whose regions the plan's poses lie in")
      .needs("--plan");
  command.option("--max-loop", options.max_loop, "Iterations of a loop that nothing static ends")
      .check(WholeNumber{1, 10'000})
      .show_default();
  command.option("--max-call-depth", options.max_call_depth, "Active calls of one function")
      .check(WholeNumber{1, 1'000})
      .show_default();
  command
      .option("--location-samples", options.location_samples,
              "Further solutions that `next-solution` has of a location")
      .check(WholeNumber{0, 1'000})
      .show_default();
  command
      .option("--par", options.par,
              "The branches of `par`: in-order, or interleave for every order of their performs")
      .check(OneOf{{"in-order", "interleave"}})
      .show_default();
  command
      .option("--max-horizon", options.max_horizon,
              "Without --horizon and a range of `time`: the longest path of the plan, but no "
              "more than this")
      .check(WholeNumber{1, 10'000})
      .show_default();
}

compiler::CompileInput compile_input(const ModelOptions& options) {
  compiler::CompileInput input;
  for (const auto& model : options.models) input.models.emplace_back(model);
  for (const auto& folder : options.include_dirs) input.load.include_dirs.emplace_back(folder);
  input.load.allow_outside = options.allow_outside;
  if (options.horizon >= 0) input.horizon = options.horizon;
  if (!options.compat.empty()) input.ground.meaning = compiler::Meaning::kDecreasoner;
  input.ground.stop = &stop_flag();
  input.costs = options.stats;
  input.lint = options.lint;
  input.producer = fmt::format("parallax {}", kVersion);
  return input;
}

bool names_artifact(const ModelOptions& options) {
  return std::any_of(options.models.begin(), options.models.end(),
                     [](const std::string& name) { return compiler::is_artifact_name(name); });
}

base::Result<compiler::CompiledModel> load_artifact(const ModelOptions& options,
                                                    Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto refuse = [&](const char* what) {
    return sink.error_about(base::DiagnosticCode::kUsage, options.models.front(), what);
  };
  if (options.models.size() > 1) {
    return refuse("a compiled model stands alone; compile the texts together instead");
  }
  if (!options.compat.empty() || !options.until.empty()) {
    return refuse("the meaning of a compiled model is fixed; give --compat and --until to compile");
  }
  auto model = compiler::load_artifact(options.models.front(), invocation.files(), sink);
  if (model && options.horizon >= 0 && options.horizon != model->horizon) {
    return sink.error_about(base::DiagnosticCode::kHorizonNotExtensible, options.models.front(),
                            options.horizon,
                            fmt::format("it was compiled for the horizon {}", model->horizon));
  }
  return model;
}

}  // namespace parallax::tools
