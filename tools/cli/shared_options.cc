#include "tools/cli/shared_options.h"

#include <fmt/format.h>
#include <unistd.h>

#include <memory>
#include <mutex>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/subprocess.h"
#include "compiler/base/whole_number.h"
#include "runtime/graph/model_traces.h"
#include "tools/app/own_identity.h"
#include "tools/app/simulator_factory.h"
#include "tools/cli/command.h"
#include "tools/cli/launcher_options.h"
#include "tools/cli/limits.h"

namespace parallax::tools {
Option& add_model_options(OptionTable& command, ModelOptions& options) {
  const UnderHeading heading(command, "Model");
  auto& models = command
                     .option("models", options.models,
                             "Model files (.e), or one that `compile` wrote (.dec.cnf)")
                     .required()
                     .file({"e", "dec.cnf", "yaml"});
  // One value each time, so that a model may follow.
  command.option("-I,--include", options.include_dirs, "Folder in which `load` looks")
      .list(ListForm::kOneEachTime)
      .folder();
  command.option("--compat", options.compat, "Meaning of the 2005 reasoner where it differs")
      .check(OneOf{{"decreasoner"}});
  command.option("--horizon", options.horizon, "Last timepoint; replaces the range of `time`")
      .check(IntRange{0, 1'000'000});
  command
      .option("--until", options.until,
              "Formula over `time`, or a temporal one: traces end where it holds first")
      .details(
          "Counted from timepoint 0 on; docs/reference/model_language.md has the temporal "
          "operators.")
      .list(ListForm::kOneEachTime);
  return models;
}

void add_plan_options(OptionTable& command, ModelOptions& options) {
  const UnderHeading heading(command, "Plan");
  command
      .option("--plan", options.plan,
              "Plan to unroll with the models: a file (.lisp) or a folder, repeated in load order")
      .list(ListForm::kOneEachTime)
      .needs("--bind")
      .file({"lisp"});
  command.option("--bind", options.bind, "What the plan's designators mean")
      .needs("--plan")
      .file({"bind"});
  command.option("--plan-entry", options.plan_entry, "The plan's function to run, or a call of it")
      .needs("--plan");
  command.option("--regions", options.regions, "Scenario whose regions the plan's poses lie in")
      .needs("--plan")
      .file({"yaml"});
  command
      .option("--max-loop", options.unroll.max_loop,
              "Iterations of a loop that nothing static ends")
      .check(WholeNumber{1, 10'000})
      .show_default();
  command.option("--max-call-depth", options.unroll.max_call_depth, "Active calls of one function")
      .check(WholeNumber{1, 1'000})
      .show_default();
  command
      .option("--max-locations", options.unroll.max_locations,
              "Locations of the unrolled plan; steps and memory grow with them")
      .check(WholeNumber{1, 10'000'000})
      .show_default();
  command
      .option("--location-samples", options.unroll.location_samples,
              "Further solutions that `next-solution` has of a location")
      .check(WholeNumber{0, 1'000})
      .show_default();
  command
      .option("--par", options.par,
              "How branches of `par` and `pursue` are ordered: interleave or in-order")
      .details(
          "interleave: every order of their performs. in-order: one branch after another; leaves "
          "out the other orders, the rest of branches after one has failed, and of a `pursue` all "
          "but the first branch.")
      .check(OneOf{{"in-order", "interleave"}})
      .show_default();
  command
      .option("--max-horizon", options.max_horizon,
              "Without a horizon: the longest path of the plan, but at most this")
      .details("Applies without --horizon and without a range of `time` in the model.")
      .check(WholeNumber{1, 10'000})
      .show_default();
}

void add_hits_option(OptionTable& command, std::string& hits) {
  command
      .option("--hits", hits,
              "Where traces end: first (at the first hit of the constraints) or all (at each)")
      .check(OneOf{{"first", "all"}})
      .show_default();
}

void add_judging_options(OptionTable& command, JudgingOptions& options) {
  const UnderHeading heading(command, "How observations are judged");
  command
      .option("--match", options.match,
              "What states are held against: the trace, or all that the model admits")
      .check(OneOf{{"trace", "model"}});
  command
      .option("--compare", options.compare,
              "When: at every step, or in the last state only, as the criterion paper does")
      .check(one_of(harness::kComparisons));
}

void apply(const JudgingOptions& options, harness::Scenario& scenario) {
  if (!options.match.empty()) scenario.match_model = options.match == "model";
  harness::kComparisons.take(options.compare, scenario.compare);
}

void add_cubes_option(OptionTable& command, std::int64_t& jobs) {
  command
      .option("-j,--jobs", jobs,
              "Threads of the solver for hard questions, which are cut into cubes")
      .details("The answer is the same for any number; two are of use. No proof is made of it.")
      .check(WholeNumber{1, 256});
}

void add_search_options(OptionTable& command, SearchOptions& options) {
  const UnderHeading heading(command, "Which traces");
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
              "auto, search, graph, components, tree, guarded or blocking")
      .details("The traces and their order are the same, only the time differs.")
      .check(one_of(runtime::kStrategyNames))
      .show_default();
  command.option("--order", options.order, "canonical, or any: as the solver finds them")
      .details(
          "By default any where --limit 1 asks for one trace that reaches a goal, which is many "
          "times as fast.")
      .check(OneOf{{"canonical", "any"}});
  add_cubes_option(command, options.jobs);
  command
      .flag("--up-to-symmetry", options.up_to_symmetry,
            "List one trace of each orbit, and how many traces it stands for")
      .details(
          "An orbit is what exchanging constants that model, plan and goal do not tell apart makes "
          "of a trace.");
  add_hits_option(command, options.hits);
  command.flag("--split-initial", options.split_initial,
               "List every initial state, not only every sequence of events");
}

void add_listing_options(OptionTable& command, ListingOptions& options) {
  const UnderHeading heading(command, "How they are listed");
  command
      .option("--format", options.format,
              "text, jsonl, itf (Informal Trace Format), csv, or decreasoner")
      .details("text prints changes only; decreasoner prints as the 2005 reasoner does.")
      .check(OneOf{{"text", "jsonl", "itf", "csv", "decreasoner"}})
      .show_default();
  command
      .option("--output", options.output,
              "With --format itf: a new folder, one file for each trace")
      .folder();
}

void add_certify_option(OptionTable& command, CertifyOption& option) {
  command
      .flag("--certify", option.file,
            "Write and check a DRAT proof that there are no other traces; default: MODEL.drat")
      .details("The formula that the proof refutes is written beside it (FILE.cnf).")
      .named_value("[=FILE]")
      .file({"drat"});
}

void add_replay_options(OptionTable& command, ReplayTracesOptions& options) {
  const UnderHeading heading(command, "Traces that are given");
  command
      .option(
          "--replay", options.file,
          "Check the traces of this file (jsonl or itf); exit 1 if one is no trace of the model")
      .file();
  command.flag("--other-model", options.other_model,
               "Replay traces of another model that has the same names");
}

void add_command_options(OptionTable& command, CommandPermission& permission, bool named) {
  const UnderHeading heading(command, "Commands that a scenario names");
  command.flag("--allow-commands", permission.allow,
               named ? "Start the simulator's command even with --no-commands"
                     : "Start the command that a scenario names as its simulator");
  if (!named) return;
  command.flag("--no-commands", permission.refuse,
               "Do not start a command that the scenario names as its simulator");
}

base::Result<harness::SimulatorFactory> permitted_simulator(
    const ScenarioModel& loaded, bool permitted, Invocation& invocation,
    const std::shared_ptr<harness::Fleet>& fleet) {
  const auto& spec = loaded.scenario.simulator;
  harness::SimulatorFactory make;
  if (fleet) {
    // By now the scenario has loaded its modules, as it will have there.
    fleet->set_self(own_identity(loaded.scenario));
    make = [fleet, worker = fleet_worker(loaded, *fleet, invocation)] {
      return fleet->simulator(worker);
    };
  } else {
    std::vector<std::string> worker = {"/proc/self/exe", "worker"};
    if (invocation.form().allow_outside) worker.emplace_back("--allow-outside");
    make = simulator_factory(loaded, worker, stop_flag(), {"/proc/self/exe", "supervise", "--"});
  }
  if (spec.command.empty()) return make;
  const auto text = base::command_text(spec.command);
  if (loaded.kept != nullptr) {
    // The folder may be a stranger's: what it brings is read, and nothing that it names is started.
    return invocation.sink().error(
        codes::kReplayImpossible, spec.source,
        fmt::format("`{}` stands in a text that the run kept, and a command is started only as the "
                    "scenario "
                    "itself has it; restore its files, or name it with --scenario",
                    text));
  }
  if (!permitted) {
    return invocation.sink().error(codes::kCommandNotPermitted, spec.source, text);
  }
  const auto words =
      fmt::format("starting `{}`, as {} says", text, invocation.files().place(spec.source));
  // Told when it is done, which may be in a worker's thread; what is checked before may refuse it.
  return harness::SimulatorFactory(
      [make, words, &invocation, told = std::make_shared<std::once_flag>()] {
        std::call_once(*told, [&] { invocation.remark(words); });
        return make();
      });
}

harness::SimulatorFactory half_step_simulator(const ScenarioModel& loaded,
                                              const Invocation& invocation) {
  if (loaded.world != nullptr || !loaded.scenario.simulator.command.empty()) return nullptr;
  std::vector<std::string> worker = {"/proc/self/exe", "worker", "--half-step"};
  if (invocation.form().allow_outside) worker.emplace_back("--allow-outside");
  return simulator_factory(loaded, worker, stop_flag());
}

void add_recorded_scenario_option(OptionTable& command, std::string& scenario) {
  command
      .option("--scenario", scenario,
              "Of a run folder: where its scenario lies; default: as its journal says")
      .file({"yaml"});
}

base::Result<std::optional<harness::SampleId>> parse_sample_option(const std::string& text,
                                                                   base::DiagnosticSink& sink) {
  if (text.empty()) return std::optional<harness::SampleId>();
  const auto id = harness::parse_sample_id(text);
  if (id) return id;
  return sink.error_about(codes::kUsage, "",
                          fmt::format("--sample takes TRACE.SAMPLE such as 2.4, not `{}`", text));
}

std::function<void(const harness::CampaignProgress&)> progress_on_terminal(
    const CommonOptions& options) {
  if (options.quiet || isatty(STDERR_FILENO) == 0) return {};
  return [](const harness::CampaignProgress& progress) {
    const double left =
        progress.runs_per_s > 0
            ? static_cast<double>(progress.needed - progress.done) / progress.runs_per_s
            : 0.0;
    show_progress(fmt::format("trace {}: {}/{} simulations, {:.1f}/s, about {:.0f} s left",
                              progress.trace, progress.done, progress.needed, progress.runs_per_s,
                              left));
  };
}

std::optional<double> share_of(std::string text) {
  if (text.ends_with('%')) text.pop_back();
  const auto percent = base::whole_number<std::uint32_t>(text);
  constexpr std::uint32_t kAll = 100;
  if (!percent || *percent > kAll) return std::nullopt;
  return static_cast<double>(*percent) / kAll;
}

}  // namespace parallax::tools
