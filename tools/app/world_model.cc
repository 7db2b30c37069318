#include "tools/app/world_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "compiler/base/codes/scenarios.h"
#include "compiler/pipeline/compile.h"
#include "runtime/session/solver_session.h"
#include "tools/app/version.h"

namespace parallax::tools {
namespace {

// A world needs a step that follows another one, so that it is known how it goes on.
constexpr std::int64_t kLeastSteps = 2;

/// Reports a world without an execution, with the axioms that exclude each other.
base::Status check_execution(const compiler::CompiledModel& model, compiler::Timepoint steps,
                             base::SourceRange place, Context& context) {
  const auto core =
      runtime::find_unsat_core(model, steps, runtime::make_cadical_solver(&context.stop()));
  if (core.status != runtime::SolveStatus::kUnsatisfiable) return base::Unit{};
  auto error =
      context.sink().error(codes::kWorldNotPlayable, place,
                           steps == 0 ? "it has no initial state"
                                      : fmt::format("it has no execution of {} steps", steps));
  for (const auto index : core.origins) {
    const auto& origin = model.origins[index];
    error.note(origin.source, fmt::format("this {} takes part", compiler::to_string(origin.kind)));
  }
  return error;
}

}  // namespace

base::Result<std::shared_ptr<const harness::SteppedModel>> load_world_model(
    const harness::Scenario& scenario, Context& context) {
  auto& sink = context.sink();
  const auto& texts = scenario.simulator.models;
  const auto place = texts.front().source;
  compiler::CompileInput input;
  for (const auto& text : texts) input.models.emplace_back(text.text);
  input.load.named_by = {scenario.file};
  input.load.allow_outside = context.form().allow_outside;
  input.horizon = std::max<std::int64_t>(scenario.horizon, kLeastSteps);
  input.ground.stop = &context.stop();
  input.producer = fmt::format("parallax {}", kVersion);
  auto compiled = compiler::compile_model(input, context.files(), sink);
  if (!compiled) return sink.already_reported();
  for (const auto& completion : compiled->typed->completions) {
    if (completion.predicate != compiled->typed->core.happens) continue;
    return sink.error(codes::kWorldNotPlayable, completion.source,
                      "`Happens` is completed, so that nothing happens which the plan does");
  }
  const auto& model = compiled->model;
  for (const compiler::Timepoint steps : {0, model.horizon}) {
    if (!check_execution(model, steps, place, context)) return sink.already_reported();
  }
  auto stepped = harness::step_model(std::filesystem::path(texts.front().text).filename().string(),
                                     std::move(compiled->model));
  if (auto* reason = std::get_if<std::string>(&stepped)) {
    return sink.error(codes::kWorldNotPlayable, place, *reason);
  }
  return std::get<std::shared_ptr<const harness::SteppedModel>>(std::move(stepped));
}

}  // namespace parallax::tools
