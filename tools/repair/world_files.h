#pragma once

#include <string>
#include <vector>

#include "harness/config/scenario.h"
#include "tools/app/context.h"
#include "tools/repair/patch.h"

namespace parallax::tools {

/// The files of the model that is the scenario's world, with those that they load. Empty where the
/// world is not a model, or can no longer be read.
std::vector<std::string> world_files(const harness::Scenario& scenario, const Context& context);
/// The same of the scenario's model.
std::vector<std::string> model_files(const harness::Scenario& scenario, const Context& context);

/// The changed files that the world reads, too, by their names. Changing them changes the world
/// with the model.
std::vector<std::string> read_by_world(const harness::Scenario& scenario,
                                       const std::vector<ChangedFile>& files,
                                       const Context& context);

}  // namespace parallax::tools
