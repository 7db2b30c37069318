#include "tools/app/best_traces.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "compiler/base/codes/campaigns.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/optimize/bounded_model.h"

namespace parallax::tools {
namespace {

using runtime::BoundKind;

std::string json_values(const std::vector<std::int64_t>& values) {
  return values.size() == 1 ? fmt::format("{}", values.front())
                            : fmt::format("[{}]", fmt::join(values, ","));
}

}  // namespace

BestTraces::BestTraces(const compiler::CompiledModel& model, Context& context) {
  for (const auto& objective : model.objectives) texts_.push_back(objective.text);
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  optimum_ = runtime::find_optimum(session);
}

std::optional<compiler::CompiledModel> BestTraces::model_of_best(
    const compiler::CompiledModel& model) const {
  if (!optimum_.witness || !optimum_.proved()) return std::nullopt;
  return runtime::with_bound(model, optimum_.values, BoundKind::kNoWorse);
}

void BestTraces::certify(const CertifyOption& option, const std::vector<std::string>& models,
                         const compiler::CompiledModel& model,
                         const std::optional<compiler::PlanGraph>& plan, Context& context) {
  const auto better = runtime::with_bound(model, optimum_.values, BoundKind::kBetter);
  TraceCertifier certifier(option, models, better ? *better : model, context);
  if (!better) return certifier.decline("the objective has too many different sums");
  certifier.note_gaps(plan, false);
  if (may_be_cut(model)) certifier.note_cut();
  certifier.conclude(std::string(runtime::to_string(
                         model.has_constraints ? runtime::Exploration::kCompleteUpToBound
                                               : runtime::Exploration::kAllTracesExplored)),
                     false);
  adopt(certifier);
  proof_fields_ = certifier.fields();
}

std::string BestTraces::value_text(std::size_t objective) const {
  if (objective < optimum_.decided) {
    return fmt::format("optimum {} ({})", optimum_.values[objective], verdict_);
  }
  const bool first_open = objective == optimum_.decided && optimum_.at_least.has_value();
  if (optimum_.values.empty()) {
    return first_open ? fmt::format("optimum not found, at least {}", *optimum_.at_least)
                      : "optimum not found";
  }
  const auto best = optimum_.values[objective];
  return first_open ? fmt::format("optimum between {} and {}", *optimum_.at_least, best)
                    : fmt::format("at most {}", best);
}

std::string BestTraces::text() const {
  std::string out;
  if (optimum_.none) return out;
  for (std::size_t i = 0; i < texts_.size(); ++i) {
    out += fmt::format("{}: {}\n", value_text(i), texts_[i]);
  }
  return out;
}

std::string BestTraces::fields() const {
  std::string out;
  const bool known = optimum_.witness && optimum_.proved();
  out += fmt::format("\"optimum\":{},\"proved\":{},", known ? json_values(optimum_.values) : "null",
                     optimum_.proved());
  if (!optimum_.proved()) {
    out += fmt::format("\"best\":{},",
                       optimum_.values.empty() ? "null" : json_values(optimum_.values));
    if (optimum_.at_least) {
      out += fmt::format("\"decided\":{},\"at_least\":{},", optimum_.decided, *optimum_.at_least);
    }
  }
  return out;
}

}  // namespace parallax::tools
