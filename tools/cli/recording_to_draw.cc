#include "tools/cli/recording_to_draw.h"

#include <utility>

#include "harness/draw/recorded_actions.h"
#include "harness/recording/recording_file.h"

namespace parallax::tools {
namespace {

/// Seed, outcomes and observations; margins are in the recording alone where the run is an old one.
bool agrees(const harness::Recording& recording, const harness::SampleRecord& record) {
  if (recording.seed != record.seed || recording.status != to_string(record.status) ||
      recording.events.size() != record.outcomes.size()) {
    return false;
  }
  double time_s = 0.0;
  for (std::size_t i = 0; i < record.outcomes.size(); ++i) {
    const auto& event = recording.events[i];
    const auto& outcome = record.outcomes[i];
    const double begin_s = std::exchange(time_s, time_s + outcome.sim_time_s);
    if (event.status != to_string(outcome.status) || event.reason != outcome.reason ||
        event.begin_s != begin_s || event.end_s != time_s) {
      return false;
    }
  }
  return recording.observations == record.observations;
}

}  // namespace

std::optional<harness::Recording> recording_to_draw(const std::string& folder,
                                                    const harness::RecordedRun& run,
                                                    const harness::WorldSpec* spec,
                                                    std::string& why) {
  auto recording = harness::find_recording(folder, run.id.trace, run.id.sample, why);
  if (!recording) return std::nullopt;
  why.clear();
  if (!recording->missing.empty()) {
    why = "motion is missing: " + recording->missing;
  } else if (!agrees(*recording, run.record)) {
    why = "it says other things than the journal";
  } else if (spec != nullptr) {
    why = harness::unlike_world(*recording, *spec);
  }
  if (!why.empty()) return std::nullopt;
  return recording;
}

}  // namespace parallax::tools
