#include "tools/app/rates_identity.h"

namespace parallax::tools {

void add_identity(const ScenarioModel& loaded, const harness::ScenarioSettings& settings,
                  harness::RatesResult& result) {
  result.scenario_hash = loaded.sources_hash;
  result.starts_hash = hash_of_settings(settings, harness::Effect::kStarts);
  // Options of the command may replace these two, which the result says itself.
  result.judging_hash =
      hash_of_settings(settings, harness::Effect::kJudgement, {"compare", "match"});
}

}  // namespace parallax::tools
