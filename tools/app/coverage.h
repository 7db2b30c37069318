#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "compiler/base/word_table.h"
#include "tools/app/recorded_run.h"

namespace parallax::tools {

enum class CoverageGroup : std::uint8_t {
  kPerforms,
  kBranches,  // both ways of a condition, and the two outcomes of a perform
  kHandlers,
  kRetries,  // performs that are tried again after they failed
  kEvents,
  kAxioms,  // effect axioms, preconditions, triggers
  kTraces,
};
inline constexpr auto kCoverageGroups = base::word_table<CoverageGroup>(
    "performs", "branches", "handlers", "retries", "events", "axioms", "traces");

/// Something that can be exercised, by where it stands.
struct CoverageKey {
  CoverageGroup group = CoverageGroup::kPerforms;
  std::string file;  // as messages name it
  std::uint32_t line = 0, column = 0;
  std::string id;
  friend auto operator<=>(const CoverageKey&, const CoverageKey&) = default;
};
struct CoverageCount {
  std::string text;       // what stands there, on one line; may be empty
  std::int64_t hits = 0;  // simulations that went through it
  /// Traces of the model that do; none where plans were executed only.
  std::optional<std::int64_t> traces;
};

/// How a perform of an executed plan may end, as the model has it.
struct ModelBehaviour {
  std::string file;  // of the perform
  std::uint32_t line = 0, column = 0;
  std::string event;    // "OpenDrawer(top)"
  std::string outcome;  // "succeeds", "fails", "fails with navigation-pose-unreachable"
  friend auto operator<=>(const ModelBehaviour&, const ModelBehaviour&) = default;
};
/// One that no execution showed.
struct NeverShown {
  std::string scenario;
  ModelBehaviour behaviour;
  // Executions of the scenario with a drawn start: those in which the model allows the behaviour,
  // and all.
  std::int64_t possible = 0, executions = 0;
  double confidence = 0.0;
  /// Upper confidence bound on the share of executions that show it, among those in which it is
  /// possible.
  double bound = 1.0;
};
/// A behaviour that executions showed and the model does not have.
struct WorldBehaviour {
  std::string scenario;
  std::string place;  // of the perform; empty at the start
  std::string event, outcome;
  std::string what;                  // "event", "outcome", "state": what the model lacks
  std::vector<std::string> fluents;  // as they were observed
  std::int64_t runs = 0;
  std::int64_t example = 0;  // a sample
};

struct Coverage {
  std::map<CoverageKey, CoverageCount> items;
  std::vector<std::string> scenarios;
  std::int64_t runs = 0, simulations = 0;
  std::int64_t executions = 0;  // of the simulations, those in which the plan itself was executed
  std::vector<NeverShown> never_shown;
  std::vector<WorldBehaviour> lacking;
  /// The examined traces are all that the model has, up to its bound.
  bool all_traces = true;
};

struct CoverageOptions {
  std::vector<std::string> folders;
  std::string scenario;       // of all folders, if the file was moved; may be empty
  std::int64_t limit = 1000;  // limit on examined traces of each model; 0: all
};

/// Coverage of plans and models by recorded runs. Every folder is checked against its scenario as
/// `replay` does it: reports what read_journal, load_recorded_scenario and check_recorded_run
/// report, and kCheckGivenUp for a model that is too large for the evaluator.
base::Result<Coverage> coverage_of(const CoverageOptions& options, Context& context);

}  // namespace parallax::tools
