#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "compiler/base/file_io.h"
#include "harness/recording/recording_file.h"
#include "harness/report/text_layout.h"
#include "tools/page/gather.h"

namespace parallax::tools {
namespace {

constexpr std::size_t kMostRuns = 20;
constexpr std::size_t kMostFrameBytes = std::size_t{1800} << 10U;

/// The simulations to show in motion, the most important first: the first discrepancy of each
/// cause, each with a clean one of its trace; without discrepancies the first of each trace.
std::vector<const PageSample*> chosen_runs(
    const PageData& page, const std::set<std::pair<std::int64_t, std::int64_t>>& on_record) {
  const auto has = [&](const PageSample& sample) {
    return sample.origin != SampleOrigin::kFurther &&
           on_record.contains({sample.trace, sample.sample});
  };
  std::vector<const PageSample*> out;
  std::set<std::pair<std::int64_t, std::string>> causes;
  std::set<std::int64_t> with_clean;
  const auto add_clean_of = [&](std::int64_t trace) {
    if (with_clean.contains(trace)) return;
    for (const auto& sample : page.samples) {
      if (sample.trace != trace || sample.verdict != PageVerdict::kClean || !has(sample)) continue;
      out.push_back(&sample);
      with_clean.insert(trace);
      return;
    }
  };
  for (const auto& sample : page.samples) {
    if (sample.verdict != PageVerdict::kDiscrepancy || !has(sample)) continue;
    if (!causes.insert({sample.trace, sample.cause}).second) continue;
    out.push_back(&sample);
    add_clean_of(sample.trace);
  }
  for (const auto& sample : page.samples) {
    if (has(sample)) add_clean_of(sample.trace);
  }
  if (out.empty()) {
    for (const auto& sample : page.samples) {
      if (has(sample) && out.size() < kMostRuns) out.push_back(&sample);
    }
  }
  if (out.size() > kMostRuns) out.resize(kMostRuns);
  return out;
}

/// Those that the folder has a recording of.
std::set<std::pair<std::int64_t, std::int64_t>> recorded_runs(const std::string& folder) {
  std::set<std::pair<std::int64_t, std::int64_t>> out;
  std::error_code error;
  const auto place = std::filesystem::path(folder) / harness::kRecordingsFolder;
  for (auto at = std::filesystem::directory_iterator(place, error);
       !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    if (const auto id = harness::recording_id(at->path().filename().string())) out.insert(*id);
  }
  return out;
}

}  // namespace

void add_motion(PageData& page) {
  if (page.bodies.empty()) return;  // nothing that could move
  const auto on_record = recorded_runs(page.folder);
  std::size_t bytes = 0;
  for (const auto* sample : chosen_runs(page, on_record)) {
    std::string why;
    auto recording = harness::find_recording(page.folder, sample->trace, sample->sample, why);
    const auto name = sample_name(sample->trace, sample->sample);
    if (recording && recording->seed != sample->seed) {
      why = fmt::format("it is that of another run, of seed {}", recording->seed);
      recording.reset();
    }
    if (!recording) {
      page.banners.push_back(
          fmt::format("The recording of simulation {0} cannot be shown: {1}. `parallax replay {2} "
                      "--sample {0} --record` makes it again.",
                      name, why, harness::shell_word(page.folder)));
      continue;
    }
    if (!page.motion.empty() && bytes + recording->frames.size() > kMostFrameBytes) {
      ++page.motion_left_out;
      continue;
    }
    bytes += recording->frames.size();
    page.motion.push_back({sample->trace,
                           sample->sample,
                           sample->verdict,
                           sample->cause,
                           {},
                           std::make_shared<const harness::Recording>(std::move(*recording))});
  }
  for (auto& run : page.motion) {
    for (const auto& timeline : page.timelines) {
      if (timeline.trace == run.trace && timeline.sample == run.sample)
        run.parting = timeline.parting;
    }
  }
  // Suggests the simulation that one would want to see first.
  for (const auto& sample : page.samples) {
    if (sample.verdict != PageVerdict::kDiscrepancy || sample.origin == SampleOrigin::kFurther)
      continue;
    if (!on_record.contains({sample.trace, sample.sample})) {
      page.not_recorded = std::pair(sample.trace, sample.sample);
    }
    return;
  }
  if (page.motion.empty() && !page.samples.empty()) {
    page.not_recorded = std::pair(page.samples.front().trace, page.samples.front().sample);
  }
}

}  // namespace parallax::tools
