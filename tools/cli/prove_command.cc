#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "harness/campaign/trial.h"
#include "harness/geometry_proof/certificate.h"
#include "harness/geometry_proof/held_against_simulation.h"
#include "harness/geometry_proof/proof_assumptions.h"
#include "harness/robot/ode_simulator.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/prove_text.h"
#include "tools/cli/replaceable.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct ProveOptions {
  std::string scenario, out, check;
  std::int64_t trace = 1, action = -1;
  std::vector<std::string> assume;
  harness::ProofLimits limits;
  std::int64_t simulate = 0;
  std::uint64_t seed = 1;
};

/// The trace of the number, or nothing, which was reported.
std::optional<harness::CampaignTrace> find_trace(const ProveOptions& options,
                                                 EnumeratedTraces& traces, Invocation& invocation) {
  std::int64_t last = 0;
  while (true) {
    auto trace = traces.next();
    if (!trace) return std::nullopt;
    if (!*trace) break;
    last = (*trace)->number;
    if (last == options.trace) return std::move(**trace);
  }
  if (!invocation.stopped()) {
    invocation.sink().error_about(codes::kNoSuchTrace, options.scenario, options.trace,
                                  last == 0   ? "the scenario has none"
                                  : last == 1 ? "the scenario has only one"
                                              : fmt::format("the scenario has {}", last));
  }
  return std::nullopt;
}

std::optional<double> whole_number_text(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || end != text.c_str() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// One `--assume NAME=VALUE` or `NAME=LOW:HIGH`; a text that says what is wrong with it.
std::string assume(const std::string& given, const harness::WorldLayout& layout,
                   harness::ProofAssumptions& out) {
  const auto equals = given.find('=');
  const std::string name = given.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : given.substr(equals + 1);
  for (const auto& field : harness::assumption_fields()) {
    if (name != field.name) continue;
    const auto number = whole_number_text(value);
    const auto why = harness::wrong_assumption(number.value_or(-1.0));
    if (!why.empty()) return fmt::format("`{}` {}", value, why);
    out.*field.value = *number;
    return "";
  }
  for (std::size_t i = 0; i < layout.sliders.size(); ++i) {
    if (name != layout.sliders[layout.sliders.id_at(i)].name + ".q") continue;
    const auto colon = value.find(':');
    const auto low = whole_number_text(value.substr(0, colon));
    const auto high = colon == std::string::npos ? low : whole_number_text(value.substr(colon + 1));
    if (!low || !high || *low > *high) return fmt::format("`{}` is no range LOW:HIGH", value);
    out.sliders.emplace_back(name, harness::Bounds1{*low, *high});
    return "";
  }
  return fmt::format(
      "nothing is called `{}`; there are drift, drift-rad, sliding, sliding-rad, goal, goal-rad, "
      "parked, held, "
      "held-rad, held-height, lean, and JOINT.q of a slider",
      name);
}

/// A trace and what can be proved of it.
struct ProofTask {
  harness::CampaignTrace trace;
  harness::PreparedTrace prepared;
  harness::WorldLayout layout;
  harness::ProofAssumptions assumptions;
  std::vector<harness::ProofAction> calls;
  std::vector<harness::ProvableAction> actions;
};

std::optional<ProofTask> make_task(const ProveOptions& options, const ScenarioModel& loaded,
                                   Invocation& invocation) {
  const auto& scenario = loaded.scenario;
  auto& sink = invocation.sink();
  if (!scenario.simulator.is_built_in() || !scenario.world.mobile) {
    sink.error(codes::kNothingToProve, base::SourceRange{scenario.source, 0, 0},
               scenario.simulator.is_built_in()
                   ? "its world has no mobile robot"
                   : "what a simulator of its own does is not known as geometry");
    return std::nullopt;
  }
  const auto& model = loaded.compilation.model;
  if (!model.has_constraints) {
    sink.error(codes::kNothingToSimulate, base::SourceRange{scenario.source, 0, 0});
    return std::nullopt;
  }
  EnumeratedTraces traces(model, invocation);
  auto trace = find_trace(options, traces, invocation);
  if (!trace) return std::nullopt;
  harness::OdeSimulator simulator(scenario.world);
  const harness::ModelFluents fluents(*traces.symbols());
  auto prepared =
      harness::prepare_trace(scenario, fluents.ground(), simulator.info(), *trace, sink);
  if (!prepared) return std::nullopt;
  if (prepared->sampler.law() != nullptr) {
    sink.error(codes::kNothingToProve, scenario.sampling_source,
               "starts are drawn by a law, and proofs are about uniform ones");
    return std::nullopt;
  }
  ProofTask task{
      *std::move(trace), *std::move(prepared), harness::lay_out(scenario.world), {}, {}, {}};
  for (const auto& one : options.assume) {
    const auto fault = assume(one, task.layout, task.assumptions);
    if (fault.empty()) continue;
    sink.error_about(codes::kUsage, "--assume " + one, fault);
    return std::nullopt;
  }
  if (const auto fault = harness::wrong_assumptions(task.assumptions, task.layout);
      !fault.empty()) {
    sink.error_about(codes::kUsage, "--assume", fault);
    return std::nullopt;
  }
  for (std::size_t i = 0; i < task.prepared.calls.size(); ++i) {
    const auto& call = task.prepared.calls[i];
    task.calls.push_back({task.trace.event(i), call.controller, call.arguments});
  }
  harness::StartBox whole;
  const auto variables = harness::drawn_variables(task.prepared.start, whole);
  if (variables.size() >= harness::AffineForm::kMostVariables) {
    sink.error(codes::kNothingToProve, scenario.sampling_source,
               fmt::format("{} variables are drawn, and a proof takes at most {}", variables.size(),
                           harness::AffineForm::kMostVariables - 1));
    return std::nullopt;
  }
  // In place: what is made refers to the layout and the start.
  return task;
}

bool select_actions(const ProveOptions& options, ProofTask& task, Invocation& invocation) {
  if (options.action < 0) return true;
  std::erase_if(task.actions, [&](const auto& action) {
    return static_cast<std::int64_t>(action.number) != options.action;
  });
  if (!task.actions.empty()) return true;
  invocation.sink().error_about(
      codes::kUsage, fmt::format("--action {}", options.action),
      fmt::format("trace {} has events 0 to {}", options.trace, task.calls.size() - 1));
  return false;
}

bool is_certificate(std::string_view head) {
  return head.starts_with("{\"kind\":\"parallax geometry proof\"");
}

void report(const harness::Certificate& certificate, const ProofTask& task,
            const std::vector<harness::SimulatedTest>& simulated, Invocation& invocation) {
  if (invocation.options().json) {
    return invocation.document(proof_json(certificate, simulated));
  }
  invocation.result(proof_text(certificate, task.trace.events(), simulated));
}

/// True where a simulation contradicts, which is reported.
bool is_contradicted(const ProveOptions& options,
                     const std::vector<harness::SimulatedTest>& simulated, Invocation& invocation) {
  for (const auto& test : simulated) {
    if (test.contradictions.empty()) continue;
    invocation.sink().error_about(codes::kProofContradicted, options.scenario,
                                  test.contradictions.size());
    return true;
  }
  return false;
}

int run_proof(const ProveOptions& options, const ScenarioModel& loaded, Invocation& invocation) {
  auto task = make_task(options, loaded, invocation);
  if (!task) return 0;
  const auto& scenario = loaded.scenario;
  if (!options.out.empty() &&
      !check_replaceable(options.out, is_certificate, invocation.files(), invocation.sink())) {
    return 0;
  }
  task->actions = harness::provable_actions(scenario.world, task->layout, task->prepared.start,
                                            task->calls, task->assumptions);
  if (!select_actions(options, *task, invocation)) return 0;
  harness::Certificate certificate;
  certificate.scenario = scenario.name;
  certificate.scenario_hash = loaded.sources_hash;
  certificate.trace = task->trace.number;
  certificate.variables = harness::drawn_variables(task->prepared.start, certificate.region);
  certificate.assumptions = task->assumptions;
  auto limits = options.limits;
  limits.stop = &stop_flag();
  const bool shows = progress_on_terminal(invocation.options()) != nullptr;
  if (shows) {
    limits.progress = [](std::int64_t boxes, double open) {
      show_progress(fmt::format("{} boxes, {:.2f} % open", boxes, 100.0 * open));
    };
  }
  certificate.actions = harness::certify(task->actions, limits);
  certificate.stopped = stop_flag().load();
  if (shows) clear_progress();
  std::vector<harness::SimulatedTest> simulated;
  if (options.simulate > 0) {
    simulated = harness::simulate_tests(scenario.world, task->layout, task->prepared.sampler,
                                        options.seed, options.simulate, task->calls, task->actions,
                                        certificate.actions, &stop_flag());
  }
  if (!options.out.empty() &&
      !base::write_output(options.out, harness::certificate_json(certificate), invocation.files(),
                          invocation.sink())) {
    return 0;
  }
  report(certificate, *task, simulated, invocation);
  bool refuted = false, open = false, any = false;
  for (const auto& action : certificate.actions) {
    for (const auto& test : action.tests) {
      any = true;
      refuted = refuted || test.refuted > 0.0;
      open = open || test.open > 0.0;
    }
  }
  if (is_contradicted(options, simulated, invocation)) return 0;
  if (certificate.stopped || !any) return 4;
  return refuted ? 1 : open ? 4 : 0;
}

int check_proof(const ProveOptions& options, const ScenarioModel& loaded, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto text = base::read_file(options.check, sink);
  if (!text) return 0;
  harness::Certificate certificate;
  const auto misfit = [&](const std::string& why) {
    sink.error_about(codes::kForeignCertificate, options.check, why);
    return 0;
  };
  if (const auto fault = harness::read_certificate(*text, certificate)) return misfit(*fault);
  ProveOptions own = options;
  own.trace = certificate.trace;
  auto task = make_task(own, loaded, invocation);
  if (!task) return 0;
  if (!options.assume.empty() && certificate.assumptions != task->assumptions) {
    return misfit("it has other assumptions than --assume; without --assume they are printed");
  }
  auto result = harness::check_certificate(
      certificate, {loaded.scenario.world, task->layout, task->prepared.start, task->calls},
      &stop_flag());
  if (!result.mismatch.empty()) return misfit(result.mismatch);
  if (certificate.scenario_hash != loaded.sources_hash) {
    sink.error_about(codes::kCertificateOfOtherTexts, options.check, certificate.scenario_hash,
                     loaded.sources_hash);
  }
  std::vector<harness::SimulatedTest> simulated;
  if (options.simulate > 0) {
    simulated = harness::simulate_tests(loaded.scenario.world, task->layout, task->prepared.sampler,
                                        options.seed, options.simulate, task->calls, result.actions,
                                        certificate.actions, &stop_flag());
  }
  if (invocation.options().json) {
    invocation.document(check_json(certificate, result, simulated));
  } else {
    invocation.result(check_text(certificate, result, simulated));
  }
  if (result.wrong == 0 && is_contradicted(options, simulated, invocation)) return 0;
  if (result.wrong > 0) return 1;
  return result.is_confirmed() && !stop_flag().load() ? 0 : 4;
}

int run_prove(const ProveOptions& options, Invocation& invocation) {
  auto loaded = load_scenario_model(options.scenario, invocation);
  if (!loaded) return 0;
  return options.check.empty() ? run_proof(options, *loaded, invocation)
                               : check_proof(options, *loaded, invocation);
}

}  // namespace

Command prove_command() {
  auto options = std::make_shared<ProveOptions>();
  OptionTable command(
      "prove",
      "For which starts does what is pure geometry in a trace succeed? Proved, box by box");
  command.footer(
      "Examples:\n"
      "  parallax prove scenarios/kitchen/plan3.yaml --trace 1\n"
      "  parallax prove scenarios/kitchen/plan2.yaml --trace 2 --assume dMid.q=0.448:0.451 \\\n"
      "    --simulate 100\n"
      "  parallax prove scenarios/kitchen/plan2.yaml --trace 2 --out plan2.proof.json\n"
      "  parallax prove scenarios/kitchen/plan2.yaml --check plan2.proof.json\n"
      "What is proved of an action holds where the actions before it succeed and leave things as\n"
      "`given` says; --simulate counts how often they do. What is open is left to simulation.\n"
      "--check believes nothing of the file: it prints what is confirmed under which assumptions.\n"
      "Exit codes: 0 every test passes everywhere (--check: something is confirmed, and all that "
      "is\n"
      "said), 1 refuted somewhere (--check: wrong), 4 some of it open, or nothing to prove.");
  command.option("scenario", options->scenario, "Scenario file (YAML)").required().file({"yaml"});
  command.heading("What is proved");
  command.option("--trace", options->trace, "Which trace")
      .check(WholeNumber{1, 1'000'000})
      .show_default();
  command.option("--action", options->action, "Only this event of the trace, from 0; default: all")
      .check(WholeNumber{0, 1'000'000});
  command
      .option("--assume", options->assume,
              "NAME=VALUE: a bound that the proof assumes before an action (docs/prove.md)")
      .details(
          "Names: drift, drift-rad, sliding, sliding-rad, goal, goal-rad, parked, held, held-rad, "
          "held-height, lean [m, rad], or JOINT.q=LOW:HIGH.")
      .list(ListForm::kOneEachTime);
  command.heading("How far");
  command.option("--boxes", options->limits.boxes, "Boxes examined for each test, at most")
      .check(WholeNumber{1, 100'000'000})
      .show_default();
  command
      .option("--open", options->limits.open_share,
              "Share of the start region that need not be decided")
      .check(FiniteNumber{0.0, 1.0})
      .show_default();
  command.heading("Certificate");
  command.option("-o,--out", options->out, "Write the certificate, with every box, to this file")
      .file();
  command
      .option("--check", options->check,
              "Confirm every box of a certificate by the second evaluation alone")
      .file();
  command.heading("Comparison with simulations");
  command
      .option("--simulate", options->simulate,
              "Also simulate so many starts, and compare with the verdicts of their boxes")
      .check(WholeNumber{0, 1'000'000});
  command.option("--seed", options->seed, "Seed of these starts")
      .check(WholeNumber{0, kMaxSeed})
      .show_default();
  return {std::move(command),
          [options](Invocation& invocation) { return run_prove(*options, invocation); }};
}

}  // namespace parallax::tools
