#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "harness/campaign/trial.h"
#include "harness/geometry_proof/certificate.h"
#include "harness/geometry_proof/held_against_simulation.h"
#include "harness/robot/ode_simulator.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_feed.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
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
  const std::pair<const char*, double*> known[] = {
      {"drift", &out.drift_m},     {"drift-rad", &out.drift_rad},
      {"sliding", &out.sliding_m}, {"sliding-rad", &out.sliding_rad},
      {"goal", &out.goal_m},       {"goal-rad", &out.goal_rad},
      {"parked", &out.parked_m},   {"held", &out.held_m},
      {"held-rad", &out.held_rad}, {"held-height", &out.held_height_m},
      {"lean", &out.lean_rad}};
  for (const auto& [key, target] : known) {
    if (name != key) continue;
    const auto number = whole_number_text(value);
    if (!number || *number < 0.0 || *number > 10.0) {
      return fmt::format("`{}` is no number from 0 to 10", value);
    }
    *target = *number;
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

std::string percent(double share) { return fmt::format("{:6.2f} %", 100.0 * share); }

/// How many boxes have the verdict, and what is met in most of them.
std::string boxes_text(const harness::TestCertificate& test, harness::BoxVerdict verdict) {
  std::map<std::string, double> culprits;
  std::int64_t boxes = 0;
  for (const auto& box : test.boxes) {
    if (box.verdict != verdict) continue;
    ++boxes;
    double volume = 1.0;
    for (const auto& one : box.bounds) volume *= one.upper - one.lower;
    if (!box.culprit.empty()) culprits[box.culprit] += volume;
  }
  std::string text = fmt::format("{} box{}", boxes, boxes == 1 ? "" : "es");
  const auto most =
      std::max_element(culprits.begin(), culprits.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (most != culprits.end()) text += "; mostly " + most->first;
  return text;
}

std::string simulated_text(const harness::SimulatedTest& test) {
  std::string text;
  for (const auto verdict :
       {harness::BoxVerdict::kSafe, harness::BoxVerdict::kRefuted, harness::BoxVerdict::kOpen}) {
    const auto& count = test.by_verdict[static_cast<std::size_t>(verdict)];
    text += fmt::format("{}{} of {} {}", text.empty() ? "" : ", ", count.refused, count.starts,
                        to_string(verdict));
  }
  std::string out = fmt::format("      simulated  refused: {}\n", text);
  if (test.not_as_assumed > 0) {
    std::string why;
    for (const auto& [what, count] : test.broken) {
      why += fmt::format("{}{} ({})", why.empty() ? "" : ", ", what, count);
    }
    out += fmt::format("                 {} not as assumed, and not counted: {}\n",
                       test.not_as_assumed, why);
  }
  return out;
}

nlohmann::ordered_json simulated_json(const harness::SimulatedTest& test) {
  nlohmann::ordered_json out;
  for (const auto verdict :
       {harness::BoxVerdict::kSafe, harness::BoxVerdict::kRefuted, harness::BoxVerdict::kOpen}) {
    const auto& count = test.by_verdict[static_cast<std::size_t>(verdict)];
    out[std::string(to_string(verdict))] = {{"starts", count.starts}, {"refused", count.refused}};
  }
  out["not_as_assumed"] = test.not_as_assumed;
  out["broken"] = test.broken;
  return out;
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

std::vector<std::string> variables_of(const harness::StartCuboid& start, harness::StartBox& box) {
  std::vector<std::string> names;
  for (const auto& [name, interval] : start.dimensions) {
    if (!(interval.lower < interval.upper)) continue;
    names.push_back(name);
    box.push_back({interval.lower, interval.upper});
  }
  return names;
}

std::optional<ProofTask> make_task(const ProveOptions& options, const ScenarioModel& loaded,
                                   const harness::Certificate* given, Invocation& invocation) {
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
  if (given != nullptr) task.assumptions = given->assumptions;
  for (std::size_t i = 0; i < task.prepared.calls.size(); ++i) {
    const auto& call = task.prepared.calls[i];
    task.calls.push_back({task.trace.event(i), call.controller, call.arguments});
  }
  harness::StartBox whole;
  const auto variables = variables_of(task.prepared.start, whole);
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
    auto document = base::parse_ordered_json(harness::certificate_json(certificate));
    for (auto& action : document["actions"]) {
      for (auto& test : action["tests"]) test.erase("boxes");  // those are for --out
    }
    if (!simulated.empty()) {
      auto& all = document["simulated"] = nlohmann::ordered_json::array();
      for (const auto& test : simulated) all.push_back(simulated_json(test));
    }
    return invocation.document(base::json_text(document) + "\n");
  }
  std::string text = fmt::format("trace {}: {}\n", certificate.trace, task.trace.events());
  std::size_t index = 0;
  for (const auto& action : certificate.actions) {
    text += fmt::format("  {:>2}  {}\n", action.number, action.event);
    if (!action.left_to_simulation.empty()) {
      text += fmt::format("      left to simulation: {}\n", action.left_to_simulation);
    }
    for (const auto& test : action.tests) {
      text += fmt::format("      {} ({}): {}\n", test.test.function, test.test.source,
                          test.test.statement);
      using harness::BoxVerdict;
      text += fmt::format("      safe     {}  {}\n", percent(test.safe),
                          boxes_text(test, BoxVerdict::kSafe));
      text += fmt::format("      refuted  {}  {}\n", percent(test.refuted),
                          boxes_text(test, BoxVerdict::kRefuted));
      text += fmt::format("      open     {}  {}\n", percent(test.open),
                          boxes_text(test, BoxVerdict::kOpen));
      for (const auto& what : test.assumed) text += "      given      " + what + "\n";
      if (index < simulated.size()) text += simulated_text(simulated[index]);
      ++index;
    }
  }
  invocation.result(text);
}

/// Of the certificate, what stands beside the actions that have tests to be asked about; the others
/// are dropped.
std::vector<harness::ActionCertificate> beside(std::vector<harness::ProvableAction>& actions,
                                               const harness::Certificate& certificate) {
  std::vector<harness::ActionCertificate> out;
  std::erase_if(actions, [&](const auto& action) {
    const auto claimed = std::find_if(certificate.actions.begin(), certificate.actions.end(),
                                      [&](const auto& one) { return one.number == action.number; });
    if (action.tests.empty() || claimed == certificate.actions.end() ||
        claimed->tests.size() != action.tests.size()) {
      return true;
    }
    out.push_back(*claimed);
    return false;
  });
  return out;
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
  auto task = make_task(options, loaded, nullptr, invocation);
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
  certificate.variables = variables_of(task->prepared.start, certificate.region);
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
  auto task = make_task(own, loaded, &certificate, invocation);
  if (!task) return 0;
  harness::StartBox region;
  const auto variables = variables_of(task->prepared.start, region);
  bool same = variables == certificate.variables && region.size() == certificate.region.size();
  for (std::size_t i = 0; same && i < region.size(); ++i) {
    same = region[i].lower == certificate.region[i].lower &&
           region[i].upper == certificate.region[i].upper;
  }
  if (!same) return misfit("its start region is not that of the scenario's trace");
  task->actions = harness::provable_actions(loaded.scenario.world, task->layout,
                                            task->prepared.start, task->calls, task->assumptions);
  const auto result = harness::check_certificate(certificate, task->actions, &stop_flag());
  if (!result.mismatch.empty()) return misfit(result.mismatch);
  std::vector<harness::SimulatedTest> simulated;
  if (options.simulate > 0) {
    const auto proved = beside(task->actions, certificate);
    simulated = harness::simulate_tests(loaded.scenario.world, task->layout, task->prepared.sampler,
                                        options.seed, options.simulate, task->calls, task->actions,
                                        proved, &stop_flag());
  }
  if (invocation.options().json) {
    nlohmann::ordered_json document = {{"status", result.wrong > 0         ? "wrong"
                                                  : result.unconfirmed > 0 ? "unconfirmed"
                                                                           : "ok"},
                                       {"confirmed", result.confirmed},
                                       {"unconfirmed", result.unconfirmed},
                                       {"wrong", result.wrong}};
    for (const auto& test : simulated) document["simulated"].push_back(simulated_json(test));
    invocation.document(base::json_text(document) + "\n");
  } else {
    auto told = fmt::format("{} boxes confirmed, {} not confirmed, {} wrong\n", result.confirmed,
                            result.unconfirmed, result.wrong);
    for (const auto& test : simulated) told += simulated_text(test);
    invocation.result(told);
  }
  if (result.wrong == 0 && is_contradicted(options, simulated, invocation)) return 0;
  return result.wrong > 0 ? 1 : result.unconfirmed > 0 || stop_flag().load() ? 4 : 0;
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
      "Exit codes: 0 every test passes everywhere (--check: all confirmed), 1 refuted somewhere\n"
      "(--check: wrong), 4 some of it open, or nothing to prove.");
  command.option("scenario", options->scenario, "Scenario file (YAML)").required().file({"yaml"});
  command.heading("What is proved");
  command.option("--trace", options->trace, "Which trace")
      .check(WholeNumber{1, 1'000'000})
      .show_default();
  command.option("--action", options->action, "Only this event of the trace, from 0; default: all")
      .check(WholeNumber{0, 1'000'000});
  command
      .option("--assume", options->assume,
              "NAME=VALUE, what is taken for granted before an action: drift, drift-rad, sliding, "
              "sliding-rad, goal, goal-rad, parked, held, held-rad, held-height, lean [m, rad], or "
              "JOINT.q=LOW:HIGH")
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
