#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "harness/campaign/campaign.h"
#include "harness/campaign/sample_runner.h"
#include "tools/app/closed_loop.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"
#include "tools/learn/learn.h"

namespace parallax::tools {

/// A round that is being run: what was learned so far, as `parallax run` loads it.
struct OpenRound {
  LearnRound told;
  std::filesystem::path folder;
  std::unique_ptr<Context> context;
  std::optional<ScenarioModel> loaded;
  harness::SimulatorFactory simulator;
  std::unique_ptr<ClosedLoop> loop;  // the plan was executed
};

/// The folder of a call of `learn`: a round in it is a folder with a model, a scenario and a run.
class RoundFolder {
 public:
  /// `simulator`: of worlds that are no model. The options, `loaded` and `context` outlive the
  /// object. Reports a folder that has rounds already, or cannot be written.
  static base::Result<RoundFolder> make(const LearnOptions& options, const ScenarioModel& loaded,
                                        harness::SimulatorFactory simulator, Context& context);

  /// Writes the model and its scenario, and loads it. None: `why`.
  std::optional<OpenRound> begin(const LearnRound& told, std::string_view model,
                                 harness::Execution execution, std::string& why) const;
  harness::CampaignOptions campaign(const OpenRound& round) const;
  /// A model, and a scenario that is the user's but for it. False if they cannot be written.
  bool write_scenario(const std::filesystem::path& folder, std::string_view model,
                      const std::string& model_name, const std::string& scenario_name,
                      bool closed_loop = false) const;

 private:
  RoundFolder(const LearnOptions& options, const ScenarioModel& loaded,
              harness::SimulatorFactory simulator, Context& context)
      : options_(&options),
        loaded_(&loaded),
        simulator_(std::move(simulator)),
        context_(&context) {}

  const LearnOptions* options_;
  const ScenarioModel* loaded_;
  harness::SimulatorFactory simulator_;
  Context* context_;
};

/// The first error that was reported; "it was stopped" if there is none.
std::string first_error(const base::DiagnosticSink& sink);

}  // namespace parallax::tools
