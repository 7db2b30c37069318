#include "tools/repair/validation.h"

#include <algorithm>
#include <string>
#include <utility>

#include "compiler/base/temporary_folder.h"
#include "tools/repair/explorer.h"
#include "tools/repair/plan_runs.h"

namespace parallax::tools {
namespace {

constexpr std::int64_t kSequences = 40;  // to choose by, and as many fresh ones

}  // namespace

std::vector<OtherPlan> runs_of_other_plans(const std::vector<harness::LocatedText>& scenarios,
                                           const std::string& model,
                                           const ExperimentOptions& options, Context& context) {
  std::vector<OtherPlan> out;
  for (const auto& other : scenarios) {
    const auto before = context.sink();
    auto loaded = load_scenario_model(other.text, context, {.as_run = true});
    auto& plan = out.emplace_back(OtherPlan{other.text, {}});
    if (loaded) plan.runs = runs_of_plan(*std::move(loaded), model, options, context);
    context.sink() = before;
  }
  return out;
}

std::optional<ScenarioModel> load_to_execute(const RepairInput& input, Context& context) {
  const auto before = context.sink();
  auto loaded = load_scenario_model(input.loaded.scenario.file, context,
                                    {.as_run = true, .execution = harness::Execution::kClosedLoop});
  if (loaded) return *std::move(loaded);
  context.sink() = before;
  return std::nullopt;
}

base::Result<RandomSequences> random_sequences(const RepairInput& input,
                                               const ExperimentOptions& options, Context& context) {
  auto& sink = context.sink();
  const bool forbidden = options.runs == 0 || input.options.other_model;
  if (forbidden || input.loaded.world == nullptr || input.loaded.scenario.plan.empty()) {
    return RandomSequences();
  }
  const auto loaded = load_to_execute(input, context);
  if (!loaded) return RandomSequences();  // a plan of traces alone
  const auto simulator = options.simulator(*loaded);
  if (!simulator) return sink.already_reported();
  const base::TemporaryFolder folder("validation");
  if (folder.path().empty()) return RandomSequences();
  ExploreOptions explore_options;
  explore_options.seed = input.header.seed;
  explore_options.count = 2 * kSequences;
  explore_options.all_events = true;
  if (input.start) explore_options.starts = input.start->wanted;
  explore_options.run_dir = folder.path() / "run";
  std::vector<Evidence> known;
  for (const auto& seen : input.evidence) {
    if (!seen.ids.front().starts_with('e')) known.push_back(seen);
  }
  auto explored = explore(*loaded, known, *simulator, explore_options, context);
  if (!explored) return sink.already_reported();
  RandomSequences out;
  out.of_plan = explored->of_plan;
  for (auto& seen : explored->runs) {
    end_at_refusal(seen);
    // Each is drawn by its number alone, so that the later ones are fresh unless they are equal.
    const bool chooses = std::stoll(seen.ids.front()) <= kSequences;
    const bool known_already =
        std::any_of(out.choosing.begin(), out.choosing.end(), [&](const Evidence& other) {
          return other.steps == seen.steps && other.states == seen.states;
        });
    if (chooses) out.choosing.push_back(std::move(seen));
    if (!chooses && !known_already) out.fresh.push_back(std::move(seen));
  }
  return out;
}

}  // namespace parallax::tools
