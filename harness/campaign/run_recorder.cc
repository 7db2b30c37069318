#include "harness/campaign/run_recorder.h"

#include <fmt/format.h>

#include <system_error>

#include "compiler/base/codes/campaigns.h"
#include "harness/recording/recording_file.h"

namespace parallax::harness {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kCleanKept = 3;

/// Recognizes a file that a killed writer left: the name of a recording, a number and ".tmp".
bool is_left_over(std::string_view name) {
  const auto end = name.find(".rec.");
  return end != std::string_view::npos && name.ends_with(".tmp") &&
         recording_id(name.substr(0, end + 4)).has_value();
}

}  // namespace

std::optional<Recording> recording_of(const SimulatorInfo& simulator, const SampleRecord& record,
                                      const std::vector<std::string>& events,
                                      const MotionLog& log) {
  const auto& motion = log.motion;
  if (!simulator.scene || (motion.frames.empty() && motion.fault.empty())) return std::nullopt;
  Recording out;
  out.trace = record.trace;
  out.sample = record.sample;
  out.seed = record.seed;
  out.simulator = simulator.name + " " + simulator.version;
  out.status = to_string(record.status);
  out.missing = motion.fault;
  out.interval_s = kRecordInterval_s;
  out.scene = *simulator.scene;
  double time_s = 0.0;
  for (std::size_t i = 0; i < record.outcomes.size(); ++i) {
    const auto& outcome = record.outcomes[i];
    RecordedEvent event;
    if (i < events.size()) event.name = events[i];
    event.begin_s = time_s;
    event.end_s = time_s += outcome.sim_time_s;
    event.status = to_string(outcome.status);
    event.reason = outcome.reason;
    if (i < log.margins.size()) event.margins = log.margins[i];
    out.events.push_back(std::move(event));
  }
  out.observations = record.observations;
  MotionCursor cursor(motion.frames, {out.scene.moving().size(), out.scene.grippers.size()});
  std::size_t whole = 0;
  while (cursor.next()) whole = cursor.byte();
  out.frames = motion.frames.substr(0, whole);
  if (out.missing.empty()) out.missing = cursor.fault();
  return out;
}

std::function<void(const SampleRecord&, const MotionLog&)> RunRecorder::taker() {
  if (mode_ == RecordMode::kNone) return {};
  return [this](const SampleRecord& record, const MotionLog& log) { take(record, log); };
}

void RunRecorder::announce(std::int64_t trace, std::vector<std::string> events) {
  const std::lock_guard lock(mutex_);
  events_[trace] = std::move(events);
}

void RunRecorder::take(const SampleRecord& record, const MotionLog& log) {
  const bool is_result = record.status == SampleStatus::kOk || record.status == SampleStatus::kLost;
  if (!is_result || record.phase == DrawPhase::kConfirm) return;
  std::vector<std::string> events;
  if (record.path) {
    for (const auto& step : record.path->steps) events.push_back(step.event);
  } else {
    const std::lock_guard lock(mutex_);
    events = events_[record.trace];
  }
  const auto recording = recording_of(simulator_, record, events, log);
  if (!recording) return;
  if (!recording->missing.empty()) note_loss(recording->missing);
  if (auto why = write_recording(run_dir_, *recording); !why.empty()) note_loss(why);
}

void RunRecorder::note_loss(const std::string& why) {
  const std::lock_guard lock(mutex_);
  if (losses_++ == 0) first_loss_ = why;
}

void RunRecorder::judge(const SampleRecord& record, Verdict verdict) {
  if (mode_ == RecordMode::kNone) return;
  const Id id(record.trace, record.sample);
  const bool is_wanted = mode_ == RecordMode::kAll || verdict == Verdict::kFinding ||
                         (verdict == Verdict::kClean && clean_[record.trace]++ < kCleanKept);
  if (is_wanted) {
    kept_.insert(id);
  } else {
    remove(id);
  }
}

bool RunRecorder::has_folder() const {
  std::error_code error;
  return fs::is_directory(fs::symlink_status(run_dir_ / kRecordingsFolder, error));
}

void RunRecorder::remove(const Id& id) const {
  std::error_code error;
  if (has_folder()) fs::remove(run_dir_ / recording_name(id.first, id.second), error);
}

void RunRecorder::finish(const std::vector<SampleRecord>& consumed) {
  if (mode_ == RecordMode::kNone || !has_folder()) return;
  std::set<Id> left;
  for (const auto& record : consumed) left.emplace(record.trace, record.sample);
  const auto folder = run_dir_ / kRecordingsFolder;
  std::vector<fs::path> superfluous;
  std::error_code error;
  for (fs::directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
    const auto name = at->path().filename().string();
    const auto id = recording_id(name);
    const bool stays = id ? kept_.contains(*id) && left.contains(*id) : !is_left_over(name);
    if (!stays) superfluous.push_back(at->path());
  }
  for (const auto& path : superfluous) fs::remove(path, error);
  fs::remove(folder, error);  // which leaves alone a folder that is not empty
}

void RunRecorder::report(base::DiagnosticSink& sink) const {
  const std::lock_guard lock(mutex_);
  if (losses_ == 0) return;
  sink.error_about(codes::kRecordingLost, (run_dir_ / kRecordingsFolder).string(), losses_,
                   first_loss_);
}

}  // namespace parallax::harness
