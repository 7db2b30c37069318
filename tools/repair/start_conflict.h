#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "tools/app/context.h"
#include "tools/app/scenario_model.h"
#include "tools/repair/evidence.h"

namespace parallax::tools {

/// Starts that a model has and its world has not. States are those of the compared fluents.
struct StartConflict {
  /// Starts of the world that the model has to have. None of them is one of the model's where the
  /// world excludes all of the model's starts: these are then the ones that the model is nearest
  /// to, and one is enough.
  std::vector<Evidence::State> wanted;
  bool is_shared = true;                 // the model has the wanted ones already
  std::vector<Evidence::State> refused;  // the model's, as far as they were looked at
  Evidence::State differs;               // in them, with the value that the world has
};

/// Compares what models say of timepoint 0 with a world that is a model.
class StartComparison {
 public:
  /// None: the world of the scenario is no model, or shows nothing of the model's fluents. `loaded`
  /// and `context` outlive the result.
  static std::unique_ptr<StartComparison> make(const ScenarioModel& loaded, const Context& context);
  ~StartComparison();

  /// The conflict of a model without its plan. None: the world has every start of the model that
  /// was looked at, or none can be compared. `every`: it is enough for a conflict that the world
  /// excludes one of several starts; else it has to exclude all.
  std::optional<StartConflict> conflict(const compiler::CompiledModel& model, bool every) const;

  struct Answer {
    bool has_wanted = false;
    std::size_t refused = 0;  // starts that the world excludes, of those that were looked at
    std::size_t missing = 0;  // fluents of the nearest wanted start that the model excludes
  };
  /// Does another model settle the conflict?
  Answer ask(const compiler::CompiledModel& model, const StartConflict& conflict) const;

  static constexpr std::size_t kMostStarts = 64;  // of a model that are looked at

 private:
  class States;
  StartComparison(const ScenarioModel& loaded, const Context& context);

  const ScenarioModel& loaded_;
  const Context& context_;
  std::map<std::string, std::string> variables_;  // of the world, by compared fluent
  std::unique_ptr<States> world_;
};

}  // namespace parallax::tools
