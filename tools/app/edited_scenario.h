#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "compiler/pipeline/compile.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {

/// Texts that replace those that a scenario names.
struct EditedTexts {
  std::optional<std::string> model;
  std::map<std::string, std::string> plan;  // by the name of the file; others stay as they are
  std::optional<std::int64_t> horizon;      // none: that of the scenario as it is run
  bool constraints = false;                 // with those of the scenario
  std::string property;  // instead of them: executions end where it does not hold
};

/// The scenario with other texts, as it is run. `context` has them afterwards; what is wrong with
/// them is in its sink.
base::Result<compiler::Compilation> compile_edited(const harness::Scenario& scenario,
                                                   const EditedTexts& texts, Context& context);

}  // namespace parallax::tools
