#pragma once

#include <filesystem>
#include <string>

#include "compiler/pipeline/compile.h"
#include "harness/config/scenario.h"
#include "tools/app/context.h"
#include "tools/app/model_options.h"

namespace parallax::tools {

/// A scenario with its compiled model.
struct ScenarioModel {
  harness::Scenario scenario;
  compiler::Compilation compilation;
  std::string sources_hash;   // over every text that was read
  std::string scenario_hash;  // over the scenario and what it includes
};

/// Reads the scenario, compiles model, plan and constraints, and holds the mapping and the actions
/// against the model. `costs`: also count what each axiom costs.
base::Result<ScenarioModel> load_scenario_model(const std::filesystem::path& path, Context& context,
                                                bool costs = false);

/// What the models on the command line compile to; a single .yaml is a scenario, a single .cnf has
/// been compiled before and brings neither the checked model nor the plan's graph.
base::Result<compiler::Compilation> compile_models(const ModelOptions& options, Context& context);

/// As load_scenario_model and compile_models, with a model that was grounded without settling
/// anything in advance, so that every axiom's clauses say what it says: for explanations. Models
/// that were compiled before are taken as they are.
base::Result<ScenarioModel> load_plain_scenario(const std::filesystem::path& path,
                                                Context& context);
base::Result<compiler::Compilation> compile_plain_models(const ModelOptions& options,
                                                         Context& context);

}  // namespace parallax::tools
