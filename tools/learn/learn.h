#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/result.h"
#include "compiler/base/word_table.h"
#include "harness/campaign/campaign.h"
#include "harness/campaign/sample_runner.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"
#include "tools/learn/state_axioms.h"

namespace parallax::tools {

struct LearnOptions {
  std::string scenario;
  std::filesystem::path out;  // the folder that everything is written to; must not have a run yet
  std::filesystem::path model_file;  // may be empty; is to get the model, by the caller: no input
  std::uint64_t seed = 1;
  std::int64_t jobs = 1;
  std::int64_t max_runs = 500;  // simulations in all
  std::int64_t explore = 0;     // random sequences
  std::string tool_version;
  std::function<void(const harness::CampaignProgress&)> progress;
};

/// One run with the model learned so far, and its result.
struct LearnRound {
  enum class Kind : std::uint8_t { kPlan, kTraces, kSequences };
  std::int64_t number = 0;
  Kind kind = Kind::kPlan;  // the plan was executed; its traces were simulated; random sequences
  std::int64_t simulations = 0;
  std::string outcome;      // "no-discrepancy", ...; of sequences how many were as predicted
  std::size_t axioms = 0;   // about events, of the model that it ran with
  std::size_t changed = 0;  // of them and of the next model's: those that only one of them has
};
inline constexpr auto kLearnRoundWords =
    base::word_table<LearnRound::Kind>("plan", "traces", "sequences");
constexpr std::string_view to_string(LearnRound::Kind kind) { return kLearnRoundWords.of(kind); }

struct LearnResult {
  std::string model;        // text
  std::size_t axioms = 0;   // about events
  std::size_t dropped = 0;  // statements about events that the scenario's model had
  bool clean = false;       // the scenario's run ended without a discrepancy
  std::vector<std::string> claims;
  /// Only the plan's executions were judged although the scenario simulates traces: the model
  /// leaves outcomes open, and a trace is only one way that they can go.
  bool judged_in_closed_loop = false;
  std::vector<RefutedFormula> refuted;  // formulas about states that runs contradict
  std::string why;                      // it is not clean
  std::int64_t simulations = 0;         // in all, repetitions of discrepancies included
  std::int64_t sequences = 0;           // of them random ones
  std::int64_t sequences_clean = 0;     // number of last ones that taught nothing
  std::size_t runs = 0, admitted = 0;   // runs learned from; those that the model admits
  std::vector<LearnRound> rounds;
  std::vector<std::string> not_learnable, contradictions, remarks;
};

/// Learns what the events of the scenario's model do from runs alone: the model's own axioms about
/// events are dropped before anything is simulated. The plan is executed with the current model,
/// first without any effects. Each deviation gives another model, which admits every run so far,
/// until a run of the scenario is clean, the budget is used up or nothing more can be learned.
/// Everything is written to `out`: the model, a scenario with it, a log, and the rounds, each a run
/// folder with its model. Reports what load_scenario_model reports. `make_simulator` is asked for
/// worlds that are not models; it is given the scenario as it was loaded.
base::Result<LearnResult> learn(
    const LearnOptions& options,
    const std::function<base::Result<harness::SimulatorFactory>(const ScenarioModel&)>&
        make_simulator,
    Context& context);

constexpr std::string_view kJudgedInClosedLoop =
    "judged in closed loop: the model leaves outcomes open, and a trace that is simulated is only "
    "one way that they can go";
/// "formula contradicted by run 1/1.4: common.e:47: ..."
std::string refuted_text(const RefutedFormula& formula);
std::string learn_log(const LearnResult& result);
std::string learn_json(const LearnResult& result, const LearnOptions& options);

}  // namespace parallax::tools
