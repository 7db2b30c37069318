#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "compiler/pipeline/compile.h"
#include "harness/campaign/trace_input.h"
#include "runtime/session/solver_session.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// A simulation of the scenario's plan for which models make different predictions.
struct Experiment {
  /// The trace from its start to the first state in which they differ, by one of the models. In
  /// closed loop only the start is requested: the plan decides the rest.
  harness::CampaignTrace trace;
  std::size_t separated = 0;  // pairs of models
};
/// "Go(r2);PickUp(); from Parked();RobotAt(r1)": the same for the same simulation.
std::string experiment_key(const harness::CampaignTrace& trace);
/// A key of its start alone.
std::string start_key(const harness::CampaignTrace& trace);

/// Looks for simulations that tell models apart. Each model is compiled with the scenario's plan,
/// as it is run. A pair is told apart by a trace that, by its observations, only one of the two
/// has; one solver call finds it, and every other model is then asked about that trace, too. Models
/// that no trace tells apart are remembered as one.
class ExperimentChooser {
 public:
  /// `loaded` and `context` outlive the object.
  ExperimentChooser(const ScenarioModel& loaded, Context& context);
  ~ExperimentChooser();

  /// Chooses the trace that tells most pairs of `models` apart, among the traces found (at least
  /// one for every pair that can be told apart); among equals the shortest, then the first by its
  /// key. None: no trace of the plan tells any of them apart, all that do are not `usable`, or it
  /// was stopped.
  std::optional<Experiment> choose(
      const std::vector<std::string>& models,
      const std::function<bool(const harness::CampaignTrace&)>& usable);

  /// Is it known that no trace tells these two apart?
  bool are_same(const std::string& first, const std::string& second) const;

 private:
  struct Model;
  using Pair = std::pair<std::size_t, std::size_t>;  // of models_, ordered

  std::size_t number_of(const std::string& text);
  std::size_t same_as(std::size_t model) const;
  /// Finds traces of the first model that the second one does not have.
  void find(Pair pair, const std::function<bool(const harness::CampaignTrace&)>& usable,
            std::map<std::string, harness::CampaignTrace>& found);
  bool admits(Model& model, const harness::CampaignTrace& trace) const;

  const ScenarioModel& loaded_;
  Context& context_;
  std::set<std::string> observed_;  // fluents
  std::map<std::string, std::size_t> numbers_;
  std::vector<std::unique_ptr<Model>> models_;
  std::set<Pair> nothing_;                   // the first has no trace that the second has not
  std::map<std::size_t, std::size_t> same_;  // no trace tells it from an earlier one
};

}  // namespace parallax::tools
