#include "tools/app/coverage.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/json.h"
#include "harness/campaign/journal.h"
#include "harness/campaign/loop_stream.h"
#include "tools/app/coverage_loop.h"
#include "tools/app/coverage_model.h"
#include "tools/app/coverage_plan.h"
#include "tools/app/execution_check.h"
#include "tools/app/file_kind.h"
#include "tools/app/trace_feed.h"

namespace parallax::tools {
namespace {

bool same_trace(const harness::CampaignTrace& a, const harness::CampaignTrace& b) {
  if (a.key != b.key || a.points.size() != b.points.size()) return false;
  for (std::size_t t = 0; t < a.points.size(); ++t) {
    if (a.holds(t) != b.holds(t) || a.happens(t) != b.happens(t)) return false;
  }
  return true;
}

/// The traces of the model in the numbering of the run.
struct NumberedTraces {
  std::vector<harness::CampaignTrace> traces;
  bool all = false;
  std::unique_ptr<EnumeratedTraces> feed;
};

/// Is it the trace on record? From which of its initial states is asked for later, where it has
/// several.
bool is_recorded_trace(const harness::TraceLine& line, const harness::CampaignTrace& trace) {
  return line.initial_states.empty() ? same_trace(*line.trace, trace)
                                     : line.trace->key == trace.key;
}

/// Lists at least the traces of the journal. A journal does not tell whether the run split initial
/// states or took every hit, so the options are tried until the traces fit. None: the model has no
/// such traces.
std::optional<NumberedTraces> list_traces(const compiler::CompiledModel& model,
                                          const harness::JournalText& journal, std::int64_t limit,
                                          Context& context) {
  const auto last = journal.traces.empty() ? std::int64_t{0} : journal.traces.rbegin()->first;
  for (const bool split : {false, true}) {
    for (const bool all_hits : {false, true}) {
      NumberedTraces listed;
      listed.feed = std::make_unique<EnumeratedTraces>(
          model, context,
          runtime::PlanEnumeratorOptions{.all_hits = all_hits, .split_initial = split});
      auto& feed = *listed.feed;
      bool fits = true;
      while (fits) {
        const auto count = static_cast<std::int64_t>(listed.traces.size());
        if (limit > 0 && count >= std::max(limit, last)) break;
        const auto before = context.sink();
        auto trace = feed.next();
        if (!trace && count < last) return std::nullopt;
        if (!trace) {
          context.sink() = before;  // behind the last one that was simulated
          break;
        }
        if (!*trace) {
          listed.all = !context.stopped();
          break;
        }
        const auto recorded = journal.traces.find((*trace)->number);
        fits = recorded == journal.traces.end() || is_recorded_trace(recorded->second, **trace);
        listed.traces.push_back(**std::move(trace));
      }
      fits = fits && static_cast<std::int64_t>(listed.traces.size()) >= last;
      if (fits || context.stopped()) return listed;
    }
  }
  return std::nullopt;
}

/// The folder of a run, as far as it can be read without its scenario.
struct FolderRecord {
  std::string folder;
  harness::JournalText journal;
  bool executed = false;  // the plan itself, in closed loop
  LoopCoverage::RunTerms terms;
};

/// The scenario of executions; several runs may have the same.
struct ExecutedScenario {
  ScenarioModel loaded;
  std::unique_ptr<LoopCoverage> loop;
};

class Collector {
 public:
  Collector(const CoverageOptions& options, Context& context)
      : options_(options), context_(context) {}

  base::Status read(const std::string& folder) {
    auto& sink = context_.sink();
    if (!expect_kind(folder, {FileKind::kRun}, "the folder of a run", context_)) {
      return sink.already_reported();
    }
    auto journal = harness::read_journal(folder, context_.files(), sink);
    if (!journal) return sink.already_reported();
    if (!journal->header) return sink.error_about(codes::kNoJournal, folder);
    if (!expect_traces({folder, {}}, *journal->header, sink)) return sink.already_reported();
    FolderRecord run{folder, *std::move(journal), false, {}};
    const auto& header = *run.journal.header;
    run.executed = recorded_execution(header) == harness::Execution::kClosedLoop;
    run.terms.comparison = recorded_comparison(header).value_or(harness::Comparison::kEveryStep);
    run.terms.confidence = header.asked.confidence_level.value_or(0.0);
    for (const auto& [key, record] : run.journal.samples) {
      if (record.path.has_value() == run.executed) continue;
      return sink.error(codes::kForeignJournalLine, run.journal.places.at(key),
                        run.executed ? "`path` is missing" : "no plan was executed");
    }
    runs_.push_back(std::move(run));
    return base::Unit{};
  }

  base::Status add_all() {
    for (const auto& run : runs_) {
      if (!(run.executed ? add_executed(run) : add_open(run))) {
        return context_.sink().already_reported();
      }
      ++coverage_.runs;
    }
    for (const auto& [hash, scenario] : executed_) scenario.loop->write(coverage_);
    return base::Unit{};
  }

  Coverage take() { return std::move(coverage_); }

 private:
  /// The simulations that count: losses show nothing, repetitions nothing new, and one draw of one
  /// scenario is one simulation, however often it is on record.
  std::vector<harness::SampleKey> to_count(const FolderRecord& run) {
    std::vector<harness::SampleKey> out;
    std::int64_t known = 0;
    const auto& header = *run.journal.header;
    for (const auto& [key, record] : run.journal.samples) {
      if (std::get<2>(key) != harness::DrawPhase::kCertify ||
          record.status != harness::SampleStatus::kOk) {
        continue;
      }
      const auto trace = run.executed ? std::to_string(record.path->start)
                                      : run.journal.traces.at(record.trace).trace->key;
      const bool is_new =
          counted_.emplace(header.scenario_hash, run.executed, header.seed, trace, record.sample)
              .second;
      if (is_new) out.push_back(key);
      if (!is_new) ++known;
    }
    if (known > 0) {
      context_.remark(
          fmt::format("{}: {} of its simulations count once, with the same ones of a "
                      "run before it",
                      base::printable(run.folder), known));
    }
    return out;
  }

  bool note_scenario(const std::string& name) {
    auto& names = coverage_.scenarios;
    const bool is_new = std::find(names.begin(), names.end(), name) == names.end();
    if (is_new) names.push_back(name);
    return is_new;
  }

  base::Status add_executed(const FolderRecord& run) {
    auto& sink = context_.sink();
    const auto& header = *run.journal.header;
    auto& scenario = executed_[header.scenario_hash];
    if (!scenario.loop) {
      auto loaded = load_recorded_scenario({run.folder, options_.scenario}, header,
                                           ScenarioUse::kRun, context_);
      if (!loaded) return sink.already_reported();
      scenario.loaded = *std::move(loaded);
      auto loop = LoopCoverage::make(scenario.loaded, longest(header.scenario_hash), context_);
      if (!loop) return sink.already_reported();
      scenario.loop = *std::move(loop);
    }
    note_scenario(scenario.loaded.scenario.name);
    const auto check = ExecutionCheck::make(scenario.loaded, header.seed, context_);
    if (!check) return sink.already_reported();
    for (const auto& key : to_count(run)) {
      if (context_.stopped()) break;
      const auto& place = run.journal.places.at(key);
      const auto why = *check ? (*check)->wrong(run.journal.samples.at(key)) : std::string();
      if (!why.empty()) return sink.error(codes::kForeignJournalLine, place, why);
      if (!scenario.loop->add(run.journal.samples.at(key), header.seed, run.terms, place)) {
        return sink.already_reported();
      }
      ++coverage_.simulations;
      ++coverage_.executions;
    }
    return base::Unit{};
  }

  /// Performs of any execution of the scenario.
  std::int64_t longest(const std::string& hash) const {
    std::int64_t most = 0;
    for (const auto& run : runs_) {
      if (!run.executed || run.journal.header->scenario_hash != hash) continue;
      for (const auto& [key, record] : run.journal.samples) {
        most = std::max(most, static_cast<std::int64_t>(record.path->steps.size()));
      }
    }
    return most;
  }

  base::Status add_open(const FolderRecord& run) {
    const auto loaded = load_recorded_scenario({run.folder, options_.scenario}, *run.journal.header,
                                               ScenarioUse::kRun, context_);
    if (!loaded || !check(*loaded, run.journal)) return context_.sink().already_reported();
    return add_traces(*loaded, run);
  }

  /// One simulation of each trace, as `replay` looks at it.
  base::Status check(const ScenarioModel& loaded, const harness::JournalText& journal) {
    std::set<std::int64_t> seen;
    for (const auto& [key, record] : journal.samples) {
      if (!seen.insert(std::get<0>(key)).second) continue;
      const auto run = harness::recorded_run(journal, {std::get<0>(key), std::get<1>(key)});
      if (!check_recorded_run(loaded, run, context_)) return context_.sink().already_reported();
    }
    return base::Unit{};
  }

  /// The trace of a simulation from its initial state. None: stopped. Reports one that the model
  /// does not have.
  base::Result<std::optional<harness::CampaignTrace>> from_state_of(
      const harness::SampleRecord& record, const harness::CampaignTrace& trace,
      const harness::JournalText& journal, const ScenarioModel& loaded, EnumeratedTraces& feed) {
    const auto& recorded = *journal.line_of(record).trace;
    const auto symbols = feed.symbols();
    const harness::ModelFluents known(*symbols);
    auto fluents = harness::compared_fluents(loaded.scenario, known);
    std::sort(fluents.begin(), fluents.end());
    std::set<std::string> holds;
    for (const auto name : recorded.holds(0)) holds.emplace(name);
    std::vector<compiler::FluentId> state;
    for (const auto fluent : fluents) {
      if (holds.contains(symbols->name(fluent))) state.push_back(fluent);
    }
    auto found = feed.from(trace, fluents, state);
    if (!found) return context_.sink().already_reported();
    if (found->first == base::Known::kUndecided) return std::optional<harness::CampaignTrace>();
    if (!found->second || !same_trace(recorded, *found->second)) {
      return context_.sink().error(codes::kForeignJournalLine, journal.line_place_of(record),
                                   "the model has no such trace from this initial state");
    }
    return std::move(found->second);
  }

  base::Status add_traces(const ScenarioModel& loaded, const FolderRecord& run) {
    auto& sink = context_.sink();
    const auto& journal = run.journal;
    const auto& compilation = loaded.compilation;
    const auto listed = list_traces(compilation.model, journal, options_.limit, context_);
    if (!listed) {
      if (sink.has_errors()) return sink.already_reported();
      return sink.error(codes::kForeignJournalLine, journal.trace_places.begin()->second,
                        "the model has no such trace");
    }
    compiler::ReferenceLimits limits;
    limits.stop = &context_.stop();
    const compiler::ReferenceEvaluator evaluator(*compilation.typed, limits);
    if (const auto reason = evaluator.refusal()) {
      return sink.error_about(codes::kCheckGivenUp, "", 1, *reason);
    }
    const ModelCoverage model(*compilation.typed, evaluator, context_.files());
    std::optional<PlanCoverage> plan;
    if (compilation.plan) plan.emplace(*compilation.plan, *compilation.typed, context_.files());

    // The same scenario may have several runs: its traces count once.
    const auto& name = loaded.scenario.name;
    const bool is_new = note_scenario(name);
    const auto list = [this](const CoverageKey& key) -> CoverageCount& {
      auto& count = coverage_.items[key];
      if (!count.traces) count.traces = 0;
      return count;
    };
    for (const auto& [key, text] : model.all()) list(key).text = text;
    if (plan) {
      for (const auto& key : plan->all()) list(key);
    }
    coverage_.all_traces = coverage_.all_traces && listed->all;
    // The simulations by trace and initial state, with one of each.
    struct Simulated {
      std::int64_t hits = 0;
      const harness::SampleRecord* one = nullptr;
    };
    std::map<harness::StartKey, Simulated> simulated;
    for (const auto& key : to_count(run)) {
      const auto& record = journal.samples.at(key);
      auto& entry = simulated[{record.trace, record.start_state}];
      ++entry.hits;
      entry.one = &record;
    }
    for (const auto& trace : listed->traces) {
      if (context_.stopped()) break;
      const auto covered_by = [&](const harness::CampaignTrace& from) {
        auto covered = model.covered_by(from);
        if (plan) covered.merge(plan->covered_by(plan->path_of(from)));
        covered.insert({CoverageGroup::kTraces, name, 1, 1, trace.key});
        return covered;
      };
      auto any = covered_by(trace);
      for (auto at = simulated.lower_bound({trace.number, 0});
           at != simulated.end() && at->first.first == trace.number; ++at) {
        std::optional<harness::CampaignTrace> other;
        if (at->first.second > 0) {
          auto from = from_state_of(*at->second.one, trace, journal, loaded, *listed->feed);
          if (!from) return sink.already_reported();
          if (!*from) break;  // stopped
          other = **std::move(from);
        }
        auto covered = covered_by(other ? *other : trace);
        coverage_.simulations += at->second.hits;
        for (const auto& key : covered) list(key).hits += at->second.hits;
        any.merge(covered);
      }
      for (const auto& key : any) {
        auto& count = list(key);
        if (is_new) ++*count.traces;
      }
    }
    return base::Unit{};
  }

  const CoverageOptions& options_;
  Context& context_;
  std::vector<FolderRecord> runs_;
  /// Scenario, execution, seed, trace or initial state, and number of every simulation that was
  /// counted.
  std::set<std::tuple<std::string, bool, std::uint64_t, std::string, std::int64_t>> counted_;
  std::map<std::string, ExecutedScenario> executed_;  // by hash
  Coverage coverage_;
};

}  // namespace

base::Result<Coverage> coverage_of(const CoverageOptions& options, Context& context) {
  Collector collector(options, context);
  for (const auto& folder : options.folders) {
    if (!collector.read(folder)) return context.sink().already_reported();
  }
  if (!collector.add_all()) return context.sink().already_reported();
  return collector.take();
}

}  // namespace parallax::tools
