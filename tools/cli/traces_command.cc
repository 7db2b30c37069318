#include <chrono>
#include <memory>
#include <optional>

#include "compiler/base/diagnostic_codes.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/trace_sampler.h"
#include "runtime/trace/vocabulary.h"
#include "tools/cli/certify.h"
#include "tools/cli/limits.h"
#include "tools/cli/open_ends.h"
#include "tools/cli/scenario_model.h"
#include "tools/cli/signals.h"
#include "tools/cli/trace_listing.h"
#include "tools/cli/trace_writer.h"
#include "tools/cli/traces_replay.h"

namespace parallax::tools {
namespace {

struct TracesOptions {
  ModelOptions model;
  std::int64_t limit = 10;
  bool count = false;
  bool expect_traces = false;
  bool check = false;
  ListingOptions listing;
  ReplayTracesOptions replay;
  std::string distinct = "observable";
  bool distinct_given = false;
  std::string strategy = "auto";
  std::int64_t from = 1;
  std::int64_t sample = 0;
  std::int64_t seed = 1;
  std::string hits = "first";
  bool split_initial = false;
  CertifyOption certify;
};

std::vector<std::string> strategy_names() {
  std::vector<std::string> names;
  for (const auto& [strategy, name] : runtime::kStrategyNames) names.emplace_back(name);
  return names;
}

runtime::TraceQuery query_of(const TracesOptions& options) {
  runtime::TraceQuery query;
  query.distinct =
      options.distinct == "all" ? runtime::Distinct::kAll : runtime::Distinct::kObservable;
  for (const auto& [strategy, name] : runtime::kStrategyNames) {
    if (name == options.strategy) query.strategy = strategy;
  }
  query.wanted = options.count || options.sample > 0 ? 0 : options.limit;
  query.stop = &stop_flag();
  return query;
}

/// What is known of the traces that were not listed, and how.
struct Ending {
  std::string exploration;
  bool complete = false;
  std::vector<std::string> bounds = {};  // why it is complete up to the bound only
  std::string remark = {}, fields = {};  // of the certifier

  void add(TraceCertifier& certifier) {
    certifier.conclude(exploration);
    remark = certifier.remark(exploration);
    fields = certifier.fields();
    complete = complete && !certifier.refuted();
  }
};

/// Says what is known of the rest: complete, up to the bound, or stopped by the limit.
void close_list(const TracesOptions& options, const compiler::CompiledModel& model,
                const TraceWriter& writer, runtime::ListFormat* listing, const Ending& ending,
                double wall_s, Invocation& invocation) {
  if (stop_flag().load()) invocation.remark("stopped before the end: there may be more traces");
  for (const auto& bound : ending.bounds) invocation.remark(bound);
  const auto timing = fmt::format("\"timing\":{{\"wall_s\":{:.3f}}}", wall_s);
  if (invocation.options().json) {
    const auto list = options.count ? "" : fmt::format("\"list\":[{}],", writer.list());
    invocation.document(fmt::format(
        "{{\"status\":\"{}\",\"traces\":{},\"complete\":{},\"exploration\":\"{}\",{}{}{}{}{}}}\n",
        writer.agreed() ? "ok" : "error", writer.count(), ending.complete, ending.exploration,
        bounds_field(ending.bounds), ending.fields, writer.checked_field(), list, timing));
  } else if (options.count) {
    invocation.result(fmt::format("{}\n", writer.count()));
  } else if (listing != nullptr) {
    invocation.result(listing->end({writer.count(), ending.complete, ending.exploration,
                                    ending.remark + writer.checked_remark(),
                                    ending.fields + writer.checked_field()}));
  } else if (options.listing.format == "jsonl") {
    invocation.result(
        fmt::format("{{\"summary\":true,\"traces\":{},\"complete\":{},{}{}\"exploration\":\"{}\","
                    "\"model\":\"{}\",{}}}\n",
                    writer.count(), ending.complete, ending.fields, writer.checked_field(),
                    ending.exploration, runtime::model_hash(model), timing));
  } else {
    invocation.result(fmt::format("{} {}, {}{}{}\n", writer.count(),
                                  writer.count() == 1 ? "trace" : "traces", ending.exploration,
                                  ending.remark, writer.checked_remark()));
  }
}

void show_stats(const TracesOptions& options, const runtime::SourceStats& stats,
                Invocation& invocation) {
  if (!options.model.stats || invocation.options().json) return;
  write_error(fmt::format("strategy {}{}{}; {} states, {} transitions, {} solver calls\n",
                          stats.strategy, stats.remark.empty() ? "" : ", not the graph: ",
                          stats.remark, stats.states, stats.transitions, stats.solve_calls));
}

void report_refusal(const TracesOptions& options, const std::string& reason,
                    Invocation& invocation) {
  invocation.sink().error_about(base::DiagnosticCode::kStrategyRefused, "", options.strategy,
                                reason);
}

/// `--count` without a plan or constraints: no trace needs to be made.
int count_only(const TracesOptions& options, const compiler::CompiledModel& model,
               TraceCertifier& certifier, std::chrono::steady_clock::time_point start,
               Invocation& invocation) {
  const auto counted = runtime::count_traces(model, query_of(options));
  if (!counted.refusal.empty()) {
    report_refusal(options, counted.refusal, invocation);
    return 0;
  }
  if (counted.count == 0 && counted.complete) {
    certifier.conclude("complete");
  } else {
    certifier.decline("the traces were counted, not listed");
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const auto number = counted.count.get_str();
  if (!counted.complete) invocation.remark("stopped before the end: there may be more traces");
  show_stats(options, counted.stats, invocation);
  if (invocation.options().json) {
    invocation.document(
        fmt::format("{{\"status\":\"ok\",\"traces\":{},\"complete\":{},\"exploration\":\"{}\","
                    "\"strategy\":\"{}\",{}\"timing\":{{\"wall_s\":{:.3f}}}}}\n",
                    number, counted.complete, counted.complete ? "complete" : "stopped",
                    counted.stats.strategy, certifier.fields(), wall.count()));
  } else {
    invocation.result(number + '\n');
  }
  return counted.count == 0 && options.expect_traces ? 1 : 0;
}

/// Traces with a plan or constraints.
Ending enumerate_plan(const TracesOptions& options, const compiler::CompiledModel& model,
                      TraceWriter& writer) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&stop_flag()));
  runtime::PlanEnumerator enumerator(
      session, {.all_hits = options.hits == "all", .split_initial = options.split_initial});
  while (!writer.full() && !stop_flag().load()) {
    const auto trace = enumerator.next();
    if (!trace) break;
    writer.write(*trace);
  }
  return {std::string(runtime::to_string(enumerator.exploration())),
          enumerator.exploration() == runtime::Exploration::kAllTracesExplored,
          open_end_texts(model, enumerator.open_ends())};
}

/// Traces of a model; none if the strategy cannot be had.
std::optional<Ending> enumerate(const TracesOptions& options, const compiler::CompiledModel& model,
                                TraceWriter& writer, Invocation& invocation) {
  runtime::ModelTraces traces(model, query_of(options));
  if (!traces.refusal().empty()) {
    report_refusal(options, traces.refusal(), invocation);
    return std::nullopt;
  }
  if (options.from > 1) traces.seek(static_cast<long>(options.from - 1));
  writer.write_all(traces);
  // At the limit one more call tells "these are all" from "there are more".
  if (writer.full() && !stop_flag().load()) (void)traces.next();
  show_stats(options, traces.stats(), invocation);
  if (!traces.exhausted()) return Ending{"stopped", false};
  return Ending{options.from > 1 ? "complete from there on" : "complete", options.from == 1};
}

/// `--sample`; none if the strategy cannot be had.
std::optional<Ending> sample(const TracesOptions& options, const compiler::CompiledModel& model,
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
  if (!sample.complete) return Ending{"stopped", false};
  return Ending{
      fmt::format("drawn from {} with seed {}", sample.population.get_str(), options.seed), false};
}

/// Options that do not go together.
bool is_usable(const TracesOptions& options, Invocation& invocation) {
  const auto refuse = [&](const std::string& about, const std::string& why) {
    invocation.sink().error_about(base::DiagnosticCode::kUsage, about, why);
    return false;
  };
  if (options.check && !options.model.compat.empty()) {
    return refuse("", "--check evaluates the standard meaning and does not go with --compat");
  }
  if (options.check && names_artifact(options.model)) {
    return refuse(options.model.models.front(),
                  "--check evaluates the texts of a model; name them instead");
  }
  if (options.sample > 0 && (options.count || options.from > 1)) {
    return refuse("", "--sample does not go with --count or --from");
  }
  if (!options.certify.file.empty() && options.listing.format == "decreasoner" &&
      !options.distinct_given) {
    return refuse("",
                  "--certify proves a list over HoldsAt and Happens complete; --format "
                  "decreasoner lists every atom, unless --distinct observable is given");
  }
  if (!options.certify.file.empty() &&
      (options.sample > 0 || options.from > 1 || options.distinct == "all")) {
    return refuse("",
                  "--certify proves a whole list over HoldsAt and Happens complete; it does not "
                  "go with --sample, --from or --distinct all");
  }
  if (!options.certify.file.empty() && (options.hits == "all" || options.split_initial)) {
    return refuse("",
                  "--certify proves a list of first hits complete; it does not go with "
                  "--hits=all or --split-initial");
  }
  if (options.count && options.from > 1) return refuse("", "--count does not go with --from");
  return true;
}

/// What a model without a plan can be asked for, and one with a plan cannot.
bool asks_for_models(const TracesOptions& options) {
  return options.sample > 0 || options.from > 1 || options.distinct_given ||
         options.strategy != "auto";
}

int list_traces(const TracesOptions& options, Invocation& invocation) {
  const auto start = std::chrono::steady_clock::now();
  if (!options.replay.file.empty()) {
    return replay_traces(options.model, options.replay, invocation);
  }
  if (!is_usable(options, invocation)) return 0;
  if (!check_listing(options.model, options.listing, invocation.sink())) return 0;
  const auto compilation = compile_models(options.model, invocation);
  if (!compilation) return 0;
  if (options.model.stats && !invocation.options().json && !compilation->costs.empty()) {
    write_error(compiler::cost_table(compilation->costs, invocation.files()));
  }
  TraceCertifier certifier(options.certify, options.model.models, compilation->model, invocation);
  if (!certifier.ready()) return 0;
  if (options.count && !options.check && !compilation->model.has_constraints) {
    return count_only(options, compilation->model, certifier, start, invocation);
  }
  const auto& model = compilation->model;
  if (model.has_constraints && asks_for_models(options)) {
    invocation.sink().error_about(base::DiagnosticCode::kUsage, options.model.models.front(),
                                  "--sample, --from, --distinct and --strategy do not go with a "
                                  "plan or state constraints");
    return 0;
  }
  std::optional<TraceCheck> check;
  if (options.check) check.emplace(*compilation->typed, &stop_flag(), invocation.sink());
  const bool lists = !options.count && !invocation.options().json;
  const bool one_trace = (options.sample > 0 ? options.sample : options.limit) == 1;
  const auto listing =
      lists ? make_listing(options.model, options.listing, one_trace, *compilation, invocation)
            : nullptr;
  const StoppedText stopped(lists ? stopped_text(options.listing.format) : "");
  TraceWriter writer({options.listing.format, options.count, options.sample > 0 ? 0 : options.limit,
                      listing.get()},
                     check ? &*check : nullptr, certifier, invocation);
  std::optional<Ending> ending;
  if (model.has_constraints) {
    ending = enumerate_plan(options, model, writer);
  } else if (options.sample > 0) {
    ending = sample(options, model, writer, invocation);
  } else {
    ending = enumerate(options, model, writer, invocation);
  }
  if (!ending) return 0;
  ending->add(certifier);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  close_list(options, model, writer, listing.get(), *ending, wall.count(), invocation);
  return writer.count() == 0 && options.expect_traces ? 1 : 0;
}

}  // namespace

Command add_traces_command(CLI::App& app) {
  auto options = std::make_shared<TracesOptions>();
  auto* command = app.add_subcommand(
      "traces", "Enumerate the traces of a model, or of a scenario's model, plan and constraints");
  command->footer(
      "Examples:\n"
      "  parallax traces domain.e start.e --horizon 2 --limit 0\n"
      "  parallax traces domain.e --count\n"
      "  parallax traces domain.e --from 1000001 --limit 10\n"
      "  parallax traces domain.e --sample 5 --seed 7\n"
      "  parallax traces scenarios/two_regions/scenario.yaml --format jsonl\n"
      "  parallax traces domain.e --limit 0 --certify=domain.drat\n"
      "  parallax traces domain.e --format csv > traces.csv\n"
      "  parallax traces domain.e --limit 0 --format itf --output traces/\n"
      "  parallax traces old.e --compat decreasoner --format decreasoner\n"
      "  parallax traces domain.e --replay traces/trace_000001.itf.json");
  add_model_options(*command, options->model);
  add_plan_options(*command, options->model);
  command->add_option("--limit", options->limit, "Stop after this many traces; 0: all")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--count", options->count, "Print only the number of traces");
  command->add_option("--from", options->from, "Begin with the trace of this number")
      ->check(whole_number(1, kMaxSeed))
      ->capture_default_str();
  command->add_option("--sample", options->sample, "So many traces, each any one equally likely")
      ->check(whole_number(1, 1'000'000));
  command->add_option("--seed", options->seed, "Of --sample")
      ->check(whole_number(0, kMaxSeed))
      ->capture_default_str();
  auto* distinct = command->add_option(
      "--distinct", options->distinct,
      "What tells traces apart: `observable` (HoldsAt and Happens) or `all` atoms, which is the "
      "default of --format decreasoner");
  distinct->check(CLI::IsMember({"observable", "all"}))->capture_default_str();
  command
      ->add_option("--strategy", options->strategy,
                   "auto, search, graph, tree, guarded or blocking: the traces and their order are "
                   "the same, the time is not")
      ->check(CLI::IsMember(strategy_names()))
      ->capture_default_str();
  command->add_flag("--stats", options->model.stats,
                    "Show on standard error how traces were found and what each axiom costs");
  command->add_flag("--expect-traces", options->expect_traces, "Exit with 1 if there is no trace");
  command->add_flag(
      "--check", options->check,
      "Evaluate the model on every trace by independent means; exit 5 if one differs");
  add_certify_option(*command, options->certify);
  command
      ->add_option("--hits", options->hits,
                   "Where traces end: first (at the first hit of the constraints) or all (at each)")
      ->check(CLI::IsMember({"first", "all"}))
      ->capture_default_str();
  command->add_flag("--split-initial", options->split_initial,
                    "List every initial state, not only every sequence of events");
  add_listing_options(*command, options->listing);
  add_replay_options(*command, options->replay);
  return {command, [options, distinct](Invocation& invocation) {
            options->distinct_given = distinct->count() > 0;
            if (options->listing.format == "decreasoner" && !options->distinct_given) {
              options->distinct = "all";
            }
            return list_traces(*options, invocation);
          }};
}

}  // namespace parallax::tools
