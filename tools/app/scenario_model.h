#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "compiler/base/source_file.h"
#include "compiler/pipeline/compile.h"
#include "harness/campaign/journal_format.h"
#include "harness/campaign/sample_runner.h"
#include "harness/config/scenario.h"
#include "tools/app/context.h"
#include "tools/app/model_options.h"

namespace parallax::harness {
struct ScenarioSettings;
struct SteppedModel;
}  // namespace parallax::harness

namespace parallax::tools {

/// A scenario with its compiled model.
struct ScenarioModel {
  harness::Scenario scenario;
  compiler::Compilation compilation;
  std::string sources_hash;   // over every text that was read
  std::string scenario_hash;  // over the scenario and what it includes
  /// The world, where the simulator is a model.
  std::shared_ptr<const harness::SteppedModel> world = nullptr;
  std::string world_hash = {};  // over its texts
  /// Set if the model was loaded from texts that a run kept; owns their temporary folder.
  std::shared_ptr<const struct KeptTexts> kept = nullptr;
};

/// How a command needs a scenario's model.
struct ScenarioNeeds {
  /// In the way that the scenario, or `execution`, asks for: for closed loop the model is compiled
  /// without constraints, for as many timepoints as an execution of the plan may take, and with a
  /// way for each reason of a failure. Reports kNoPlanToExecute.
  bool as_run = false;
  std::optional<harness::Execution> execution = std::nullopt;
  /// Nothing is simulated: unobserved events need no action, and where the plan is executed its
  /// failures raise what their reasons are bound to.
  bool watched = false;
  /// Grounded without settling anything in advance, so that every axiom's clauses say what it says:
  /// for explanations.
  bool plain = false;
  bool lint = false;  // also report what is legal but hardly meant
  bool with_plan = true;
  std::optional<std::int64_t> horizon = std::nullopt;  // instead of the scenario's
  harness::ScenarioSettings* settings = nullptr;       // as in LoadLimits
  const ModelOptions* given = nullptr;  // options that apply to it (compile_models); null: none
};

/// Reads the scenario, compiles model, plan and constraints, and checks the mapping and the actions
/// against the model.
base::Result<ScenarioModel> load_scenario_model(const std::filesystem::path& path, Context& context,
                                                const ScenarioNeeds& needs = {});

/// Reads the files of the scenario's plan, in their order.
base::Result<std::vector<base::FileId>> load_scenario_plan(const harness::Scenario& scenario,
                                                           Context& context);

/// The scenario's model once more, for another horizon, with its plan or for any events. None where
/// that fails; nothing is reported.
std::optional<compiler::CompiledModel> compile_variant(const harness::Scenario& scenario,
                                                       std::int64_t horizon, bool with_plan,
                                                       Context& context);

/// The scenario's plan with another text for its model, as it is run in this way; `constraints`:
/// with those of the scenario. `context` has the texts afterwards.
base::Result<compiler::Compilation> compile_with_model(const harness::Scenario& scenario,
                                                       std::string model,
                                                       harness::Execution execution,
                                                       bool constraints, Context& context);

/// Compiles the models on the command line; a single .yaml is a scenario, a single .cnf has been
/// compiled before and brings neither the checked model nor the plan's graph. With a scenario the
/// options that say how a plan is unrolled, --include and --horizon apply; others are refused
/// (fits_scenario).
base::Result<compiler::Compilation> compile_models(const ModelOptions& options, Context& context);

/// The same for explanations (ScenarioNeeds::plain). Models that were compiled before are taken as
/// they are.
base::Result<compiler::Compilation> compile_plain_models(const ModelOptions& options,
                                                         Context& context);

/// Where a formula of the scenario can be parsed: in the file itself if it stands there word for
/// word, else (escapes, folded lines) as a text of its own.
compiler::ConstraintText constraint_text(const harness::LocatedText& text,
                                         base::SourceFiles& files);

/// The text of an option (`--until`) as a text of its own among the files, so that it is parsed by
/// itself and messages point into it. kUsage if it says nothing: blanks and comments at most.
base::Result<base::SourceRange> formula_argument(const std::string& option, const std::string& text,
                                                 Context& context);

}  // namespace parallax::tools
