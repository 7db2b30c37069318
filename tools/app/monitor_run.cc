#include <fmt/format.h>

#include <memory>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/journal.h"
#include "tools/app/execution_check.h"
#include "tools/app/monitor.h"

namespace parallax::tools {
namespace {

using harness::SampleRecord;
using runtime::Admission;

harness::ReportedValues reported(const harness::ObservationReader& reader,
                                 const harness::State& state) {
  harness::ReportedValues out;
  for (const auto& name : reader.variables()) {
    const auto found = state.find(name);
    out.push_back(found == state.end() ? std::nullopt : std::optional(found->second));
  }
  return out;
}

std::string name_of(const SampleRecord& record) {
  return fmt::format("{}.{}", record.trace, record.sample);
}

MonitorResult not_checked(const SampleRecord& record) {
  MonitorResult out;
  out.log = name_of(record);
  out.verdict = MonitorVerdict::kUndecided;
  out.undecided_because = "it was stopped";
  out.interrupted = true;
  return out;
}

/// A variable whose type does not fit the mapping; empty: there is none.
std::string misfit(const harness::ObservationReader& reader, const SampleRecord& record) {
  for (std::size_t t = 0; t < record.observations.size(); ++t) {
    for (std::size_t v = 0; v < reader.variables().size(); ++v) {
      const auto found = record.observations[t].find(reader.variables()[v]);
      if (found == record.observations[t].end() || reader.fits(v, found->second)) continue;
      return fmt::format("`{}` at timepoint {} is no such value as the mapping asks for",
                         found->first, t);
    }
  }
  return {};
}

struct RecordedStep {
  std::string event;
  std::optional<bool> succeeded;  // as an executed plan was told
};

/// Those of the executed plan, or of the trace.
std::vector<RecordedStep> steps_of(const SampleRecord& record,
                                   const harness::JournalText& journal) {
  std::vector<RecordedStep> out;
  if (record.path) {
    for (const auto& step : record.path->steps) out.push_back({step.event, step.succeeded});
    return out;
  }
  const auto* line = journal.find_line_of(record);
  if (line == nullptr) return out;
  const auto& trace = *line->trace;
  for (std::size_t t = 0; t < trace.event_count(); ++t) out.push_back({trace.event(t), {}});
  return out;
}

class RunWatcher {
 public:
  RunWatcher(Watch& watch, const std::vector<RecordedStep>& steps, const SampleRecord& record)
      : watch_(watch), steps_(steps), record_(record) {}

  MonitorResult run() && {
    result_.log = name_of(record_);
    watch_.restart();
    const auto compared_before = watch_.compared();
    const auto last = record_.observations.size() - 1;
    double t_s = 0.0;
    for (std::size_t t = 0; t <= last; ++t) {
      const MonitorPlace place{0, static_cast<std::int64_t>(t), t_s, false};
      if (t > 0 && !note(step(t - 1), place)) break;
      if (t > 0) t_s += record_.outcomes[t - 1].sim_time_s;
      ++result_.observations;
      const auto values = reported(watch_.reader(), record_.observations[t]);
      if (!note(watch_.observe(values, t == 0 || t == last), {0, place.timepoint, t_s, false})) {
        break;
      }
    }
    result_.compared = watch_.compared() - compared_before;
    return std::move(result_);
  }

 private:
  Admission step(std::size_t t) {
    ++result_.events;
    runtime::ToldStep told;
    const auto event = watch_.symbols().event(steps_[t].event);
    PARALLAX_REQUIRE(event.has_value(), "the events are those of the scenario's model");
    told.events.push_back(*event);
    told.succeeded = steps_[t].succeeded;
    return watch_.step(told);
  }

  bool note(Admission admission, const MonitorPlace& place) {
    return take_admission(watch_, admission, place, result_);
  }

  Watch& watch_;
  const std::vector<RecordedStep>& steps_;
  const SampleRecord& record_;
  MonitorResult result_;
};

}  // namespace

base::Result<std::vector<MonitorResult>> monitor_run(const RunFolderOptions& run,
                                                     const WatchOptions& options,
                                                     Context& context) {
  auto& sink = context.sink();
  const auto journal = harness::read_journal(run.folder, context.files(), sink);
  if (!journal) return sink.already_reported();
  if (!journal->header) {
    return sink.error_about(codes::kNoJournal, run.folder);
  }
  if (!expect_traces(run, *journal->header, sink)) return sink.already_reported();
  const auto loaded = load_recorded_scenario(run, *journal->header, ScenarioUse::kRun, context);
  if (!loaded) return sink.already_reported();
  auto as_recorded = options;
  as_recorded.comparison = recorded_comparison(*journal->header);
  auto watch = Watch::make(*loaded, as_recorded, context);
  if (!watch) return sink.already_reported();
  std::unique_ptr<ExecutionCheck> check;
  const bool executed = loaded->scenario.execution == harness::Execution::kClosedLoop;
  if (executed) {
    auto made = ExecutionCheck::make(*loaded, journal->header->seed, context);
    if (!made) return sink.already_reported();
    check = *std::move(made);
  }
  std::vector<MonitorResult> out;
  for (const auto& [key, record] : journal->samples) {
    if (record.phase == harness::DrawPhase::kConfirm) continue;
    if (record.status != harness::SampleStatus::kOk) continue;
    if (context.stopped()) {
      out.push_back(not_checked(record));
      continue;
    }
    const auto steps = steps_of(record, *journal);
    if ((!record.path && !journal->traces.contains(record.trace)) ||
        record.observations.size() != steps.size() + 1 || record.outcomes.size() != steps.size()) {
      return sink.error(codes::kForeignJournalLine, journal->places.at(key),
                        "its observations are not those of its trace");
    }
    for (const auto& step : steps) {
      if ((*watch)->symbols().event(step.event)) continue;
      const auto& place =
          record.path ? journal->places.at(key) : journal->trace_places.at(record.trace);
      return sink.error(codes::kForeignJournalLine, place, "it names what the model has not");
    }
    auto why = misfit((*watch)->reader(), record);
    if (why.empty() && record.path.has_value() != executed) {
      why = "it is of another way of execution than the run";
    }
    if (why.empty() && check) why = check->wrong(record);
    if (!why.empty()) {
      return sink.error(codes::kForeignJournalLine, journal->places.at(key), why);
    }
    out.push_back(RunWatcher(**watch, steps, record).run());
  }
  return out;
}

}  // namespace parallax::tools
