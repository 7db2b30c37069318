#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "harness/campaign/sample_runner.h"
#include "harness/config/gate_rules.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"
#include "tools/diff/rates_revision.h"
#include "tools/diff/revision.h"

namespace parallax::tools {

/// Makes the simulator of a scenario, which the flag ends early. Reports to the context why it must
/// not be started. Scenario, context and flag outlive the factory.
using SimulatorMaker = std::function<base::Result<harness::SimulatorFactory>(
    const ScenarioModel&, Context&, const std::atomic<bool>&)>;

/// One side of a change whose scenario is run.
struct RerunSide {
  std::string scenario;                   // the file
  std::string name;                       // as messages call it
  std::optional<CommandFolder> commands;  // where the side has the files of a simulator's command
  /// A run kept the texts. A command that they name is not started, whatever is permitted.
  bool is_kept = false;
};

/// The runs of a scenario before and after a change: both from one seed, so that runs of one
/// number are a pair.
struct RerunEvidence {
  harness::GateRules::Rerun rule;
  std::string changes;  // in a line
  std::string listed;   // line by line
  std::string problem;  // why nothing is known; empty: both sides were run
  RatesRevision before, after;
};

/// Runs scenarios before and after a change, for a gate. All of them together take at most as long
/// as the rule says.
class Rerunner {
 public:
  Rerunner(SimulatorMaker make, std::int64_t jobs) : make_(std::move(make)), jobs_(jobs) {}

  /// Fills in what both sides come to, or the problem.
  void run(const RerunSide& before, const RerunSide& after, const Context& context,
           RerunEvidence& out);

 private:
  std::optional<RatesRevision> side(const RerunSide& side, const char* word, const Context& context,
                                    RerunEvidence& out);

  SimulatorMaker make_;
  std::int64_t jobs_;
  double spent_s_ = 0.0;
};

/// {"seed", "runs", "problem", "traces": [{"trace", "old": {"runs", "lost", "discrepancies"},
/// "new": {...}, "pairs": {"equal_starts", "gained", "mended"}}]}
std::string rerun_json(const RerunEvidence& evidence);

}  // namespace parallax::tools
