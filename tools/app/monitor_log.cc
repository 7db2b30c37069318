#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <unordered_map>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/suggest.h"
#include "compiler/base/utf8.h"
#include "compiler/base/words.h"
#include "harness/monitor/line_source.h"
#include "harness/monitor/log_entry.h"
#include "tools/app/monitor.h"

namespace parallax::tools {
namespace {

void take_size(Watch& watch, MonitorResult& result) {
  result.states = watch.belief().size();
  result.most_states = watch.belief().largest();
}

using compiler::EventId;
using harness::LineSource;
using harness::LogEntry;
using harness::LogError;
using runtime::Admission;

using Clock = std::chrono::steady_clock;

/// Lines between two looks at the clock.
constexpr std::int64_t kLinesPerLook = 256;
constexpr std::chrono::milliseconds kProgressEvery(500);
/// Number of variables that are named in the result.
constexpr std::size_t kMostNamed = 20;
/// Number of outliers that are kept.
constexpr std::int64_t kMostOutliers = 20;

/// The byte order mark, with which some editors begin a text.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

/// ASCII without NUL, as nearly all lines are.
bool is_plain(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](char c) { return c > 0; });
}

class LogWatcher {
 public:
  LogWatcher(Watch& watch, int fd, const std::string& name, Context& context,
             const LogTolerance& tolerance, const MonitorProgress& progress)
      : watch_(watch),
        source_(fd, context.stop()),
        context_(context),
        progress_(progress),
        tolerance_(tolerance),
        outliers_(tolerance.outliers),
        reported_(watch.reader().variables().size(), false) {
    result_.log = name;
    for (std::uint32_t e = 0; e < watch.symbols().event_count(); ++e) {
      events_.emplace(watch.symbols().name(EventId(e)), EventId(e));
    }
  }

  MonitorResult run() && {
    const auto begun = Clock::now();
    auto last_progress = begun;
    watch_.restart();
    const auto compared_before = watch_.compared();
    std::string_view line;
    while (!is_over_) {
      const auto status = source_.next(line);
      if (status == LineSource::Status::kEnd) break;
      if (!take(status, line)) break;
      if (!progress_ || source_.number() % kLinesPerLook != 0) continue;
      if (const auto now = Clock::now(); now - last_progress > kProgressEvery) {
        last_progress = now;
        result_.wall_s = std::chrono::duration<double>(now - begun).count();
        progress_(result_);
      }
    }
    if (!is_over_ && !result_.failed && !result_.interrupted) end();
    result_.lines = source_.number();
    result_.compared = watch_.compared() - compared_before;
    if (!tolerance_.is_exact()) {
      result_.tolerance = tolerance_;
      result_.tolerated = watch_.tolerated();
    }
    finish();
    result_.wall_s = std::chrono::duration<double>(Clock::now() - begun).count();
    return std::move(result_);
  }

 private:
  /// False: nothing more is read.
  bool take(LineSource::Status status, std::string_view line) {
    using Status = LineSource::Status;
    switch (status) {
      case Status::kLine:
      case Status::kCut:
        break;
      case Status::kTooLong:
        return refuse({1, fmt::format("the line is longer than {} bytes", LineSource::kMaxLine)});
      case Status::kFailed:
        return refuse({1, std::strerror(source_.error())});
      case Status::kStopped:
        result_.interrupted = true;
        return false;
      case Status::kEnd:
        return false;
    }
    if (context_.stopped()) {
      result_.interrupted = true;
      return false;
    }
    if (source_.number() == 1 && line.starts_with(kByteOrderMark)) {
      line.remove_prefix(kByteOrderMark.size());
      skipped_ = kByteOrderMark.size();
    } else {
      skipped_ = 0;
    }
    if (!is_plain(line)) {
      const auto invalid = std::min(base::first_invalid_utf8(line), line.find('\0'));
      if (invalid != line.size()) return refuse({invalid + 1, "this byte is not of UTF-8 text"});
    }
    if (line.find_first_not_of(" \t") == std::string_view::npos) return true;
    if (auto error = parse(line)) {
      if (status == Status::kCut) error->text = "the log ends in the middle of this line";
      return refuse(*error);
    }
    return is_header_ || follow();
  }

  std::optional<LogError> parse(std::string_view line) {
    is_header_ = false;
    if (!form_) {
      form_ = line[line.find_first_not_of(" \t")] == '{' ? Form::kJson : Form::kCsv;
      if (form_ == Form::kCsv) {
        is_header_ = true;
        return csv_.read_header(line, watch_.reader(), foreign_);
      }
    }
    if (form_ == Form::kJson) return read_json_line(line, watch_.reader(), entry_, foreign_);
    return csv_.read_line(line, watch_.reader(), entry_);
  }

  bool refuse(const LogError& error) {
    auto report = context_.sink().error_about(
        codes::kBadLogLine,
        fmt::format("{}:{}:{}", result_.log, source_.number(), error.column + skipped_),
        error.text);
    for (const auto& note : notes_) report.note(note);
    result_.failed = true;
    return false;
  }

  MonitorPlace here() const { return {source_.number(), result_.events, entry_.t, false}; }

  /// The event of the model; none: reported.
  std::optional<EventId> event(const std::string& name) {
    const auto found = events_.find(name);
    if (found != events_.end()) return found->second;
    if (const auto near = base::nearest_name(name, watch_.event_names())) {
      notes_.push_back(fmt::format("there is an event `{}`", *near));
    }
    refuse({1, fmt::format("the model has no event `{}`", name)});
    return std::nullopt;
  }

  /// Follows the parts of the entry in order: a step, the begin of an action, a state.
  bool follow() {
    if (any_ && entry_.t < t_) {
      return refuse({1, fmt::format("time runs backwards: {:.9g} s after {:.9g} s", entry_.t, t_)});
    }
    t_ = entry_.t;
    any_ = true;
    if (entry_.events && !step()) return false;
    if (entry_.started) {
      const auto id = event(*entry_.started);
      if (!id) return false;
      under_way_.try_emplace(id->index(), Begun{here(), result_.under_way});
    }
    return !entry_.has_state || see();
  }

  bool step() {
    runtime::ToldStep told;
    for (const auto& name : *entry_.events) {
      const auto id = event(name);
      if (!id) return false;
      told.events.push_back(*id);
      under_way_.erase(id->index());
    }
    std::sort(told.events.begin(), told.events.end());
    told.events.erase(std::unique(told.events.begin(), told.events.end()), told.events.end());
    told.succeeded = entry_.ok;
    if (!end_stretch()) return false;
    ++result_.events;
    unsettled_.reset();
    return note(watch_.step(told), here());
  }

  bool see() {
    ++result_.observations;
    for (std::size_t v = 0; v < reported_.size(); ++v) {
      if (entry_.values[v]) reported_[v] = true;
    }
    if (!under_way_.empty()) {
      ++result_.under_way;
      return true;
    }
    const bool at_start = result_.events == 0;
    const auto admission = watch_.observe(entry_.values, at_start);
    const bool is_outlier = admission == Admission::kRefused && !tolerance_.outliers.is_none();
    if (is_outlier) return take_outlier();
    if (watch_.last_was_compared()) outliers_.agreed();
    if (watch_.compares_at_rest() && !at_start) unsettled_ = {here(), entry_.values};
    return note(admission, here());
  }

  /// Passes over an observation that no possible state agrees with. False: there are too many.
  bool take_outlier() {
    ++result_.outlier_count;
    const bool is_allowed = outliers_.disagreed();
    if (outliers_.is_first_of_stretch()) stretch_begin_ = {here(), watch_.refusal()};
    if (static_cast<std::int64_t>(result_.outliers.size()) < kMostOutliers) {
      result_.outliers.push_back({here(), watch_.refusal()});
    }
    return is_allowed || refuse_stretch();
  }

  bool end_stretch() {
    if (!outliers_.end_stretch()) return refuse_stretch();
    count_before_stretch_ = result_.outlier_count;
    return true;
  }

  /// Makes the log inconsistent where observations since the last step began to disagree: they are
  /// no outliers.
  bool refuse_stretch() {
    is_over_ = true;
    take_size(watch_, result_);
    result_.verdict = MonitorVerdict::kInconsistent;
    result_.first = stretch_begin_.place;
    result_.refusal = stretch_begin_.refusal;
    const auto is_of_stretch = [&](const Outlier& outlier) {
      return outlier.place.line >= stretch_begin_.place.line;
    };
    std::erase_if(result_.outliers, is_of_stretch);
    result_.outlier_count = count_before_stretch_;
    return false;
  }

  /// Compares the fluents that are compared at rest only with the last observation.
  void end() {
    if (!end_stretch()) return;
    if (!under_way_.empty()) return note_unended();
    if (!unsettled_) return;
    auto place = unsettled_->first;
    place.at_the_end = true;
    (void)note(watch_.observe(unsettled_->second, true), place);
  }

  /// The log ends, and actions do not: what was seen since was not compared.
  void note_unended() {
    auto unseen = result_.under_way;
    for (const auto& [event, begun] : under_way_) {
      result_.unended.push_back({watch_.symbols().name(EventId(event)), begun.place});
      unseen = std::min(unseen, begun.uncompared);
    }
    std::sort(result_.unended.begin(), result_.unended.end(),
              [](const auto& a, const auto& b) { return a.place.line < b.place.line; });
    const auto count = result_.under_way - unseen;
    if (count == 0) return;
    const auto& first = result_.unended.front();
    result_.verdict = MonitorVerdict::kUndecided;
    result_.first = first.place;
    result_.undecided_because =
        fmt::format("`{}` is begun and no `event` ends it: {} not compared", first.event,
                    base::counted(count, "later observation was", "later observations were"));
  }

  bool note(Admission admission, const MonitorPlace& place) {
    is_over_ = admission != Admission::kAdmitted;
    if (!is_over_ || !context_.stopped()) {
      return take_admission(watch_, admission, place, result_);
    }
    take_size(watch_, result_);
    result_.interrupted = true;
    return false;
  }

  void finish() {
    if (result_.observations > 0) {
      for (std::size_t v = 0; v < reported_.size() && result_.unreported.size() < kMostNamed; ++v) {
        if (reported_[v]) continue;
        const auto& name = watch_.reader().variables()[v];
        result_.unreported.push_back(name);
        const std::vector<std::string> foreign(foreign_.begin(), foreign_.end());
        if (const auto near = base::nearest_name(name, foreign)) {
          result_.hints.push_back(fmt::format("the log has `{}`; is `{}` meant?", *near, name));
        }
      }
    }
    if (result_.verdict != MonitorVerdict::kConsistent) return;
    if (result_.failed) {
      result_.verdict = MonitorVerdict::kUndecided;
      result_.undecided_because =
          fmt::format("line {} cannot be read; what comes before it is consistent{}",
                      source_.number(), result_.outlier_count > 0 ? " but for outliers" : "");
    } else if (result_.interrupted) {
      result_.verdict = MonitorVerdict::kUndecided;
      result_.undecided_because = "it was stopped";
    } else if (result_.events == 0 && result_.compared == 0) {
      result_.verdict = MonitorVerdict::kUndecided;
      result_.undecided_because =
          "the log says nothing of the model: no event, and no variable "
          "that a compared fluent is read from";
    } else if (result_.observations > result_.under_way && result_.compared == 0) {
      result_.verdict = MonitorVerdict::kUndecided;
      result_.undecided_because =
          "none of its observations has a variable that the mapping asks for, so that nothing was "
          "compared";
    }
  }

  enum class Form : std::uint8_t { kJson, kCsv };

  Watch& watch_;
  LineSource source_;
  Context& context_;
  const MonitorProgress& progress_;
  LogTolerance tolerance_;
  harness::OutlierCount outliers_;
  Outlier stretch_begin_;                  // the first outlier since the last step
  std::int64_t count_before_stretch_ = 0;  // outliers before that step
  MonitorResult result_;
  std::unordered_map<std::string, EventId> events_;  // for look-up only
  std::optional<Form> form_;
  harness::CsvLog csv_;
  bool is_header_ = false;
  std::size_t skipped_ = 0;  // bytes of the line that are no part of its text
  LogEntry entry_;
  harness::ForeignNames foreign_;
  std::vector<bool> reported_;  // by variable
  struct Begun {
    MonitorPlace place;
    std::int64_t uncompared = 0;  // observations by then
  };
  std::map<std::uint32_t, Begun> under_way_;  // by event
  std::vector<std::string> notes_;
  std::optional<std::pair<MonitorPlace, harness::ReportedValues>> unsettled_;
  double t_ = 0.0;
  bool any_ = false, is_over_ = false;
};

}  // namespace

bool take_admission(Watch& watch, Admission admission, const MonitorPlace& place,
                    MonitorResult& result) {
  take_size(watch, result);
  if (admission == Admission::kAdmitted) return true;
  result.first = place;
  if (admission == Admission::kRefused) {
    result.verdict = MonitorVerdict::kInconsistent;
    result.refusal = watch.refusal();
  } else {
    result.verdict = MonitorVerdict::kUndecided;
    result.undecided_because = watch.undecided_because();
  }
  return false;
}

MonitorResult monitor_log(Watch& watch, int fd, const std::string& name, Context& context,
                          const LogTolerance& tolerance, const MonitorProgress& progress) {
  return LogWatcher(watch, fd, name, context, tolerance, progress).run();
}

}  // namespace parallax::tools
