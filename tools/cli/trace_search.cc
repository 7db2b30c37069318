#include "tools/cli/trace_search.h"

#include <fmt/format.h>

#include "compiler/base/diagnostic_codes.h"
#include "runtime/enumerate/model_enumerator.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/trace_counter.h"
#include "runtime/graph/trace_sampler.h"
#include "tools/cli/limits.h"
#include "tools/cli/open_ends.h"
#include "tools/cli/signals.h"

namespace parallax::tools {
namespace {

using runtime::Strategy;

/// Of a certified list so many traces are searched by the logged solver before another strategy
/// takes over: blocking grows dearer with each.
constexpr std::int64_t kLogged = 64;

std::vector<std::string> strategy_names() {
  std::vector<std::string> names;
  for (const auto& [strategy, name] : runtime::kStrategyNames) names.emplace_back(name);
  return names;
}

runtime::TraceQuery query_of(const SearchOptions& options) {
  runtime::TraceQuery query;
  query.distinct =
      options.distinct == "all" ? runtime::Distinct::kAll : runtime::Distinct::kObservable;
  for (const auto& [strategy, name] : runtime::kStrategyNames) {
    if (name == options.strategy) query.strategy = strategy;
  }
  query.wanted = options.sample > 0 ? 0 : options.limit;
  query.stop = &stop_flag();
  return query;
}

void show_stats(const SearchOptions& options, const runtime::SourceStats& stats,
                Invocation& invocation) {
  if (!options.stats || invocation.options().json) return;
  write_error(fmt::format("strategy {}{}{}; {} states, {} transitions, {} solver calls\n",
                          stats.strategy, stats.remark.empty() ? "" : ", not the graph: ",
                          stats.remark, stats.states, stats.transitions, stats.solve_calls));
}

void report_refusal(const SearchOptions& options, const std::string& reason,
                    Invocation& invocation) {
  invocation.sink().error_about(base::DiagnosticCode::kStrategyRefused, "", options.strategy,
                                reason);
}

/// May the log of a search by blocking become the proof? Other strategies do not leave one.
bool leaves_proof(const runtime::TraceQuery& query, const TraceCertifier& certifier) {
  const bool blocks = query.strategy == Strategy::kAuto || query.strategy == Strategy::kBlocking;
  return certifier.is_asked() && blocks;
}

/// The search by blocking that leaves a proof; none if there are more traces than are worth it.
std::optional<Ending> list_logged(const runtime::TraceQuery& query,
                                  const compiler::CompiledModel& model, TraceCertifier& certifier,
                                  TraceWriter& writer, runtime::SourceStats& stats) {
  runtime::SolverSession session(model, certifier.solver(), certifier.loading());
  runtime::ModelEnumerator enumerator(session, query.distinct);
  const auto most = query.strategy == Strategy::kAuto ? kLogged : INT64_MAX;
  while (!writer.full() && writer.count() < most && !stop_flag().load()) {
    const auto trace = enumerator.next();
    if (!trace) break;
    writer.write(*trace);
  }
  // At the limit one more call tells "these are all" from "there are more".
  if (!enumerator.exhausted() && !stop_flag().load()) (void)enumerator.next();
  stats = enumerator.stats();
  if (enumerator.exhausted()) return Ending{"complete", true, {}, true};
  if (writer.full() || stop_flag().load()) return Ending{};
  return std::nullopt;
}

std::optional<Ending> draw(const SearchOptions& options, const compiler::CompiledModel& model,
                           TraceWriter& writer, Invocation& invocation) {
  const auto sample =
      runtime::sample_traces(model, query_of(options), static_cast<std::size_t>(options.sample),
                             static_cast<std::uint64_t>(options.seed));
  if (!sample.refusal.empty()) {
    report_refusal(options, sample.refusal, invocation);
    return std::nullopt;
  }
  for (const auto& trace : sample.traces) writer.write(trace);
  show_stats(options, sample.stats, invocation);
  if (!sample.complete) return Ending{};
  return Ending{.exploration = fmt::format("drawn from {} with seed {}",
                                           sample.population.get_str(), options.seed)};
}

}  // namespace

Ending list_plan_traces(const SearchOptions& options, const compiler::CompiledModel& model,
                        TraceCertifier& certifier, TraceWriter& writer) {
  runtime::SolverSession session(model, certifier.solver(), certifier.loading());
  runtime::PlanEnumerator enumerator(
      session, {.all_hits = options.hits == "all", .split_initial = options.split_initial});
  while (!writer.full() && !stop_flag().load()) {
    const auto trace = enumerator.next();
    if (!trace) break;
    writer.write(*trace);
  }
  return {std::string(runtime::to_string(enumerator.exploration())),
          enumerator.exploration() == runtime::Exploration::kAllTracesExplored,
          open_end_texts(model, enumerator.open_ends()), true};
}

std::optional<Ending> list_model_traces(const SearchOptions& options,
                                        const compiler::CompiledModel& model,
                                        TraceCertifier& certifier, TraceWriter& writer,
                                        Invocation& invocation) {
  if (options.sample > 0) return draw(options, model, writer, invocation);
  const auto query = query_of(options);
  if (leaves_proof(query, certifier)) {
    runtime::SourceStats stats;
    const auto ending = list_logged(query, model, certifier, writer, stats);
    if (ending) {
      show_stats(options, stats, invocation);
      return ending;
    }
  }
  runtime::ModelTraces traces(model, query);
  if (!traces.refusal().empty()) {
    report_refusal(options, traces.refusal(), invocation);
    return std::nullopt;
  }
  const auto before = options.from - 1 + writer.count();
  if (before > 0) traces.seek(static_cast<long>(before));
  writer.write_all(traces);
  // At the limit one more call tells "these are all" from "there are more".
  if (writer.full() && !stop_flag().load()) (void)traces.next();
  show_stats(options, traces.stats(), invocation);
  if (!traces.exhausted()) return Ending{};
  return Ending{options.from > 1 ? "complete from there on" : "complete", options.from == 1};
}

std::optional<CountedTraces> count_model_traces(const SearchOptions& options,
                                                const compiler::CompiledModel& model,
                                                TraceCertifier& certifier, Invocation& invocation) {
  auto query = query_of(options);
  query.wanted = 0;
  if (leaves_proof(query, certifier)) {
    // Only of a model without traces the number is proved.
    runtime::SolverSession session(model, certifier.solver(), certifier.loading());
    if (session.solve(model.horizon, {}) == runtime::SolveStatus::kUnsatisfiable) {
      return CountedTraces{"0", "blocking", {"complete", true, {}, true}};
    }
  }
  const auto counted = runtime::count_traces(model, query);
  if (!counted.refusal.empty()) {
    report_refusal(options, counted.refusal, invocation);
    return std::nullopt;
  }
  show_stats(options, counted.stats, invocation);
  CountedTraces result{counted.count.get_str(), counted.stats.strategy, {}};
  if (counted.complete) result.ending = {"complete", true};
  return result;
}

void add_search_options(OptionTable& command, SearchOptions& options) {
  command.option("--limit", options.limit, "Stop after this many traces; 0: all")
      .check(NonNegative{})
      .show_default();
  command.option("--from", options.from, "Begin with the trace of this number")
      .check(WholeNumber{1, kMaxSeed})
      .show_default();
  command.option("--sample", options.sample, "So many traces, each any one equally likely")
      .check(WholeNumber{1, 1'000'000});
  command.option("--seed", options.seed, "Of --sample")
      .check(WholeNumber{0, kMaxSeed})
      .show_default();
  command
      .option("--strategy", options.strategy,
              "auto, search, graph, tree, guarded or blocking: the traces and their order are "
              "the same, the time is not")
      .check(OneOf{strategy_names()})
      .show_default();
  command
      .option("--hits", options.hits,
              "Where traces end: first (at the first hit of the constraints) or all (at each)")
      .check(OneOf{{"first", "all"}})
      .show_default();
  command.flag("--split-initial", options.split_initial,
               "List every initial state, not only every sequence of events");
}

}  // namespace parallax::tools
