#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/result.h"
#include "compiler/base/word_table.h"
#include "harness/monitor/outliers.h"
#include "tools/app/context.h"
#include "tools/app/recorded_run.h"
#include "tools/app/watch.h"

namespace parallax::tools {

enum class MonitorVerdict : std::uint8_t { kConsistent, kInconsistent, kUndecided };
inline constexpr auto kMonitorVerdictWords =
    base::word_table<MonitorVerdict>("consistent", "inconsistent", "undecided");
constexpr std::string_view to_string(MonitorVerdict verdict) {
  return kMonitorVerdictWords.of(verdict);
}

/// The first place of a log that the model does not admit, or from which on nothing is claimed.
struct MonitorPlace {
  std::int64_t line = 0;       // of the log, from 1; of a recorded simulation 0
  std::int64_t timepoint = 0;  // steps of the log before it
  double t = 0.0;              // [s] as the log says
  bool at_the_end = false;     // of fluents that are compared at rest only
};

/// An action that the log begins and never ends.
struct UnendedAction {
  std::string event;
  MonitorPlace place;
};

/// Errors of a log that a user allows.
struct LogTolerance {
  harness::ReadingTolerance reading;
  harness::OutlierRate outliers;
  bool is_exact() const { return reading.is_exact() && outliers.is_none(); }
};

/// An observation that was taken for an outlier.
struct Outlier {
  MonitorPlace place;
  Refusal refusal;
};

struct MonitorResult {
  MonitorVerdict verdict = MonitorVerdict::kConsistent;
  std::string log;                    // as the user named it; of a recorded simulation "1.4"
  std::optional<MonitorPlace> first;  // where it is not consistent any more, or undecided
  Refusal refusal;                    // inconsistent
  std::string undecided_because;      // undecided
  bool failed = false;                // a line could not be read; what came before it was
  bool interrupted = false;
  std::int64_t lines = 0, observations = 0, compared = 0, under_way = 0, events = 0;
  std::optional<std::size_t> states;  // possible at the end
  std::size_t most_states = 0;
  std::vector<std::string> unreported;    // variables that the mapping asks for in vain
  std::vector<std::string> hints;         // about those
  std::vector<UnendedAction> unended;     // in the order in which they were begun
  std::optional<LogTolerance> tolerance;  // none: everything as it was reported
  ToleratedReadings tolerated;
  std::int64_t outlier_count = 0;
  std::vector<Outlier> outliers;  // the first ones
  double wall_s = 0.0;
};

/// Adds the watch's verdict on the log at `place` to the result; false: the log ends there.
bool take_admission(Watch& watch, runtime::Admission admission, const MonitorPlace& place,
                    MonitorResult& result);

using MonitorProgress = std::function<void(const MonitorResult& so_far)>;

/// Reads a log from an open file, line by line as it comes, up to the first line that the model
/// does not admit. `tolerance.reading` is what the watch was made with. Reports kBadLogLine at the
/// line that cannot be read; what was found up to there is the result.
MonitorResult monitor_log(Watch& watch, int fd, const std::string& name, Context& context,
                          const LogTolerance& tolerance, const MonitorProgress& progress = {});

/// Every simulation of a run folder that came to its end, in order. Reports what reading the
/// journal reports, and kReplayImpossible where the scenario is not the one of the run.
base::Result<std::vector<MonitorResult>> monitor_run(const RunFolderOptions& run,
                                                     const WatchOptions& options, Context& context);

std::string monitor_text(const MonitorResult& result);
std::string monitor_text(const std::vector<MonitorResult>& runs);
/// `scenario`: as the user named it.
std::string monitor_json(const MonitorResult& result, const std::string& scenario);
std::string monitor_json(const std::vector<MonitorResult>& runs, const std::string& scenario);
MonitorVerdict verdict_of(const std::vector<MonitorResult>& runs);

}  // namespace parallax::tools
