#include "tools/app/observed_path.h"

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "harness/campaign/journal.h"
#include "tools/app/execution_check.h"
#include "tools/app/recorded_run.h"

namespace parallax::tools {
namespace {

using harness::Comparison;
using harness::RecordedRun;

/// The same fluents by the names of the model.
std::map<compiler::FluentId, bool> start_of(const harness::CampaignTrace& trace,
                                            const compiler::SymbolTable& symbols) {
  std::map<compiler::FluentId, bool> out;
  for (std::uint32_t i = 0; i < symbols.fluent_count(); ++i) out[compiler::FluentId(i)] = false;
  for (const auto name : trace.holds(0)) {
    if (const auto fluent = symbols.fluent(name)) out[*fluent] = true;
  }
  return out;
}

/// Reads recorded simulations of one scenario.
class PathReader {
 public:
  PathReader(const ScenarioModel& loaded, Context& context)
      : loaded_(loaded),
        context_(context),
        symbols_(loaded.compilation.model),
        fluents_(symbols_) {}

  base::Result<ObservedPath> read(const RecordedRun& run) const {
    const auto& record = run.record;
    const auto& trace = *run.line.trace;
    const auto foreign = [&](const base::SourceRange& line, const char* why) {
      return context_.sink().error(codes::kForeignJournalLine, line, why);
    };
    ObservedPath path;
    path.id = run.id;
    path.executed = record.path.has_value();
    path.start = record.initial;
    const auto count = trace.event_count();
    if (record.outcomes.size() != count || record.observations.size() != count + 1) {
      return foreign(run.source, "its observations are not those of its trace");
    }
    if (count > static_cast<std::size_t>(loaded_.compilation.model.horizon)) {
      return foreign(run.trace_source, "it has more events than the model has timepoints");
    }
    for (std::size_t t = 0; t < count; ++t) {
      const auto& name = trace.event(t);
      const auto event = symbols_.event(name);
      if (!event) return foreign(run.trace_source, "it names what the model has not");
      path.steps.push_back({*event,
                            name,
                            std::nullopt,
                            trace.plan[t].source,
                            record.outcomes[t],
                            record.outcomes[t].status == harness::SimStatus::kOk,
                            {}});
      if (!record.path) continue;
      const auto& performed = record.path->steps[t];
      auto& step = path.steps.back();
      if (performed.step < 0 ||
          performed.step >= static_cast<std::int64_t>(loaded_.compilation.model.plan.size())) {
        return foreign(run.source, "it names what the plan has not");
      }
      step.perform = compiler::PlanStepId(static_cast<std::uint32_t>(performed.step));
      step.succeeded = performed.succeeded;
      step.object = performed.object;
    }
    std::set<std::string> missing;
    for (std::size_t t = 0; t <= count; ++t) {
      path.points.push_back(harness::loop_state(*loaded_.scenario.mapping, fluents_,
                                                record.observations[t],
                                                harness::moment_at(t, count), &missing));
      path.states.push_back(path.points.back().state.holds);
    }
    if (!missing.empty()) {
      return foreign(run.source, "it does not show what the scenario compares");
    }
    const auto compare = recorded_comparison(run.header).value_or(loaded_.scenario.comparison());
    if (compare == Comparison::kFinal) keep_what_lasts(trace, path);
    // The trace begins in one state; fluents that are not compared were chosen with it.
    if (!path.executed) path.states.front() = start_of(trace, symbols_);
    return path;
  }

 private:
  /// Where only the end is compared, differences on the way that vanish again do not count.
  void keep_what_lasts(const harness::CampaignTrace& trace, ObservedPath& path) const {
    const auto last = path.states.size() - 1;
    for (std::size_t t = 1; t < last; ++t) {
      auto& state = path.states[t];
      if (path.executed) {
        state.clear();
        continue;
      }
      const auto holds = trace.holds(t);
      const std::set<std::string_view> predicted(holds.begin(), holds.end());
      std::erase_if(state, [&](const auto& entry) {
        const auto& [id, seen] = entry;
        return seen != predicted.contains(symbols_.name(id)) && !lasts(path, id, seen, t, trace);
      });
    }
  }
  bool lasts(const ObservedPath& path, compiler::FluentId id, bool seen, std::size_t from,
             const harness::CampaignTrace& trace) const {
    for (auto t = from; t < path.points.size(); ++t) {
      const auto& holds = path.points[t].state.holds;
      const auto found = holds.find(id);
      if (found == holds.end()) continue;
      const auto names = trace.holds(t);
      const bool predicted =
          std::find(names.begin(), names.end(), symbols_.name(id)) != names.end();
      if (found->second == predicted || found->second != seen) return false;
    }
    return true;
  }

  const ScenarioModel& loaded_;
  Context& context_;
  compiler::SymbolTable symbols_;
  harness::ModelFluents fluents_;
};

}  // namespace

base::Result<std::vector<ObservedPath>> observed_paths(const ScenarioModel& loaded,
                                                       const harness::JournalText& journal,
                                                       Context& context) {
  const PathReader reader(loaded, context);
  std::unique_ptr<ExecutionCheck> check;
  // A model without a start leaves a journal without samples.
  if (loaded.scenario.execution == harness::Execution::kClosedLoop && journal.header &&
      !journal.samples.empty()) {
    auto made = ExecutionCheck::make(loaded, journal.header->seed, context);
    if (!made) return context.sink().already_reported();
    check = *std::move(made);
  }
  std::vector<ObservedPath> out;
  for (const auto& [key, record] : journal.samples) {
    if (record.phase != harness::DrawPhase::kCertify) continue;
    if (record.status != harness::SampleStatus::kOk) continue;
    if (!record.path && journal.find_line_of(record) == nullptr) {
      return context.sink().error(codes::kForeignJournalLine, journal.places.at(key),
                                  "its trace is not in the journal");
    }
    const auto why = check && record.path ? check->wrong(record) : std::string();
    if (!why.empty()) {
      return context.sink().error(codes::kForeignJournalLine, journal.places.at(key), why);
    }
    auto path = reader.read(harness::recorded_run(journal, {record.trace, record.sample}));
    if (!path) return context.sink().already_reported();
    out.push_back(*std::move(path));
  }
  return out;
}

base::Result<ObservedPath> observed_path(const ScenarioModel& loaded, const RecordedRun& run,
                                         Context& context) {
  return PathReader(loaded, context).read(run);
}

std::optional<std::vector<compiler::Literal>> PathFacts::facts(
    const ObservedPath& path, std::size_t steps, std::size_t outcomes,
    std::span<const ObservedPath::State> states) const {
  std::vector<runtime::ExecutedPerform> performs;
  for (std::size_t t = 0; t < steps; ++t) {
    const auto& step = path.steps[t];
    performs.push_back({step.perform, step.name, step.succeeded, step.object});
  }
  return admission_.facts(performs, outcomes, states);
}

std::optional<std::vector<compiler::Literal>> PathFacts::up_to(const ObservedPath& path,
                                                               std::size_t t) const {
  return facts(path, t, t, std::span(path.states).first(t + 1));
}

PathParting parting_of(const ObservedPath& path, const PathFacts& facts,
                       runtime::SolverSession& session) {
  const auto goes = [&](std::size_t t) {
    for (std::size_t i = 0; i <= t; ++i) {
      if (path.in_no_state(i)) return base::Known::kNo;
    }
    const auto literals = facts.up_to(path, t);
    if (!literals) return base::Known::kNo;
    return runtime::possible(session.solve(static_cast<compiler::Timepoint>(t), *literals));
  };
  PathParting out;
  const auto whole = goes(path.steps.size());
  out.undecided = whole == base::Known::kUndecided;
  for (std::size_t t = 0; whole == base::Known::kNo && t <= path.steps.size(); ++t) {
    const auto here = t == path.steps.size() ? whole : goes(t);
    if (here == base::Known::kYes) continue;
    out.undecided = here == base::Known::kUndecided;
    if (!out.undecided) out.after = t;
    break;
  }
  return out;
}

}  // namespace parallax::tools
