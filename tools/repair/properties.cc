#include "tools/repair/properties.h"

#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/session/solver_session.h"
#include "tools/app/edited_scenario.h"

namespace parallax::tools {
namespace {

/// Does it hold? None: the solver was stopped.
std::optional<bool> holds(const compiler::CompiledModel& model, Context& context) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&context.stop()));
  runtime::PlanEnumerator violations(session, {.order = runtime::TraceOrder::kAny});
  if (violations.next()) return false;
  if (context.stopped()) return std::nullopt;
  return true;
}

}  // namespace

base::Status hold_against_properties(const RepairInput& input, std::vector<Proposal>& proposals,
                                     Context& context) {
  const auto& scenario = input.loaded.scenario;
  for (const auto& property : input.options.properties) {
    EditedTexts texts;
    texts.model = input.text;
    texts.property = property;
    const auto original = compile_edited(scenario, texts, context);
    if (!original) return context.sink().already_reported();
    const auto before = holds(original->model, context);
    for (auto& proposal : proposals) {
      texts.model = proposal.text.value_or(input.text);
      texts.plan.clear();
      if (proposal.changes == Proposal::Changes::kPlan) {
        if (proposal.under > 0) texts.model = proposals[proposal.under - 1].text;
        for (const auto& file : proposal.files) texts.plan.emplace(file.name, file.after);
      }
      const auto sink = context.sink();
      const auto edited = compile_edited(scenario, texts, context);
      context.sink() = sink;
      const auto after = edited ? holds(edited->model, context) : std::nullopt;
      proposal.properties.push_back({property, before, after});
    }
  }
  return base::Unit{};
}

}  // namespace parallax::tools
