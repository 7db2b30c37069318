#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/codes/files.h"
#include "compiler/base/ground_name.h"
#include "compiler/base/json.h"
#include "compiler/base/temporary_folder.h"
#include "compiler/base/words.h"
#include "compiler/reference/temporal_truth.h"
#include "harness/config/ledger.h"
#include "harness/report/text_layout.h"
#include "runtime/cubes/cube_solver.h"
#include "runtime/enumerate/open_atom_finder.h"
#include "runtime/enumerate/plan_ends.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "tools/app/certify.h"
#include "tools/app/plan_inputs.h"
#include "tools/app/property_check.h"
#include "tools/app/rests_on.h"
#include "tools/app/scenario_model.h"
#include "tools/app/trace_check.h"
#include "tools/app/trace_feed.h"
#include "tools/app/trace_writer.h"
#include "tools/app/unbounded.h"
#include "tools/cli/command.h"
#include "tools/cli/limits.h"
#include "tools/cli/shared_options.h"

namespace parallax::tools {
namespace {

struct VerifyOptions {
  ModelOptions model;
  std::string property;
  CertifyOption certify;
  bool check = false;
  bool unbounded = false;
  std::int64_t jobs = 0;
  std::string ledger;
};

/// The answer, before it is printed.
struct CheckedProperty {
  std::optional<runtime::Trace> violation;
  /// Atoms that the violation leaves open; none: not asked for, or too hard to tell. Then nothing
  /// is claimed of any that might be open.
  std::optional<runtime::OpenAtoms> open;
  runtime::Exploration exploration = runtime::Exploration::kStopped;
  std::vector<std::string> bounds;
  /// It holds, but promises something for the end, and some executions do not end by the horizon.
  bool is_open_ended = false;
  bool cut = false;                             // some execution comes to where unrolling was cut
  std::optional<compiler::Timepoint> dead_end;  // length of a violating prefix that cannot go on
  bool by_symmetry = false;       // the search for violations covered representatives only
  bool by_cubes = false;          // it was searched by cubes, without a log
  std::string proof;              // "proof checked"; empty where there is nothing to prove
  PlanReservations reservations;  // why nothing was proved
  /// The plan's inputs on the way there (plan_inputs).
  std::vector<std::string> inputs;
  std::string proof_origin;                        // what made it, if it was accepted
  std::string proof_file;                          // where it is kept
  std::optional<std::vector<RestsOn>> rests_on;    // none: no ledger was named
  std::optional<PropertyBreak> broken;             // of a temporal property
  std::optional<runtime::InductionAnswer> beyond;  // --unbounded, where it holds up to the horizon
  std::vector<std::string> beyond_files;           // the kept proofs of the induction
};

/// Limit on conflicts for a proof of the contradiction where symmetry or cubes may do without one.
constexpr std::int64_t kProvable = 20'000;

CheckedProperty ask(const compiler::CompiledModel& model,
                    std::unique_ptr<runtime::SatSolver> solver, runtime::Loading loading,
                    const runtime::ModelSymmetry* symmetry) {
  runtime::SolverSession session(model, std::move(solver), loading);
  runtime::PlanEnumerator enumerator(session,
                                     {.order = runtime::TraceOrder::kAny, .symmetry = symmetry});
  CheckedProperty answer;
  answer.violation = enumerator.next();
  answer.exploration = enumerator.exploration();
  answer.bounds = open_end_texts(model, enumerator.open_ends());
  answer.cut = !enumerator.open_ends().cuts.empty();
  answer.dead_end = enumerator.dead_end();
  answer.by_symmetry = enumerator.by_symmetry();
  return answer;
}

/// Makes a proof where one is asked for or comes at little cost. Where it takes long, does without
/// it if constants are interchangeable or there are jobs for cubes.
CheckedProperty ask(const compiler::CompiledModel& model, TraceCertifier& certifier, bool insists,
                    std::int64_t jobs) {
  std::optional<runtime::ModelSymmetry> symmetry;
  if (!insists) symmetry.emplace(model, runtime::SymmetryEffort::kQuick);
  if (!symmetry || (symmetry->empty() && jobs == 0)) {
    return ask(model, certifier.solver(), certifier.loading(), nullptr);
  }
  auto answer = ask(model, runtime::make_limited_solver(certifier.solver(), kProvable),
                    certifier.loading(), nullptr);
  const bool decided = answer.violation || answer.exploration != runtime::Exploration::kStopped;
  if (decided || stop_flag().load()) return answer;
  symmetry.emplace(model);
  answer = ask(model, runtime::make_solver_for_jobs(jobs, &stop_flag()),
               runtime::Loading::kAsNeeded, &*symmetry);
  answer.by_cubes = jobs > 0;
  return answer;
}

/// The proof is made and checked in any case, and kept if that was asked for.
CertifyOption proof_option(const VerifyOptions& options, const base::TemporaryFolder& folder) {
  auto certify = options.certify;
  if (certify.file.empty()) {
    certify.keep = false;
    certify.file = (folder.path() / "verify.drat").string();
  }
  return certify;
}

/// Has the proof that there is no violation made and checked.
void prove(const CertifyOption& certify, TraceCertifier& certifier, CheckedProperty& answer) {
  certifier.conclude(std::string(runtime::to_string(answer.exploration)), true);
  answer.proof = certifier.verdict();
  answer.proof_origin = certifier.origin();
  if (certify.keep && answer.proof == "proof checked") answer.proof_file = certifier.proof_file();
}

std::string verdict(const CheckedProperty& answer) {
  if (answer.violation) return "violated";
  if (answer.beyond && answer.beyond->verdict != runtime::InductionVerdict::kHolds) {
    return "inconclusive";
  }
  return answer.exploration == runtime::Exploration::kStopped ? "inconclusive" : "holds";
}

/// An event at t: where in the plan it was performed, and how it went.
struct PerformedStep {
  std::string event;
  std::string place;    // empty for an event that no plan performs
  std::string outcome;  // "succeeded", "failed: CLASS"; empty without a plan
};

std::vector<PerformedStep> steps_at(const compiler::CompiledModel& model,
                                    const runtime::Trace& trace, std::size_t t) {
  const auto& point = trace.points[t];
  std::vector<PerformedStep> out;
  for (const auto event : trace.happens(t)) {
    PerformedStep step{std::string(event), {}, {}};
    if (point.plan_step) {
      const auto& performed = model.plan[*point.plan_step];
      const auto symbol = base::symbol_of(performed.event);
      // Other events of the timepoint are the model's own.
      if (event.starts_with(symbol + '(')) {
        step.place = place_text(performed.place);
        step.outcome = point.succeeded ? "succeeded" : "failed: " + performed.failure_class;
      }
    }
    out.push_back(std::move(step));
  }
  return out;
}

std::string trace_text(const compiler::CompiledModel& model, const runtime::Trace& trace,
                       const std::vector<std::string>& inputs) {
  auto out = runtime::to_text(trace);
  if (!inputs.empty()) out += "where, of what the plan asks for,\n";
  for (const auto& atom : inputs) out += "  " + atom + '\n';
  out += "performed\n";
  for (std::size_t t = 0; t + 1 < trace.points.size(); ++t) {
    for (const auto& step : steps_at(model, trace, t)) {
      out += fmt::format("  {} {}", t, step.event);
      if (!step.place.empty()) out += fmt::format(" at {}, {}", step.place, step.outcome);
      out += '\n';
    }
  }
  return out;
}

/// The answer of --unbounded.
std::string beyond_text(const runtime::InductionAnswer& beyond) {
  switch (beyond.verdict) {
    case runtime::InductionVerdict::kHolds:
      return fmt::format("holds at every timepoint (induction over {}, {}, proof checked)\n",
                         base::counted(beyond.steps, "step"),
                         base::counted(static_cast<std::int64_t>(beyond.invariants), "invariant"));
    case runtime::InductionVerdict::kBroken:
      return fmt::format(
          "not decided beyond: a trace that ends at timepoint {} violates the property\n",
          *beyond.broken_at);
    case runtime::InductionVerdict::kUndecided:
      return fmt::format("not decided beyond: induction over {} does not show it\n",
                         base::counted(beyond.steps, "step"));
    case runtime::InductionVerdict::kNotProved:
      return "not decided beyond: the proof was not accepted\n";
    case runtime::InductionVerdict::kStopped:
      break;
  }
  return "not decided beyond: stopped before the end\n";
}

/// The same as a member of the document.
nlohmann::ordered_json beyond_json(const CheckedProperty& answer) {
  const auto& beyond = *answer.beyond;
  const bool holds = beyond.verdict == runtime::InductionVerdict::kHolds;
  nlohmann::ordered_json out;
  out["holds"] = holds;
  out["steps"] = beyond.steps;
  out["invariants"] = beyond.invariants;
  if (holds) out["proof"] = "checked";
  if (beyond.broken_at) out["broken_at"] = *beyond.broken_at;
  if (!answer.beyond_files.empty()) out["proof_files"] = answer.beyond_files;
  return out;
}

std::string answer_text(const compiler::CompiledModel& model, const CheckedProperty& answer) {
  if (answer.violation) {
    auto out = fmt::format("violated at timepoint {}\n", answer.violation->length());
    if (answer.broken) {
      const auto& broken = *answer.broken;
      out += harness::wrapped("", fmt::format("`{}` {}", broken.formula, broken.text), 2);
    }
    return out + trace_text(model, *answer.violation, answer.inputs);
  }
  if (answer.exploration == runtime::Exploration::kStopped) {
    return "stopped before the end: nothing is known\n";
  }
  auto out = fmt::format("holds up to horizon {}", model.horizon);
  if (!answer.proof.empty()) out += fmt::format(" ({})", answer.proof);
  if (answer.exploration == runtime::Exploration::kAllTracesExplored && !model.plan.empty() &&
      !answer.reservations.any()) {
    out += ", and every path of the plan has ended by then";
  }
  if (answer.is_open_ended) out += ", of executions that end by then: others go on";
  out += '\n';
  return answer.beyond ? out + beyond_text(*answer.beyond) : out;
}

/// The known discrepancies that the answer rests on.
std::string rests_on_text(const CheckedProperty& answer) {
  if (!answer.rests_on || verdict(answer) == "inconclusive") return {};
  if (answer.rests_on->empty()) {
    return answer.violation ? "the trace goes through no discrepancy that is open or accepted\n"
                            : "it rests on no discrepancy that is open or accepted\n";
  }
  std::string out = answer.violation
                        ? "the trace goes through known discrepancies, and the world does not "
                          "follow the model behind them\n"
                        : "it rests on executions through known discrepancies, behind which the "
                          "world does not follow the model\n";
  for (const auto& one : *answer.rests_on) out += harness::wrapped("  ", rests_on_words(one), 4);
  return out;
}

std::string answer_json(const compiler::CompiledModel& model, const CheckedProperty& answer,
                        double wall_s) {
  nlohmann::ordered_json out;
  out["status"] = "ok";
  out["verdict"] = verdict(answer);
  out["horizon"] = model.horizon;
  out["exploration"] = runtime::to_string(answer.exploration);
  if (!answer.bounds.empty()) out["bounds"] = answer.bounds;
  if (answer.is_open_ended) out["open_ended"] = true;
  if (answer.dead_end) out["dead_end"] = *answer.dead_end;
  if (answer.violation) {
    out["timepoint"] = answer.violation->length();
    if (answer.broken) {
      out["broken"] = {{"formula", answer.broken->formula},
                       {"timepoint", answer.broken->at},
                       {"words", answer.broken->text}};
    }
    auto performed = nlohmann::ordered_json::array();
    for (std::size_t t = 0; t + 1 < answer.violation->points.size(); ++t) {
      for (const auto& step : steps_at(model, *answer.violation, t)) {
        performed.push_back({{"time", t}, {"event", step.event}});
        if (step.place.empty()) continue;
        performed.back()["place"] = step.place;
        performed.back()["outcome"] = step.outcome;
      }
    }
    out["performed"] = std::move(performed);
    if (!answer.inputs.empty()) out["inputs"] = answer.inputs;
    out["trace"] = base::parse_ordered_json(answer.open ? to_jsonl(*answer.violation, *answer.open)
                                                        : observable_jsonl(*answer.violation));
  }
  if (answer.rests_on) {
    out["rests_on"] = nlohmann::ordered_json::array();
    for (const auto& one : *answer.rests_on) {
      out["rests_on"].push_back({{"id", one.entry->id},
                                 {"status", to_string(one.entry->status)},
                                 {"certain", one.goes_through == base::Known::kYes},
                                 {"words", rests_on_words(one)}});
    }
  }
  if (answer.reservations.any()) {
    out["proof"] = "none";
    for (const auto& [name, value] : answer.reservations.fields()) out[name] = value;
  } else if (answer.proof == kBySymmetry) {
    out["proof"] = "none";
    out["symmetry"] = true;
  } else if (answer.proof == kByCubes) {
    out["proof"] = "none";
    out["cubes"] = true;
  } else if (!answer.proof.empty()) {
    out["proof"] = answer.proof.substr(std::string("proof ").size());
  }
  if (!answer.proof_origin.empty()) out["proof_origin"] = answer.proof_origin;
  if (!answer.proof_file.empty()) out["proof_file"] = answer.proof_file;
  if (answer.beyond) out["unbounded"] = beyond_json(answer);
  out["timing"]["wall_s"] = wall_s;
  return base::json_text(out) + '\n';
}

/// The ledger, if one was named; it speaks of scenarios.
base::Result<std::optional<harness::Ledger>> ledger_of(const VerifyOptions& options,
                                                       Invocation& invocation) {
  if (options.ledger.empty()) return std::optional<harness::Ledger>();
  const auto& models = options.model.models;
  if (models.size() != 1 ||
      (!models.front().ends_with(".yaml") && !models.front().ends_with(".yml"))) {
    return invocation.sink().error_about(codes::kUsage, models.front(),
                                         "--ledger: discrepancies are of scenarios; name one");
  }
  auto ledger = harness::load_ledger(options.ledger, invocation.files(), invocation.sink());
  if (!ledger) return invocation.sink().already_reported();
  return std::optional(*std::move(ledger));
}

int answer_verify(const VerifyOptions& options, Invocation& invocation) {
  const auto start = std::chrono::steady_clock::now();
  if (!options.model.until.empty() || names_artifact(options.model)) {
    invocation.sink().error_about(
        codes::kUsage, options.model.models.front(),
        "verify needs the texts of the model and --property instead of --until");
    return 0;
  }
  const auto ledger = ledger_of(options, invocation);
  if (!ledger) return 0;
  auto model_options = options.model;
  model_options.property = options.property;
  const auto compilation = compile_models(model_options, invocation);
  if (!compilation) return 0;
  const auto& model = compilation->model;
  auto unbounded =
      options.unbounded ? Unbounded::of(*compilation, options.model, invocation) : std::nullopt;
  if (options.unbounded && !unbounded) return 0;
  const base::TemporaryFolder folder("proof");  // for one that nobody asked to keep
  const auto certify = proof_option(options, folder);
  TraceCertifier certifier(certify, options.model.models, model, invocation);
  if (!certifier.ready()) return 0;
  certifier.note_gaps(compilation->plan);
  auto answer = ask(model, certifier, !options.certify.file.empty(), options.jobs);
  // Without executions nothing can go wrong in a model. One that goes on is known to have some.
  // Where the plan was cut, what goes on is not known to.
  const bool may_have_none =
      answer.exploration == runtime::Exploration::kAllTracesExplored || answer.cut;
  if (!answer.violation && may_have_none &&
      report_if_unsatisfiable(model, model.horizon, invocation,
                              reservation_texts(*compilation, invocation)) == base::Known::kNo) {
    return 0;
  }
  const bool holds = !answer.violation && answer.exploration != runtime::Exploration::kStopped;
  answer.is_open_ended = holds && !answer.bounds.empty() &&
                         compiler::waits_for_end(*compilation->typed,
                                                 compilation->constraints.front().formula.formula);
  if (holds && answer.cut) certifier.note_cut();
  if (holds && certifier.reservations().any()) {
    answer.reservations = certifier.reservations();
    answer.proof = certifier.verdict();
  } else if (holds && answer.by_symmetry) {
    answer.proof = kBySymmetry;
  } else if (holds && answer.by_cubes) {
    answer.proof = kByCubes;
  } else if (holds) {
    prove(certify, certifier, answer);
  }
  if (holds && unbounded) {
    answer.beyond = unbounded->decide(options.certify.file.empty() ? "" : certifier.proof_file());
    answer.beyond_files = unbounded->proof_files();
  }
  if (*ledger) {
    const auto name = harness::ledger_name(options.model.models.front(), options.ledger);
    answer.rests_on = answer.violation ? rests_on(*answer.violation, **ledger, name)
                      : holds          ? rests_on(model, **ledger, name, invocation)
                                       : std::vector<RestsOn>();
  }
  if (answer.violation && options.check) {
    TraceCheck check(*compilation->typed, &stop_flag(), invocation.sink());
    check.check(*answer.violation);
  }
  if (answer.violation && compilation->constraints.front().temporal) {
    PropertyCheck check(*compilation->typed, compilation->constraints.front(), options.check,
                        invocation);
    answer.broken = check.broken(*answer.violation);
  }
  if (answer.violation && (compilation->plan || invocation.options().json)) {
    // A violation that was found is told after a stop, too.
    const auto make_solver = [] {
      return runtime::make_limited_solver(runtime::make_cadical_solver(), kProvable);
    };
    runtime::OpenAtomFinder finder(model, make_solver, false);
    answer.open = finder.find(*answer.violation);
    if (compilation->plan) {
      if (answer.open) {
        answer.inputs = plan_inputs(*compilation->plan, model, *answer.violation, *answer.open);
      }
      runtime::PlanEnds ends(model, make_solver(), false);
      answer.violation->ended = ends.of(*answer.violation);
    }
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  if (invocation.options().json) {
    invocation.document(answer_json(model, answer, wall.count()));
  } else {
    invocation.result(answer_text(model, answer) + rests_on_text(answer));
    for (const auto& bound : answer.bounds) invocation.remark(bound);
    if (answer.dead_end) {
      invocation.remark(dead_end_text(model, "violates the property", *answer.dead_end));
    }
  }
  if (answer.violation) return 1;
  return verdict(answer) == "inconclusive" ? 4 : 0;
}

}  // namespace

Command verify_command() {
  auto options = std::make_shared<VerifyOptions>();
  OptionTable command("verify",
                      "Is there an initial state and a path of the plan that violates a property?");
  command.footer(
      "Examples:\n"
      "  parallax verify domain.e start.e --plan fetch.lisp --bind robot.bind \\\n"
      "      --regions scenario.yaml --horizon 6 --property \"!HoldsAt(Holding(),time)\"\n"
      "  parallax verify scenarios/two_regions/scenario.yaml \\\n"
      "      --property \"{region} HoldsAt(RobotIn(region),time)\"\n"
      "  parallax verify lamp.e --horizon 10 \\\n"
      "      --property \"always (Happens(Press(),time) -> next HoldsAt(On(),time))\"\n"
      "The property is a formula over `time`, the last timepoint, which may also look back; or it\n"
      "speaks of whole traces, with always, eventually, next, weak_next, until, historically, "
      "once,\n"
      "previously and since (docs/reference/model_language.md). The answer\n"
      "is one shortest trace (exit code 1), or that it holds up to the horizon (0), with a proof "
      "that\n"
      "is checked by independent means and kept under --certify. A scenario's own constraints play "
      "no\n"
      "part.");
  add_model_options(command, options->model);
  add_plan_options(command, options->model);
  command.heading("The property");
  command.option("--property", options->property, "Formula that should hold at all times")
      .required();
  command.flag("--unbounded", options->unbounded,
               "Also beyond the horizon: k-induction with a checked proof, no plan");
  add_certify_option(command, options->certify);
  add_cubes_option(command, options->jobs);
  command
      .option("--ledger", options->ledger,
              "Known discrepancies that the answer may rest on (docs/reference/suites.md)")
      .file({"yaml"});
  command.flag("--check", options->check,
               "Evaluate the model on the trace by independent means; exit 5 if it differs");
  return command_of(std::move(command), options, answer_verify);
}

}  // namespace parallax::tools
