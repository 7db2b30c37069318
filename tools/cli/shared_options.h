#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "compiler/base/diagnostic.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/replay.h"
#include "tools/app/certify.h"
#include "tools/app/model_options.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_listing.h"
#include "tools/app/trace_search.h"
#include "tools/app/traces_replay.h"
#include "tools/cli/option_table.h"

namespace parallax::harness {
class Fleet;
}

namespace parallax::tools {

class Invocation;
struct CommonOptions;

/// Options that several commands have. Returns the one of the models themselves, which is required.
Option& add_model_options(OptionTable& command, ModelOptions& options);
/// --plan and what belongs to it.
void add_plan_options(OptionTable& command, ModelOptions& options);
void add_hits_option(OptionTable& command, std::string& hits);
/// How observations are judged; empty: as the scenario says.
struct JudgingOptions {
  std::string match, compare;
};
void add_judging_options(OptionTable& command, JudgingOptions& options);
void apply(const JudgingOptions& options, harness::Scenario& scenario);
/// `--jobs` of commands that ask a solver. 0, the default: questions are not cut into cubes.
void add_cubes_option(OptionTable& command, std::int64_t& jobs);
void add_search_options(OptionTable& command, SearchOptions& options);
void add_listing_options(OptionTable& command, ListingOptions& options);
/// `--certify` takes its file after `=` only, so that a model may follow it.
void add_certify_option(OptionTable& command, CertifyOption& option);
void add_replay_options(OptionTable& command, ReplayTracesOptions& options);

/// May a command that a scenario names be started? docs/reference/trust.md.
struct CommandPermission {
  bool allow = false;   // --allow-commands
  bool refuse = false;  // --no-commands
};
/// `named`: the command takes a scenario on its command line and starts its simulator unless that
/// is forbidden.
void add_command_options(OptionTable& command, CommandPermission& permission, bool named);

/// Makes the simulator that the scenario asks for, and tells the command when the first one is
/// started. Reports kCommandNotPermitted for one that is not `permitted`. `invocation` outlives the
/// factory. With a fleet, its workers hold the simulators.
base::Result<harness::SimulatorFactory> permitted_simulator(
    const ScenarioModel& loaded, bool permitted, Invocation& invocation,
    const std::shared_ptr<harness::Fleet>& fleet = nullptr);

/// The same with half the engine's step; null where the world is not that of the built-in
/// simulator.
harness::SimulatorFactory half_step_simulator(const ScenarioModel& loaded,
                                              const Invocation& invocation);

/// `--scenario` of commands that take a run folder.
void add_recorded_scenario_option(OptionTable& command, std::string& scenario);

/// The value of `--sample` of commands that take a recorded run: none if it was not given. Reports
/// kUsage if it is no `TRACE.SAMPLE`.
base::Result<std::optional<harness::SampleId>> parse_sample_option(const std::string& text,
                                                                   base::DiagnosticSink& sink);

/// Progress of the simulations, on a line of its own that is overwritten; none unless standard
/// error is a terminal. `\r\x1b[K` clears it.
std::function<void(const harness::CampaignProgress&)> progress_on_terminal(
    const CommonOptions& options);

/// "5%" or "5" as 0.05; none if it is not a share from 0 to 100 %.
std::optional<double> share_of(std::string text);

}  // namespace parallax::tools
