#include <chrono>
#include <memory>
#include <optional>

#include "compiler/base/codes/files.h"
#include "compiler/base/words.h"
#include "runtime/enumerate/open_atom_finder.h"
#include "runtime/trace/trace.h"
#include "tools/app/best_traces.h"
#include "tools/app/certify.h"
#include "tools/app/plan_inputs.h"
#include "tools/app/preferred_traces.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_listing.h"
#include "tools/app/trace_search.h"
#include "tools/app/trace_writer.h"
#include "tools/app/traces_replay.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/replayed_trace.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct TracesOptions {
  ModelOptions model;
  std::vector<std::string> prefer;
  SearchOptions search;
  bool count = false;
  bool expect_traces = false;
  std::string ended;
  bool check = false;
  ListingOptions listing;
  ReplayTracesOptions replay;
  bool distinct_given = false;
  CertifyOption certify;
};

using StartTime = std::chrono::steady_clock::time_point;
double seconds_since(StartTime start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

constexpr std::int64_t kBriefly = 20'000;  // conflicts to find what one trace leaves open

/// For a complete and empty list.
void point_to_explanation(const TracesOptions& options, const Invocation& invocation) {
  std::string command = "parallax explain";
  for (const auto& model : options.model.models) command += " " + model;
  if (options.model.horizon >= 0) command += fmt::format(" --horizon {}", options.model.horizon);
  for (const auto& text : options.model.until) command += fmt::format(" --until \"{}\"", text);
  invocation.remark(fmt::format("no trace: `{}` says which axioms exclude each other", command));
}

/// Tells what is known of the other traces: complete, up to the bound, or stopped by the limit.
void close_list(const TracesOptions& options, const compiler::CompiledModel& model,
                const TraceWriter& writer, runtime::ListFormat* listing, const Ending& ending,
                const TraceCertifier& certifier, const BestTraces* best,
                const PreferredTraces* preferred, double wall_s, Invocation& invocation) {
  const bool stopped = ending.exploration == "stopped" || certifier.is_asked();
  if (stopped && stop_flag().load() && !invocation.sink().has_errors()) {
    invocation.remark("stopped before the end: there may be more traces");
  }
  if (!stopped) invocation.answered();
  for (const auto& bound : ending.bounds) invocation.remark(bound);
  if (ending.dead_end) {
    invocation.remark(dead_end_text(model, "meets the constraints", *ending.dead_end));
  }
  auto fields = certifier.fields();
  if (best != nullptr) {
    fields = best->fields() + (best->proof_fields().empty() ? fields : best->proof_fields());
  }
  if (ending.dead_end) fields += fmt::format("\"dead_end\":{},", *ending.dead_end);
  if (preferred != nullptr) fields += preferred->fields();
  std::string in_all;
  if (options.search.up_to_symmetry) {
    fields += fmt::format("\"up_to_symmetry\":true,\"in_all\":{},", ending.in_all);
    in_all = fmt::format(" up to symmetry, {} in all{}", ending.in_all, stopped ? " so far" : "");
  }
  // Executions of the plan that were not explored have traces that are not in the list.
  const bool complete = ending.complete && !certifier.refuted() && !certifier.reservations().any();
  if (complete && writer.count() == 0 && options.search.from == 1 && options.ended.empty()) {
    point_to_explanation(options, invocation);
  }
  const auto timing = fmt::format("\"timing\":{{\"wall_s\":{:.3f}}}", wall_s);
  if (invocation.options().json) {
    const auto list = options.count ? "" : fmt::format("\"list\":[{}],", writer.list());
    invocation.document(fmt::format(
        "{{\"status\":\"{}\",\"traces\":{},\"complete\":{},\"exploration\":\"{}\",{}{}{}{}{}}}\n",
        writer.agreed() ? "ok" : "error", writer.count(), complete, ending.exploration,
        bounds_field(ending.bounds), fields, writer.checked_field(), list, timing));
  } else if (options.count) {
    invocation.result(fmt::format("{}{}\n", writer.count(), in_all));
  } else if (listing != nullptr) {
    invocation.result(listing->end({writer.count(), complete, ending.exploration,
                                    certifier.remark(ending.exploration) + writer.checked_remark(),
                                    fields + writer.checked_field()}));
  } else if (options.listing.format == "jsonl") {
    invocation.result(
        fmt::format("{{\"summary\":true,\"traces\":{},\"complete\":{},{}{}\"exploration\":\"{}\","
                    "\"model\":\"{}\",{}}}\n",
                    writer.count(), complete, fields, writer.checked_field(), ending.exploration,
                    runtime::model_hash(model), timing));
  } else {
    invocation.result(fmt::format("{}{}, {}{}{}\n", base::counted(writer.count(), "trace"), in_all,
                                  ending.exploration, certifier.remark(ending.exploration),
                                  writer.checked_remark()));
    if (best != nullptr) invocation.result(best->text());
    if (preferred != nullptr) invocation.result(preferred->text());
  }
}

/// `--count` without a plan or constraints, for which no trace needs to be made. None: orbits have
/// to be listed to be counted.
std::optional<int> count_only(const TracesOptions& options, const compiler::CompiledModel& model,
                              TraceCertifier& certifier, const BestTraces* best,
                              const PreferredTraces* preferred, StartTime start,
                              Invocation& invocation) {
  const auto counted = count_model_traces(options.search, model, certifier, invocation);
  if (!counted && options.search.up_to_symmetry && !invocation.sink().has_errors()) {
    return std::nullopt;
  }
  if (!counted) return 0;
  const auto& ending = counted->ending;
  if (counted->number == "0" && ending.complete) {
    certifier.conclude(ending.exploration, ending.searched);
  } else {
    certifier.decline("the traces were counted, not listed");
  }
  if (!ending.complete) invocation.remark("stopped before the end: there may be more traces");
  if (ending.complete && counted->number == "0") point_to_explanation(options, invocation);
  const bool all = options.search.up_to_symmetry;
  const bool proved = best != nullptr && !best->proof_fields().empty();
  const auto fields =
      (best != nullptr ? best->fields() : "") + (preferred != nullptr ? preferred->fields() : "") +
      (proved ? best->proof_fields() : certifier.fields()) +
      (all ? fmt::format("\"up_to_symmetry\":true,\"in_all\":{},", ending.in_all) : "");
  if (invocation.options().json) {
    invocation.document(
        fmt::format("{{\"status\":\"ok\",\"traces\":{},\"complete\":{},\"exploration\":\"{}\","
                    "\"strategy\":\"{}\",{}\"timing\":{{\"wall_s\":{:.3f}}}}}\n",
                    counted->number, ending.complete && !certifier.reservations().any(),
                    ending.exploration, counted->strategy, fields, seconds_since(start)));
  } else {
    invocation.result(counted->number +
                      (all ? fmt::format(" up to symmetry, {} in all\n", ending.in_all) : "\n"));
  }
  return counted->number == "0" && options.expect_traces ? 1 : 0;
}

/// Options that do not go together.
bool is_usable(const TracesOptions& options, Invocation& invocation) {
  const auto refuse = [&](const std::string& about, const std::string& why) {
    invocation.sink().error_about(codes::kUsage, about, why);
    return false;
  };
  if (options.check && !options.model.compat.empty()) {
    return refuse("", "--check evaluates the standard meaning and does not go with --compat");
  }
  if (options.check && names_artifact(options.model)) {
    return refuse(options.model.models.front(),
                  "--check evaluates the texts of a model; name them instead");
  }
  if (options.search.sample > 0 && (options.count || options.search.from > 1)) {
    return refuse("", "--sample does not go with --count or --from");
  }
  if (!options.certify.file.empty() && options.listing.format == "decreasoner" &&
      !options.distinct_given) {
    return refuse("",
                  "--certify proves a list over HoldsAt and Happens complete; --format "
                  "decreasoner lists every atom, unless --distinct observable is given");
  }
  if (!options.certify.file.empty() &&
      (options.search.sample > 0 || options.search.from > 1 || options.search.distinct == "all")) {
    return refuse("",
                  "--certify proves a whole list over HoldsAt and Happens complete; it does not "
                  "go with --sample, --from or --distinct all");
  }
  if (!options.certify.file.empty() &&
      (options.search.hits == "all" || options.search.split_initial)) {
    return refuse("",
                  "--certify proves a list of first hits complete; it does not go with "
                  "--hits=all or --split-initial");
  }
  if (options.search.order == "any" &&
      (!options.certify.file.empty() || options.search.sample > 0 || options.search.from > 1)) {
    return refuse("",
                  "--order any does not go with --certify, --sample or --from, which need the "
                  "canonical order");
  }
  if (options.search.up_to_symmetry &&
      (!options.certify.file.empty() || options.search.sample > 0 || options.search.from > 1)) {
    return refuse("",
                  "--up-to-symmetry lists one trace of each orbit and does not go with --certify, "
                  "--sample or --from");
  }
  if (options.search.up_to_symmetry && options.listing.format != "text" &&
      options.listing.format != "jsonl") {
    return refuse("",
                  "--up-to-symmetry says for how many traces each one stands, which only "
                  "--format text and jsonl can");
  }
  const bool optimizes = options.model.best || !options.model.minimize.empty();
  const bool folds = options.search.up_to_symmetry;
  if (folds && optimizes)
    return refuse("--up-to-symmetry", "does not go with --minimize or --best");
  if (!options.ended.empty() && (folds || optimizes)) {
    return refuse("--ended", "does not go with --up-to-symmetry, --minimize or --best");
  }
  if (options.model.best && !options.model.minimize.empty()) {
    return refuse("--best", "takes the model's own objectives; it does not go with --minimize");
  }
  if (!options.prefer.empty() && (optimizes || folds || !options.certify.file.empty())) {
    return refuse("--prefer", "does not go with --minimize, --best, --certify or --up-to-symmetry");
  }
  if (options.count && options.search.from > 1) {
    return refuse("", "--count does not go with --from");
  }
  return true;
}

std::unique_ptr<runtime::ListFormat> listing_of(const TracesOptions& options,
                                                const compiler::Compilation& compilation,
                                                Invocation& invocation) {
  if (options.count || invocation.options().json) return nullptr;
  const auto wanted = options.search.sample > 0 ? options.search.sample : options.search.limit;
  return make_listing(options.model, options.listing, wanted == 1, compilation, invocation);
}

/// Text names no atom that can be open, and where all atoms tell traces apart none is.
bool names_open_atoms(const TracesOptions& options, const compiler::CompiledModel& model,
                      const Invocation& invocation) {
  if (!invocation.options().json && options.listing.format == "text") return false;
  return model.has_constraints || options.search.distinct != "all";
}

/// `open_atoms` may be null.
TraceWriter::Form form_of(const TracesOptions& options, const compiler::Compilation& compilation,
                          runtime::ListFormat* listing, runtime::OpenAtomFinder* open_atoms) {
  const auto limit = options.search.sample > 0 ? 0 : options.search.limit;
  TraceWriter::Form form{options.listing.format, options.count, limit, listing, open_atoms};
  form.plan = compilation.model.plan.empty() ? nullptr : &compilation.model;
  if (compilation.plan) form.asked = symbols_read(*compilation.plan);
  form.all_hits = options.search.hits == "all";
  form.ended = options.ended;
  return form;
}

/// Lists, draws or counts the traces of what was compiled; with `best` these are the best ones of
/// the model `all`.
int list_compiled(const TracesOptions& options, const compiler::Compilation& compilation,
                  BestTraces* best, const compiler::CompiledModel* all,
                  const PreferredTraces* preferred, StartTime start, Invocation& invocation) {
  const auto& model = compilation.model;
  const CertifyOption not_asked;
  std::optional<TraceCertifier> certifier;
  certifier.emplace(options.certify, options.model.models, model, invocation);
  if (!certifier->ready()) return 0;
  certifier->note_gaps(compilation.plan);
  // Behind a cut there may be better ones, whether or not the best ones come to it.
  if (best != nullptr && all != nullptr && may_be_cut(*all)) certifier->note_cut();
  // Where the list claims less, the optimum has a proof of its own.
  const auto prove_optimum = [&] {
    if (best == nullptr || !best->optimum().witness || !certifier->is_asked()) return;
    certifier.emplace(not_asked, options.model.models, model, invocation);
    certifier->note_gaps(compilation.plan, false);
    best->certify(options.certify, options.model.models, *all, compilation.plan, invocation);
  };
  if (options.count && !options.check && options.ended.empty() && !model.has_constraints) {
    prove_optimum();
    const auto code = count_only(options, model, *certifier, best, preferred, start, invocation);
    if (code) return *code;
  }
  std::optional<TraceCheck> check;
  if (options.check) check.emplace(*compilation.typed, &stop_flag(), invocation.sink());
  const auto listing = listing_of(options, compilation, invocation);
  const bool lists = !options.count && !invocation.options().json;
  const StoppedText stopped(lists ? stopped_text(options.listing.format) : "");
  std::optional<runtime::OpenAtomFinder> open_atoms;
  if (names_open_atoms(options, model, invocation)) {
    const auto make_solver = [] { return runtime::make_cadical_solver(&stop_flag()); };
    open_atoms.emplace(model, make_solver, options.search.hits == "all");
  }
  TraceWriter writer(
      form_of(options, compilation, listing.get(), open_atoms ? &*open_atoms : nullptr),
      check ? &*check : nullptr, *certifier, invocation);
  std::optional<Ending> ending;
  if (model.has_constraints) {
    ending = list_plan_traces(options.search, model, *certifier, writer, invocation);
  } else {
    ending = list_model_traces(options.search, model, *certifier, writer, invocation);
  }
  if (!ending) return 0;
  if (best != nullptr && ending->exploration == "stopped") {
    prove_optimum();
  } else {
    certifier->conclude(ending->exploration, ending->searched);
    if (best != nullptr) best->adopt(*certifier);
  }
  close_list(options, model, writer, listing.get(), *ending, *certifier, best, preferred,
             seconds_since(start), invocation);
  return writer.count() == 0 && options.expect_traces ? 1 : 0;
}

/// Prints one best trace, or the best so far; nothing is claimed about others.
int list_witness(const TracesOptions& options, const compiler::Compilation& compilation,
                 BestTraces& best, StartTime start, Invocation& invocation) {
  const auto& model = compilation.model;
  const CertifyOption not_asked;
  TraceCertifier none(not_asked, options.model.models, model, invocation);
  std::optional<TraceCheck> check;
  if (options.check) check.emplace(*compilation.typed, &stop_flag(), invocation.sink());
  const auto listing = listing_of(options, compilation, invocation);
  const auto& optimum = best.optimum();
  // Among the best traces an atom may be settled that is open among all.
  std::optional<compiler::CompiledModel> bounded;
  std::optional<runtime::OpenAtomFinder> open_atoms;
  if (names_open_atoms(options, model, invocation) && runtime::has_hidden_atoms(model)) {
    bounded = best.model_of_best(model);
    // The best so far is told after a stop, too.
    const auto make_solver = [] {
      return runtime::make_limited_solver(runtime::make_cadical_solver(), kBriefly);
    };
    open_atoms.emplace(bounded ? *bounded : model, make_solver, false);
  }
  auto form = form_of(options, compilation, listing.get(), open_atoms ? &*open_atoms : nullptr);
  form.prints_unsettled = true;
  TraceWriter writer(std::move(form), check ? &*check : nullptr, none, invocation);
  if (optimum.witness) writer.write(*optimum.witness);
  const bool proved = optimum.proved();
  if (proved) {
    if (!options.certify.file.empty()) {
      best.certify(options.certify, options.model.models, model, compilation.plan, invocation);
    } else {
      invocation.answered();
    }
  }
  close_list(options, model, writer, listing.get(), {}, none, &best, nullptr, seconds_since(start),
             invocation);
  return proved ? 0 : 4;
}

/// Traces with the least values of the objectives.
int list_best(const TracesOptions& options, compiler::Compilation& compilation, StartTime start,
              Invocation& invocation) {
  if (compilation.model.objectives.empty()) {
    invocation.sink().error_about(
        codes::kUsage, "--best",
        names_artifact(options.model)
            ? "the compiled model has no objective; compile it with --best or --minimize"
            : "the model has no `minimize` statement; or give --minimize");
    return 0;
  }
  if (options.search.hits == "all") {
    invocation.sink().error_about(codes::kUsage, options.model.best ? "--best" : "--minimize",
                                  "does not go with --hits all: a trace ends at its first hit");
    return 0;
  }
  {
    // Reports before the search that files cannot be written.
    const TraceCertifier early(options.certify, options.model.models, compilation.model,
                               invocation);
    if (!early.ready()) return 0;
  }
  BestTraces best(compilation.model, invocation);
  if (best.optimum().none) {
    return list_compiled(options, compilation, &best, &compilation.model, nullptr, start,
                         invocation);
  }
  const auto& search = options.search;
  const bool any_will_do = search.limit == 1 && search.order != "canonical" && !options.count &&
                           search.sample == 0 && search.from == 1 && search.strategy == "auto" &&
                           !search.split_initial && !options.distinct_given;
  if (any_will_do || !best.optimum().proved()) {
    return list_witness(options, compilation, best, start, invocation);
  }
  auto bounded = best.model_of_best(compilation.model);
  if (!bounded && (options.count || search.sample > 0 || search.from > 1)) {
    invocation.sink().error_about(codes::kUsage, "--minimize",
                                  "the objective has too many different sums for its best traces "
                                  "to be counted or drawn; --limit 1 gives one of them");
    return 0;
  }
  if (!bounded) {
    invocation.remark(
        "the objective has too many different sums for a list: this is one best trace");
    return list_witness(options, compilation, best, start, invocation);
  }
  std::swap(compilation.model, *bounded);
  return list_compiled(options, compilation, &best, &*bounded, nullptr, start, invocation);
}

int list_traces(const TracesOptions& options, Invocation& invocation) {
  const auto start = std::chrono::steady_clock::now();
  if (!options.replay.file.empty()) return answer_replay(options.model, options.replay, invocation);
  if (!is_usable(options, invocation)) return 0;
  if (!check_listing(options.model, options.listing, invocation.sink())) return 0;
  auto compilation = compile_models(options.model, invocation);
  if (!compilation) return 0;
  if (options.model.stats && !invocation.options().json && !compilation->costs.empty()) {
    write_error(compiler::cost_table(compilation->costs, invocation.files()));
  }
  // Models without a plan support these.
  const bool asks_for_models = options.search.sample > 0 || options.search.from > 1 ||
                               options.distinct_given || options.search.strategy != "auto";
  if (compilation->model.has_constraints && asks_for_models) {
    invocation.sink().error_about(codes::kUsage, options.model.models.front(),
                                  "--sample, --from, --distinct and --strategy do not go with a "
                                  "plan or state constraints");
    return 0;
  }
  if (!options.ended.empty() && compilation->model.plan.empty()) {
    invocation.sink().error_about(codes::kUsage, "--ended", "is about plans; there is none");
    return 0;
  }
  if (!options.model.minimize.empty() || options.model.best) {
    return list_best(options, *compilation, start, invocation);
  }
  std::optional<PreferredTraces> preferred;
  if (!options.prefer.empty()) {
    preferred = PreferredTraces::of(options.prefer, *compilation, invocation);
    if (!preferred) return 0;
    compilation->model = preferred->model(compilation->model);
  }
  const auto* chosen = preferred ? &*preferred : nullptr;
  return list_compiled(options, *compilation, nullptr, nullptr, chosen, start, invocation);
}

}  // namespace

Command traces_command() {
  auto options = std::make_shared<TracesOptions>();
  OptionTable command(
      "traces", "Enumerate the traces of a model, or of a scenario's model, plan and constraints");
  command.footer(
      "Examples:\n"
      "  parallax traces domain.e start.e --horizon 2 --limit 0\n"
      "  parallax traces domain.e --count\n"
      "  parallax traces domain.e --from 1000001 --limit 10\n"
      "  parallax traces domain.e --sample 5 --seed 7\n"
      "  parallax traces domain.e --limit 0 --up-to-symmetry\n"
      "  parallax traces scenarios/two_regions/scenario.yaml --format jsonl\n"
      "  parallax traces domain.e --limit 0 --certify=domain.drat\n"
      "  parallax traces domain.e --minimize \"count Happens(event,time)\"\n"
      "  parallax traces domain.e --format csv > traces.csv\n"
      "  parallax traces domain.e --limit 0 --format itf --output traces/\n"
      "  parallax traces old.e --compat decreasoner --format decreasoner\n"
      "  parallax traces domain.e --replay traces/trace_000001.itf.json");
  add_model_options(command, options->model);
  add_plan_options(command, options->model);
  command.heading("Best traces");
  command
      .option("--minimize", options->model.minimize,
              "Only traces with the least `count FORMULA` or `sum TERM: FORMULA`; may be repeated")
      .details(
          "Counts over the free variables. Repeated: of the least traces, those for which the next "
          "objective is least.")
      .list(ListForm::kOneEachTime);
  command.flag("--best", options->model.best,
               "The same with what the model's `minimize` statements say, in their order");
  command
      .option("--prefer", options->prefer,
              "Only traces with a minimal set of true `Ab` atoms; may be repeated")
      .details(
          "Circumscription: no other trace has a proper subset of them. `Ab,Stuck`: both together. "
          "Repeated: the first one counts most. --minimize \"count ...\" asks for the fewest.")
      .list(ListForm::kOneEachTime);
  add_search_options(command, options->search);
  command.heading("What is told");
  command.flag("--count", options->count, "Print only the number of traces");
  command
      .option("--distinct", options->search.distinct,
              "Traces differ in `observable` atoms (HoldsAt, Happens) or in `all`")
      .details("all is the default of --format decreasoner.")
      .check(OneOf{{"observable", "all"}})
      .show_default();
  command
      .option("--ended", options->ended,
              "Only traces of a plan that ended like that: done, failed or cut")
      .check(OneOf{{"done", "failed", "cut"}});
  command.flag("--stats", options->model.stats,
               "Show on standard error how traces were found and what each axiom costs");
  command.flag("--expect-traces", options->expect_traces, "Exit with 1 if there is no trace");
  command.flag("--check", options->check,
               "Evaluate the model on every trace by independent means; exit 5 if one differs");
  add_certify_option(command, options->certify);
  add_listing_options(command, options->listing);
  add_replay_options(command, options->replay);
  return {std::move(command), [options](Invocation& invocation) {
            if (options->listing.format == "decreasoner" && !options->distinct_given) {
              options->search.distinct = "all";
            }
            if (options->count) options->search.limit = 0;
            options->search.stats = options->model.stats;
            return list_traces(*options, invocation);
          }};
}

}  // namespace parallax::tools
