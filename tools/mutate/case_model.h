#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/syntax/loader.h"
#include "harness/config/scenario.h"
#include "tools/app/context.h"
#include "tools/suite/suite_case.h"

namespace parallax::tools {

/// The model of a suite's case with its plan, compiled for its horizon as the command that the case
/// runs compiles them, except for state constraints, which end no trace when models are compared.
struct CaseModel {
  compiler::CompiledModel compiled;
  std::string key;  // equal for equal compiled models
  std::optional<compiler::PlanGraph> plan;
  std::vector<std::filesystem::path> models;  // that it names
  compiler::LoadOptions load;                 // how they are read
  std::optional<harness::Scenario> scenario;  // that it is about
};

/// `context` has the texts afterwards, and the errors in them.
base::Result<CaseModel> load_case_model(const SuiteCase& one, Context& context);

/// Do controllers surely get the same arguments under two plans with the same events?
bool same_arguments(const compiler::PlanGraph& a, const compiler::PlanGraph& b);

/// Does the case start simulations? Others are answered by a solver alone.
inline bool simulates(const SuiteCase& one) {
  return std::holds_alternative<harness::Expectation>(one.check);
}

}  // namespace parallax::tools
