#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/word_table.h"
#include "harness/campaign/motion_tap.h"
#include "harness/campaign/sample_record.h"
#include "harness/recording/recording.h"

namespace parallax::harness {

/// The simulations whose motion is kept. kDiscrepancies: discrepancies, executions that did not
/// end, and the first three clean simulations of each trace.
enum class RecordMode : std::uint8_t { kNone, kDiscrepancies, kAll };
inline constexpr auto kRecordModes = base::word_table<RecordMode>("none", "discrepancies", "all");
constexpr std::string_view to_string(RecordMode mode) { return kRecordModes.of(mode); }

/// The recording of one simulation; none if the simulator reported no motion. `events`: names of
/// the performed events. If a frame is incomplete, those before it are kept.
std::optional<Recording> recording_of(const SimulatorInfo& simulator, const SampleRecord& record,
                                      const std::vector<std::string>& events, const MotionLog& log);

/// The folder `recordings` of a run. Every simulation is written down before it is in the journal,
/// and taken away again when it is judged and not to be kept: so what is there at the end follows
/// from the journal, whatever the number of jobs and however often the run was continued. What goes
/// wrong here is told at the end and harms nothing else.
class RunRecorder {
 public:
  RunRecorder(RecordMode mode, std::filesystem::path run_dir)
      : mode_(mode), run_dir_(std::move(run_dir)) {}

  /// The function that the worker pool calls with motion; empty if nothing is recorded.
  std::function<void(const SampleRecord&, const MotionLog&)> taker();
  /// Call it before anything is simulated.
  void set_simulator(const SimulatorInfo& simulator) { simulator_ = simulator; }
  /// Call it before the first sample of a trace. Executed plans tell their events themselves.
  void announce(std::int64_t trace, std::vector<std::string> events);

  enum class Verdict : std::uint8_t { kClean, kFinding, kNothing };
  /// Call it in the order of the samples.
  void judge(const SampleRecord& record, Verdict verdict);
  /// Ends the run. Deletes all recordings but the kept ones of these records, which the journal
  /// has.
  void finish(const std::vector<SampleRecord>& consumed);
  /// Reports kRecordingLost.
  void report(base::DiagnosticSink& sink) const;

 private:
  using Id = std::pair<std::int64_t, std::int64_t>;

  void take(const SampleRecord& record, const MotionLog& log);  // in a worker's thread
  void note_loss(const std::string& why);
  void remove(const Id& id) const;
  bool has_folder() const;

  RecordMode mode_;
  std::filesystem::path run_dir_;
  SimulatorInfo simulator_;
  std::map<std::int64_t, std::int64_t> clean_;  // kept so far, by trace
  std::set<Id> kept_;

  mutable std::mutex mutex_;                                 // guards what follows
  std::map<std::int64_t, std::vector<std::string>> events_;  // by trace
  std::int64_t losses_ = 0;
  std::string first_loss_;
};

}  // namespace parallax::harness
