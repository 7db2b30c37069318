#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "harness/geometry_proof/certificate.h"
#include "harness/geometry_proof/held_against_simulation.h"
#include "tools/app/scenario_model.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/proof_task.h"
#include "tools/cli/prove_text.h"
#include "tools/cli/replaceable.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct ProveOptions {
  std::string scenario, out, check;
  std::int64_t trace = 1, state = 0, action = -1;
  std::vector<std::string> assume;
  harness::SubdivisionLimits limits;
  std::int64_t simulate = 0;
  std::uint64_t seed = 1;
};

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

/// The certificate of an initial state, where there are several: "a.proof.json" becomes
/// "a.2.proof.json".
std::string file_of_state(const std::string& out, std::int64_t state) {
  constexpr std::string_view kEnding = ".proof.json";
  const auto slash = out.rfind('/');
  auto at = out.ends_with(kEnding) ? out.size() - kEnding.size() : out.rfind('.');
  const bool has_ending = at != std::string::npos && (slash == std::string::npos || at > slash + 1);
  if (!has_ending) at = out.size();
  return fmt::format("{}.{}{}", out.substr(0, at), state, out.substr(at));
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

std::vector<harness::SimulatedTest> simulated_tests(
    const ProveOptions& options, const ScenarioModel& loaded, const ProofTask& task,
    const std::vector<harness::ProvableAction>& actions,
    const harness::GeometryCertificate& certificate) {
  if (options.simulate <= 0) return {};
  return harness::simulate_tests(loaded.scenario.world, task.layout, task.plan->sampler,
                                 options.seed, options.simulate, task.calls, actions,
                                 certificate.actions, &stop_flag());
}

/// Proves the trace from one of its initial states. None: stopped, or it was reported.
std::optional<ProvedState> prove_state(const ProveOptions& options, const ScenarioModel& loaded,
                                       ProofTrace& trace, std::int64_t state,
                                       Invocation& invocation) {
  auto task = trace.task(state, options.assume);
  if (!task) return std::nullopt;
  task->actions = harness::provable_actions(loaded.scenario.world, task->layout, task->start(),
                                            task->calls, task->assumptions);
  if (!select_actions(options, *task, invocation)) return std::nullopt;
  ProvedState out;
  auto& certificate = out.certificate;
  certificate.scenario = loaded.scenario.name;
  certificate.scenario_hash = loaded.sources_hash;
  certificate.trace = options.trace;
  certificate.initial_state = task->state();
  certificate.holds = task->holds;
  certificate.variables = harness::drawn_variables(task->start(), certificate.region);
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
  out.simulated = simulated_tests(options, loaded, *task, task->actions, certificate);
  return out;
}

/// The initial states to prove. None: stopped, or it was reported.
std::optional<std::vector<std::int64_t>> asked_states(const ProveOptions& options,
                                                      ProofTrace& trace, Invocation& invocation) {
  auto states = trace.states();
  if (!states || options.state == 0) return states;
  const bool only = trace.is_single() && options.state == 1;
  if (only) return states;
  if (!trace.has(options.state)) {
    const auto all = trace.about().all;
    invocation.sink().error_about(
        codes::kUsage, fmt::format("--state {}", options.state),
        trace.is_single() ? fmt::format("trace {} has one initial state", options.trace)
        : all             ? fmt::format("trace {} has {} initial states", options.trace, *all)
                          : fmt::format("{} of its initial states were drawn", states->size()));
    return std::nullopt;
  }
  return std::vector<std::int64_t>{options.state};
}

int run_proof(const ProveOptions& options, const ScenarioModel& loaded, Invocation& invocation) {
  const auto trace = ProofTrace::find(loaded, options.trace, invocation);
  if (!trace) return 0;
  const auto states = asked_states(options, *trace, invocation);
  if (!states) return 0;
  const bool one_file = trace->is_single() || options.state > 0;
  const auto file = [&](std::int64_t state) {
    return one_file ? options.out : file_of_state(options.out, state);
  };
  for (const auto state : *states) {
    if (!options.out.empty() &&
        !check_replaceable(file(state), is_certificate, invocation.files(), invocation.sink())) {
      return 0;
    }
  }
  Proved proved{options.trace, trace->events(), trace->about(), options.state > 0, {}};
  bool refuted = false, open = false, any = false, stopped = false, contradicted = false;
  for (const auto state : *states) {
    auto one = prove_state(options, loaded, *trace, state, invocation);
    if (!one && !stop_flag().load()) return 0;
    if (!one) {
      stopped = true;
      break;
    }
    const auto& certificate = one->certificate;
    if (!options.out.empty() &&
        !base::write_output(file(state), harness::certificate_json(certificate), invocation.files(),
                            invocation.sink())) {
      return 0;
    }
    for (const auto& action : certificate.actions) {
      for (const auto& test : action.tests) {
        any = true;
        refuted = refuted || test.refuted > 0.0;
        open = open || test.open > 0.0;
      }
    }
    stopped = certificate.stopped;
    contradicted = is_contradicted(options, one->simulated, invocation);
    proved.states.push_back(*std::move(one));
    if (stopped || contradicted) break;
  }
  invocation.options().json ? invocation.document(proof_json(proved))
                            : invocation.result(proof_text(proved));
  if (contradicted) return 0;
  if (stopped || !any) return 4;
  // A state that no start realises was not looked at either.
  const bool is_whole =
      proved.are_all() && (options.state > 0 || proved.about.unrealisable.empty());
  return refuted ? 1 : open || !is_whole ? 4 : 0;
}

int check_proof(const ProveOptions& options, const ScenarioModel& loaded, Invocation& invocation) {
  auto& sink = invocation.sink();
  const auto text = base::read_file(options.check, sink);
  if (!text) return 0;
  harness::GeometryCertificate certificate;
  const auto misfit = [&](const std::string& why) {
    sink.error_about(codes::kForeignCertificate, options.check, why);
    return 0;
  };
  if (const auto fault = harness::read_certificate(*text, certificate)) return misfit(*fault);
  const auto trace = ProofTrace::find(loaded, certificate.trace, invocation);
  if (!trace || !trace->states()) return 0;
  // One that names no initial state is about the first.
  if (certificate.initial_state == 0 && !trace->is_single()) {
    certificate.initial_state = 1;
    certificate.holds = trace->text(1);
  }
  if (!trace->has(certificate.initial_state) ||
      (!trace->is_single() && trace->text(certificate.initial_state) != certificate.holds)) {
    return misfit("its initial state is none of the scenario's trace");
  }
  auto task = trace->task(certificate.initial_state, options.assume);
  if (!task) return 0;
  if (!options.assume.empty() && certificate.assumptions != task->assumptions) {
    return misfit("it has other assumptions than --assume; without --assume they are printed");
  }
  auto result = harness::check_certificate(
      certificate, {loaded.scenario.world, task->layout, task->start(), task->calls}, &stop_flag());
  if (!result.mismatch.empty()) return misfit(result.mismatch);
  if (certificate.scenario_hash != loaded.sources_hash) {
    sink.error_about(codes::kCertificateOfOtherTexts, options.check, certificate.scenario_hash,
                     loaded.sources_hash);
  }
  const auto simulated = simulated_tests(options, loaded, *task, result.actions, certificate);
  const auto about = trace->about();
  if (invocation.options().json) {
    invocation.document(check_json(certificate, about, result, simulated));
  } else {
    invocation.result(check_text(certificate, about, result, simulated));
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
      "  parallax prove scenarios/kitchen/plan2.yaml --check plan2.1.proof.json\n"
      "What is proved of an action holds where the actions before it succeed and leave things as\n"
      "`given` says; --simulate counts how often they do. What is open is left to simulation.\n"
      "--check believes nothing of the file: it prints what is confirmed under which assumptions.\n"
      "Exit codes: 0 every test passes everywhere (--check: something is confirmed, and all that "
      "is\n"
      "said), 1 refuted somewhere (--check: wrong), 4 some of it open, or nothing to prove.\n"
      "A trace with several initial states is proved from each of the first 64; --out writes a\n"
      "file for each (NAME.1.proof.json).");
  command.option("scenario", options->scenario, "Scenario file (YAML)").required().file({"yaml"});
  command.heading("What is proved");
  command.option("--trace", options->trace, "Which trace")
      .check(WholeNumber{1, 1'000'000})
      .show_default();
  command
      .option("--state", options->state,
              "Only this initial state of the trace, from 1, by its number in the output")
      .check(WholeNumber{1, 1'000'000});
  command.option("--action", options->action, "Only this event of the trace, from 0; default: all")
      .check(WholeNumber{0, 1'000'000});
  command
      .option("--assume", options->assume,
              "NAME=VALUE: a bound that the proof assumes before an action (docs/guide/rare.md)")
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
              "Also simulate so many starts of each initial state, and compare with their boxes")
      .check(WholeNumber{0, 1'000'000});
  command.option("--seed", options->seed, "Seed of these starts")
      .check(WholeNumber{0, kMaxSeed})
      .show_default();
  return command_of(std::move(command), options, run_prove);
}

}  // namespace parallax::tools
