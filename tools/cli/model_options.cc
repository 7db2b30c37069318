#include "tools/cli/model_options.h"

#include "tools/cli/signals.h"

namespace parallax::tools {

void add_model_options(CLI::App& command, ModelOptions& options) {
  command.add_option("models", options.models, "Model files (.e)")->required();
  command.add_option("-I,--include", options.include_dirs, "Folder in which `load` looks");
  command.add_flag("--allow-outside", options.allow_outside,
                   "Let `load` leave the folders of the models");
  command.add_option("--compat", options.compat, "Meaning of the 2005 reasoner where it differs")
      ->check(CLI::IsMember({"decreasoner"}));
  command.add_option("--horizon", options.horizon, "Last timepoint; replaces the range of `time`")
      ->check(CLI::Range(0, 1'000'000));
  command.add_option("--until", options.until,
                     "Formula over `time`: traces end where it holds for the first time");
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
  return input;
}

}  // namespace parallax::tools
