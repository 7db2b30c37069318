#include "harness/discrete/stepped_model.h"

#include <utility>

#include "compiler/base/contract.h"

namespace parallax::harness {

std::variant<std::shared_ptr<const SteppedModel>, std::string> step_model(
    std::string name, compiler::CompiledModel model) {
  PARALLAX_REQUIRE(model.plan.empty() && !model.has_constraints && model.horizon >= 2,
                   "a model alone, with steps");
  auto layered = runtime::split_into_windows(model, runtime::Distinct::kObservable);
  if (auto* reason = std::get_if<std::string>(&layered)) return std::move(*reason);
  return std::make_shared<const SteppedModel>(SteppedModel{
      std::move(name), std::move(model), std::get<runtime::LayeredModel>(std::move(layered))});
}

}  // namespace parallax::harness
