#include "tools/app/trace_search.h"

#include <fmt/format.h>

#include <set>

#include "compiler/base/codes/campaigns.h"
#include "runtime/cubes/cube_solver.h"
#include "runtime/enumerate/model_enumerator.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/orbit_number.h"
#include "runtime/graph/orbit_traces.h"
#include "runtime/graph/trace_count.h"
#include "tools/app/trace_writer.h"

namespace parallax::tools {
namespace {

using runtime::Strategy;

/// Most traces that the logged solver finds for a certified list before another strategy takes
/// over: blocking grows dearer with each.
constexpr std::int64_t kLogged = 64;

runtime::TraceQuery query_of(const SearchOptions& options, const Context& context) {
  runtime::TraceQuery query;
  query.distinct =
      options.distinct == "all" ? runtime::Distinct::kAll : runtime::Distinct::kObservable;
  runtime::kStrategyNames.take(options.strategy, query.strategy);
  query.wanted = options.sample > 0 ? 0 : options.limit;
  query.stop = &context.stop();
  query.jobs = options.jobs;
  return query;
}

/// A query for one trace that reaches something only asks whether there is one. The traces of a
/// plan are known by their numbers.
runtime::TraceOrder order_of(const SearchOptions& options, const TraceCertifier& certifier,
                             bool is_reached) {
  const bool witness = is_reached && options.limit == 1 && !certifier.is_asked();
  return options.order == "any" || (options.order.empty() && witness)
             ? runtime::TraceOrder::kAny
             : runtime::TraceOrder::kCanonical;
}

void show_stats(const SearchOptions& options, const runtime::SourceStats& stats, Context& context) {
  if (!options.stats || context.form().json) return;
  context.statistics(fmt::format("strategy {}{}{}; {} states, {} transitions, {} solver calls\n",
                                 stats.strategy, stats.remark.empty() ? "" : ", not the graph: ",
                                 stats.remark, stats.states, stats.transitions, stats.solve_calls));
}

void report_refusal(const SearchOptions& options, const std::string& reason, Context& context) {
  context.sink().error_about(codes::kStrategyRefused, "", options.strategy, reason);
}

/// May the log of a search by blocking become the proof? Other strategies do not leave one.
bool leaves_proof(const runtime::TraceQuery& query, const TraceCertifier& certifier) {
  const bool blocks = query.strategy == Strategy::kAuto || query.strategy == Strategy::kBlocking;
  return certifier.is_asked() && blocks;
}

/// The search by blocking that leaves a proof; none if there are more traces than it is worth.
std::optional<Ending> list_logged(const runtime::TraceQuery& query,
                                  const compiler::CompiledModel& model, TraceCertifier& certifier,
                                  TraceWriter& writer, runtime::SourceStats& stats,
                                  const Context& context) {
  runtime::SolverSession session(model, certifier.solver(), certifier.loading());
  runtime::ModelEnumerator enumerator(session, query.distinct);
  const auto most = query.strategy == Strategy::kAuto ? kLogged : INT64_MAX;
  while (!writer.full() && writer.count() < most && !context.stopped()) {
    const auto trace = enumerator.next();
    if (!trace) break;
    writer.write(*trace);
  }
  // At the limit one more call distinguishes "these are all" from "there are more".
  if (!enumerator.exhausted() && !context.stopped()) enumerator.look_on();
  stats = enumerator.stats();
  if (enumerator.exhausted()) {
    return Ending{.exploration = "complete", .complete = true, .searched = true};
  }
  if (writer.full() || context.stopped()) return Ending{};
  return std::nullopt;
}

std::optional<Ending> draw(const SearchOptions& options, const compiler::CompiledModel& model,
                           TraceWriter& writer, Context& context) {
  const auto sample = runtime::sample_traces(model, query_of(options, context),
                                             static_cast<std::size_t>(options.sample),
                                             static_cast<std::uint64_t>(options.seed));
  if (!sample.refusal.empty()) {
    report_refusal(options, sample.refusal, context);
    return std::nullopt;
  }
  for (const auto& trace : sample.traces) {
    if (!writer.cut_short()) writer.write(trace);
  }
  show_stats(options, sample.stats, context);
  if (!sample.complete || writer.cut_short()) return Ending{};
  return Ending{.exploration = fmt::format("drawn from {} with seed {}",
                                           sample.population.get_str(), options.seed)};
}

/// Prints the interchangeable constants that the listing rests on, for --stats.
void show_constants(const SearchOptions& options, const runtime::Interchangeables& constants,
                    Context& context) {
  if (!options.stats || context.form().json) return;
  std::string text = constants.empty() ? "interchangeable: no constants" : "";
  const auto start = [&] { text += text.empty() ? "interchangeable: " : "; "; };
  for (const auto& set : constants.sets) {
    start();
    for (std::size_t i = 0; i < set.size(); ++i) text += (i > 0 ? ", " : "") + set[i];
  }
  for (const auto& cycles : constants.together) {
    start();
    for (std::size_t i = 0; i < cycles.size(); ++i) {
      if (i > 0) text += i + 1 < cycles.size() ? ", " : " and ";
      for (const auto& name : cycles[i])
        text += (&name == &cycles[i].front() ? "" : " with ") + name;
    }
    if (cycles.size() > 1) text += " together";
  }
  context.statistics(text + '\n');
}

/// One trace of each orbit.
std::optional<Ending> list_orbits(const SearchOptions& options,
                                  const compiler::CompiledModel& model,
                                  const runtime::TraceQuery& query, TraceCertifier& certifier,
                                  TraceWriter& writer, Context& context) {
  runtime::OrbitTraces traces(model, query);
  if (!traces.refusal().empty()) {
    report_refusal(options, traces.refusal(), context);
    return std::nullopt;
  }
  while (!writer.full() && !context.stopped()) {
    auto trace = traces.next();
    if (!trace) break;
    trace->orbit = traces.size().get_str();
    writer.write(*trace);
  }
  Ending ending;
  ending.in_all = traces.total().get_str();
  if (writer.full() && !context.stopped()) (void)traces.next();
  show_stats(options, traces.stats(), context);
  show_constants(options, traces.constants(), context);
  if (!traces.exhausted() || writer.cut_short()) return ending;
  if (!traces.constants().empty()) certifier.rest_on_symmetry();
  ending.exploration = "complete";
  ending.complete = true;
  return ending;
}

}  // namespace

Ending list_plan_traces(const SearchOptions& options, const compiler::CompiledModel& model,
                        TraceCertifier& certifier, TraceWriter& writer, Context& context) {
  const auto order = order_of(options, certifier, model.plan.empty());
  const bool any = order == runtime::TraceOrder::kAny && !certifier.is_asked();
  std::optional<runtime::ModelSymmetry> symmetry;
  std::optional<runtime::TraceOrbits> orbits;
  // A plan names the things that it is about; without one, many things may be interchangeable.
  const bool asks_first = model.plan.empty() && !certifier.is_asked();
  if (any || asks_first || options.up_to_symmetry) {
    symmetry.emplace(model, options.up_to_symmetry ? runtime::SymmetryEffort::kThorough
                                                   : runtime::SymmetryEffort::kQuick);
  }
  if (!any && !options.up_to_symmetry && symmetry &&
      symmetry->known_order() < runtime::kWorthBreaking) {
    symmetry.reset();
  }
  if (options.up_to_symmetry) {
    orbits.emplace(
        model, symmetry->group(),
        options.split_initial ? runtime::Compared::kKeyAndStart : runtime::Compared::kKey);
    show_constants(options, symmetry->constants(), context);
  }
  // Cubes leave no proof.
  runtime::SolverSession session(model,
                                 certifier.is_asked()
                                     ? certifier.solver()
                                     : runtime::make_solver_for_jobs(options.jobs, &context.stop()),
                                 certifier.loading());
  runtime::PlanEnumerator enumerator(session, {.all_hits = options.hits == "all",
                                               .split_initial = options.split_initial,
                                               .order = order,
                                               .symmetry = symmetry ? &*symmetry : nullptr,
                                               .representatives = options.up_to_symmetry});
  Ending ending;
  mpz_class in_all;
  std::set<std::string> forms;
  while (!writer.full() && !context.stopped()) {
    auto trace = enumerator.next();
    if (!trace) break;
    if (orbits) {
      auto orbit = orbits->of(*trace);
      if (!forms.insert(std::move(orbit.form)).second) continue;
      in_all += orbit.size;
      trace->orbit = orbit.size.get_str();
      trace->number = static_cast<std::int64_t>(forms.size());
    }
    writer.write(*trace);
  }
  if (orbits) ending.in_all = in_all.get_str();
  const bool rests = enumerator.by_symmetry() || (orbits && !symmetry->empty());
  if (rests) certifier.rest_on_symmetry();
  ending.exploration = runtime::to_string(enumerator.exploration());
  ending.complete = enumerator.exploration() == runtime::Exploration::kAllTracesExplored;
  ending.bounds = open_end_texts(model, enumerator.open_ends());
  if (!enumerator.open_ends().cuts.empty()) certifier.note_cut();
  ending.dead_end = enumerator.dead_end();
  ending.searched = true;
  return ending;
}

std::optional<Ending> list_model_traces(const SearchOptions& options,
                                        const compiler::CompiledModel& model,
                                        TraceCertifier& certifier, TraceWriter& writer,
                                        Context& context) {
  // Without constraints executions that were cut are in the list like others.
  if (may_be_cut(model)) certifier.note_cut();
  if (options.sample > 0) return draw(options, model, writer, context);
  auto query = query_of(options, context);
  query.order = order_of(options, certifier, false);
  query.breaks_symmetry = !certifier.is_asked();
  if (options.up_to_symmetry) {
    return list_orbits(options, model, query, certifier, writer, context);
  }
  if (leaves_proof(query, certifier)) {
    runtime::SourceStats stats;
    const auto ending = list_logged(query, model, certifier, writer, stats, context);
    if (ending) {
      show_stats(options, stats, context);
      return ending;
    }
  }
  runtime::ModelTraces traces(model, query);
  if (!traces.refusal().empty()) {
    report_refusal(options, traces.refusal(), context);
    return std::nullopt;
  }
  const auto before = options.from - 1 + writer.count();
  if (before > 0) traces.seek(static_cast<long>(before));
  writer.write_all(traces);
  // At the limit one more call distinguishes "these are all" from "there are more". A query for any
  // witness does not wait for that.
  const bool asks_on = query.order == runtime::TraceOrder::kCanonical;
  if (asks_on && writer.full() && !context.stopped()) traces.look_on();
  show_stats(options, traces.stats(), context);
  if (!traces.exhausted() || writer.cut_short()) return Ending{};
  if (traces.stats().by_symmetry) certifier.rest_on_symmetry();
  return Ending{options.from > 1 ? "complete from there on" : "complete", options.from == 1};
}

namespace {

std::optional<CountedTraces> count_model_orbits(const SearchOptions& options,
                                                const compiler::CompiledModel& model,
                                                const runtime::ModelSymmetry& symmetry,
                                                const runtime::TraceQuery& query,
                                                TraceCertifier& certifier, Context& context) {
  const auto counted = runtime::count_orbits(model, symmetry, query);
  if (!counted) return std::nullopt;
  certifier.rest_on_symmetry();
  show_constants(options, symmetry.constants(), context);
  if (options.stats && !context.form().json) {
    context.statistics(
        fmt::format("strategy orbit counting; {} symmetries asked\n", counted->counted));
  }
  CountedTraces result{counted->orbits.get_str(), "orbit counting", {}};
  result.ending = {"complete", true};
  result.ending.in_all = counted->traces.get_str();
  return result;
}

}  // namespace

std::optional<CountedTraces> count_model_traces(const SearchOptions& options,
                                                const compiler::CompiledModel& model,
                                                TraceCertifier& certifier, Context& context) {
  if (may_be_cut(model)) certifier.note_cut();
  auto query = query_of(options, context);
  query.wanted = 0;
  query.breaks_symmetry = !certifier.is_asked();
  if (options.up_to_symmetry) {
    const runtime::ModelSymmetry symmetry(model);
    if (!symmetry.empty())
      return count_model_orbits(options, model, symmetry, query, certifier, context);
  }
  if (leaves_proof(query, certifier)) {
    // The number of traces is proved only for a model without any.
    runtime::SolverSession session(model, certifier.solver(), certifier.loading());
    if (session.solve(model.horizon, {}) == runtime::SolveStatus::kUnsatisfiable) {
      return CountedTraces{
          "0", "blocking", {.exploration = "complete", .complete = true, .searched = true}};
    }
  }
  const auto counted = runtime::count_traces(model, query);
  if (!counted.refusal.empty()) {
    report_refusal(options, counted.refusal, context);
    return std::nullopt;
  }
  show_stats(options, counted.stats, context);
  CountedTraces result{counted.count.get_str(), counted.stats.strategy, {}};
  if (counted.stats.by_symmetry) certifier.rest_on_symmetry();
  if (counted.complete) result.ending = {"complete", true};
  result.ending.in_all = result.number;  // without symmetry each is an orbit of its own
  return result;
}

}  // namespace parallax::tools
