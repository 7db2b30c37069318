#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/confidence/comparison.h"
#include "harness/confidence/criterion_spec.h"
#include "harness/law/sampling_law.h"
#include "harness/region/state_mapping.h"
#include "harness/search/strategy.h"
#include "harness/simulator/process_limits.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// The size limit of a scenario or a manifest, and of each file that it includes.
inline constexpr std::size_t kMaxScenarioBytes = std::size_t{1} << 20U;

/// A text of the scenario with its place, for messages and for parsing elsewhere.
struct LocatedText {
  std::string text;
  base::SourceRange source;
};

/// The weight of starts in which a formula holds, for executions of a plan.
struct StartWeight {
  LocatedText when;
  double weight = 1.0;
};

/// Event symbol -> controller with its fixed arguments; what the plan says of a perform is laid
/// over them (a pose `target` becomes target.x, target.y, target.z, target.yaw).
/// In a text argument "{0}" stands for the event's argument 0.
/// With `from_plan`, only the arguments that it names are taken from the plan, under new names;
/// a name stands for all that begins with it and a dot.
struct ActionBinding {
  std::string event;
  std::size_t arity = 0;
  std::string controller;
  State arguments;
  std::optional<std::map<std::string, std::string>> from_plan;
  double time_limit_s = 60.0;
  base::SourceRange source;
  std::map<std::string, base::SourceRange> argument_sources;  // of the values in `arguments`
};

/// The simulator, with the limits of its process.
struct SimulatorSpec : ProcessLimits {
  std::vector<std::string> command;      // of an external one
  std::vector<LocatedText> models;       // of a world that is a model
  EngineKind engine = EngineKind::kOde;  // of the built-in one
  /// The built-in engine and its robots, which the world of the scenario is for.
  bool is_built_in() const { return command.empty() && models.empty(); }
  std::int64_t recycle_after = 0;  // resets after which the process is replaced; 0: never
  base::SourceRange source;
};

struct Limits {
  /// Valid simulations per trace; 0: twice what the criterion needs, at least 300.
  std::int64_t max_runs = 0;
  std::optional<base::SourceRange> max_runs_source;
  std::int64_t max_traces = 0;             // 0: all
  std::int64_t max_rejected_starts = 100;  // in a row, for one sample
  std::int64_t max_lost_in_a_row = 3;
  /// Limits of one execution of the plan in closed loop: performs (0: as many as its longest path
  /// has, at most 50) and simulated seconds.
  std::int64_t max_performs = 0;
  double max_simulated_s = 3600.0;
};

/// The expected cause of the discrepancies of a case; empty fields are not compared.
struct CauseExpectation {
  std::string event;   // after which they leave the model: "Place(r1)"
  std::string fluent;  // among those that differ there: "BoxIn(r1)"
  std::string reason;  // of an action that failed, in the simulator's word
  std::string kind;    // as `parallax explain` tells it: "always", "region", ...
  base::SourceRange source, event_source, fluent_source;
};

/// The expected rate of discrepancies of any kind in uniform runs of one trace (`parallax rates`).
struct RateExpectation {
  std::int64_t trace = 1, runs = 100;
  bool fixed_runs = true;  // false: `runs` are the most, and end as soon as they tell
  double lower = 0.0, upper = 1.0;
  /// None: the interval measured with 95 % confidence has to meet this one, which few runs nearly
  /// always do. Else the runs have to show with this confidence that the rate lies in it.
  std::optional<double> confidence;
  std::optional<CauseExpectation> cause;  // of each discrepancy
};

/// The expected result that `parallax suite` and the tests compare with.
struct Expectation {
  std::optional<std::string> verdict;
  std::optional<std::int64_t> iterations;
  std::optional<std::int64_t> max_simulations;
  std::vector<std::string> fluents;  // each of these must be among the diverging ones
  std::optional<CauseExpectation> cause;
  base::SourceRange source, fluents_source;
  std::optional<RateExpectation> rate;
  std::optional<double> time_limit_s;  // of each process of the case
  bool fast = false;                   // belongs to the part of a suite that is always run

  /// Is anything expected of a whole run?
  bool of_run() const {
    return verdict || iterations || max_simulations || cause || !fluents.empty();
  }
};

/// How states are compared where `compare` does not say: the paper's rule is about last states,
/// every other claim about every step.
constexpr Comparison comparison_by(const CriterionSpec& criterion) {
  return criterion.kind == CriterionKind::kPaper ? Comparison::kFinal : Comparison::kEveryStep;
}

/// A scenario file as checked data. Paths are resolved against the file's folder.
struct Scenario {
  std::filesystem::path file;
  base::FileId source;
  std::string name;   // the file as the user wrote it
  std::string title;  // what it calls itself; may be empty
  std::vector<LocatedText> models;
  std::vector<LocatedText> plan;  // files and folders in order
  std::optional<LocatedText> bind;
  std::vector<LocatedText> constraints;
  std::int32_t horizon = 0;
  /// Event symbols: they may happen without being told of (`parallax monitor`).
  std::vector<std::string> unobserved;
  WorldSpec world;
  std::optional<StateMapping> mapping;
  std::vector<ActionBinding> actions;  // sorted by event
  std::vector<SampledDimension> sampling;
  SamplingLaw law;                 // by which they are drawn, where that is not uniformly
  double sampling_inset_m = 1e-6;  // [m, rad] how far draws stay inside their cuboid
  base::SourceRange regions_source, mapping_source, actions_source, sampling_source;
  std::map<std::string, base::SourceRange> sampled_sources;  // of the variables there
  /// The place where the sampling of a variable is written, or would be.
  const base::SourceRange& sampled_at(const std::string& variable) const {
    const auto found = sampled_sources.find(variable);
    return found == sampled_sources.end() ? sampling_source : found->second;
  }
  std::map<std::string, base::SourceRange> body_sources;  // of the names of the world's bodies
  CriterionSpec criterion;
  /// An end state that the model admits for the start and events of a trace is no discrepancy, even
  /// if it is not the trace's; false: only the trace's own counts.
  bool match_model = true;
  Execution execution = Execution::kOpenLoop;
  base::SourceRange execution_source;
  Starts starts = Starts::kUniform;
  Initial initial = Initial::kAll;
  base::SourceRange initial_source;  // where it is written
  /// Initial states are drawn by the weight of the first formula that holds in them, 1
  /// where none does; without entries each is equally likely.
  std::vector<StartWeight> start_weights;
  base::SourceRange start_weights_source;
  /// Goes on until every trace was simulated; in closed loop, until executions showed what the
  /// model has executions with, or what they did not show is rarer than epsilon.
  bool until_covered = false;
  SearchSpec search;                  // before the runs that anything is claimed from
  std::optional<Comparison> compare;  // none: by the criterion
  Comparison comparison() const { return compare.value_or(comparison_by(criterion)); }
  SimulatorSpec simulator;
  Limits limits;
  std::optional<Expectation> expect;
};

/// Reads and checks a scenario; several errors per run, each at its key. Unknown keys get a
/// suggestion; duplicate keys, aliases and tags are refused, and so are paths that lead out of the
/// scenario's folder (PathGate), unless `allow_outside`. What it names becomes an input of `files`,
/// whether or not the caller reads it.
base::Result<Scenario> load_scenario(const std::filesystem::path& path, base::SourceFiles& files,
                                     base::DiagnosticSink& sink, bool allow_outside = false);

/// A file that holds what a scenario has under `world`: a robot, a building.
base::Result<WorldSpec> load_world(const std::filesystem::path& path, base::SourceFiles& files,
                                   base::DiagnosticSink& sink, bool allow_outside = false);

/// Holds the scenario against the compiled model, before anything is simulated: every ground fluent
/// needs a mapping of its arity whose region exists, whose range its joint reaches and which
/// the built-in simulator observes, every ground
/// event an action whose arguments the world knows. Reports each offending symbol or argument once,
/// at its value or the `mapping:` or `actions:` key, with the near name as a fix; warns of a
/// mapping or an action that the model has no use for. A mapping that ignores every fluent is an
/// error, as each simulation would then pass.
base::Status check_against_model(const Scenario& scenario, const std::vector<std::string>& fluents,
                                 const std::vector<std::string>& events,
                                 base::DiagnosticSink& sink);

/// An event that is to make a fluent hold, or not hold, by an effect axiom of the model; both are
/// ground, so that names with placeholders (`{drawer}`) can be filled in.
struct CausedFluent {
  GroundFluent event, fluent;
  bool holds = true;
  State planned{};  // arguments that the plan gives, laid over those of the action
};

/// Does the controller of the event lead a drawer or a door to a stop?
bool leads_to_stop(const Scenario& scenario, const std::string& event);

/// Reports a range of the mapping that the controller of an event leads a drawer or a door out of,
/// although the event is to bring the fluent about: every simulation would be a discrepancy.
void check_stops(const Scenario& scenario, const std::vector<CausedFluent>& caused,
                 base::DiagnosticSink& sink);

/// Binds fluents and events by name in a discrete world (`info`): fluents without a mapping become
/// the fluents of the same name there, or are ignored where it has none; events without an action
/// become the event of the same name. Reports kSimulatorLacksEvent and kUnknownController for
/// ground events that the world does not have.
base::Status bind_by_name(Scenario& scenario, const std::vector<std::string>& fluents,
                          const std::vector<std::string>& events, const SimulatorInfo& info,
                          base::DiagnosticSink& sink);

/// The same against what the simulator says of itself: sampled variables must be settable, the
/// variables that these fluents are read from observable, controllers known. What the simulator
/// does not list is not checked.
base::Status check_against_simulator(const Scenario& scenario,
                                     const std::vector<GroundFluent>& fluents,
                                     const SimulatorInfo& info, base::DiagnosticSink& sink);

}  // namespace parallax::harness
