#include <chrono>
#include <memory>
#include <optional>

#include "runtime/enumerate/model_enumerator.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/trace_counter.h"
#include "tools/cli/certify.h"
#include "tools/cli/scenario_model.h"
#include "tools/cli/signals.h"
#include "tools/cli/trace_check.h"

namespace parallax::tools {
namespace {

struct TracesOptions {
  ModelOptions model;
  std::int64_t limit = 10;
  bool count = false;
  bool expect_traces = false;
  bool check = false;
  std::string format = "text";
  CertifyOption certify;
};

/// Prints traces as they are found and counts them; under --json they are kept for the document.
/// What is checked is printed all the same.
class TraceWriter {
 public:
  /// `check` may be null; else it outlives the writer, as the certifier does.
  TraceWriter(const TracesOptions& options, TraceCheck* check, TraceCertifier& certifier,
              Invocation& invocation)
      : options_(options), check_(check), certifier_(certifier), invocation_(invocation) {}
  bool full() const { return !options_.count && options_.limit > 0 && count_ == options_.limit; }
  void write(const runtime::Trace& trace) {
    ++count_;
    print(trace);
    if (check_ != nullptr) check_->check(trace);
    certifier_.add(trace);
  }
  std::int64_t count() const { return count_; }
  const std::string& list() const { return list_; }
  bool agreed() const { return check_ == nullptr || check_->agreed(); }
  /// `"checked":N,` where traces are checked.
  std::string checked_field() const {
    return check_ == nullptr ? "" : fmt::format("\"checked\":{},", check_->checked());
  }
  /// `, N checked` where traces are checked.
  std::string checked_remark() const {
    return check_ == nullptr ? "" : fmt::format(", {} checked", check_->checked());
  }

 private:
  void print(const runtime::Trace& trace) {
    if (options_.count) return;
    if (invocation_.options().json) {
      list_ += (list_.empty() ? "" : ",") + runtime::to_jsonl(trace);
    } else {
      invocation_.result(options_.format == "jsonl" ? runtime::to_jsonl(trace) + '\n'
                                                    : runtime::to_text(trace));
    }
  }

  const TracesOptions& options_;
  TraceCheck* check_;
  TraceCertifier& certifier_;
  Invocation& invocation_;
  std::int64_t count_ = 0;
  std::string list_;
};

template <typename Enumerator>
void write_all(Enumerator& enumerator, TraceWriter& writer) {
  while (!writer.full() && !stop_flag().load()) {
    const auto trace = enumerator.next();
    if (!trace) return;
    writer.write(*trace);
  }
}

/// What is known of the traces that were not listed, and how.
struct Ending {
  std::string exploration;
  bool complete = false;
  std::string remark, fields;  // of the certifier

  void add(TraceCertifier& certifier) {
    certifier.conclude(exploration);
    remark = certifier.remark(exploration);
    fields = certifier.fields();
    complete = complete && !certifier.refuted();
  }
};

/// Says what is known of the rest: complete, up to the bound, or stopped by the limit.
void close_list(const TracesOptions& options, const TraceWriter& writer, const Ending& ending,
                double wall_s, Invocation& invocation) {
  if (stop_flag().load()) invocation.remark("stopped before the end: there may be more traces");
  const auto timing = fmt::format("\"timing\":{{\"wall_s\":{:.3f}}}", wall_s);
  if (invocation.options().json) {
    const auto list = options.count ? "" : fmt::format("\"list\":[{}],", writer.list());
    invocation.document(fmt::format(
        "{{\"status\":\"{}\",\"traces\":{},\"complete\":{},\"exploration\":\"{}\",{}{}{}{}}}\n",
        writer.agreed() ? "ok" : "error", writer.count(), ending.complete, ending.exploration,
        ending.fields, writer.checked_field(), list, timing));
  } else if (options.count) {
    invocation.result(fmt::format("{}\n", writer.count()));
  } else if (options.format == "jsonl") {
    invocation.result(fmt::format("{{\"summary\":true,\"traces\":{},\"complete\":{},{}{}{}}}\n",
                                  writer.count(), ending.complete, ending.fields,
                                  writer.checked_field(), timing));
  } else {
    invocation.result(fmt::format("{} {}, {}{}{}\n", writer.count(),
                                  writer.count() == 1 ? "trace" : "traces", ending.exploration,
                                  ending.remark, writer.checked_remark()));
  }
}

/// `--count` without a plan or constraints: no trace needs to be made.
int count_only(const TracesOptions& options, const compiler::CompiledModel& model,
               TraceCertifier& certifier, std::chrono::steady_clock::time_point start,
               Invocation& invocation) {
  const auto counted = runtime::count_traces(model, {}, &stop_flag());
  if (counted.count == 0 && counted.complete) {
    certifier.conclude("complete");
  } else {
    certifier.decline("the traces were counted, not listed");
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const auto number = counted.count.get_str();
  if (!counted.complete) invocation.remark("stopped before the end: there may be more traces");
  if (options.model.stats && !invocation.options().json) {
    write_error(fmt::format("strategy {}{}{}; {} states, {} transitions, {} solver calls\n",
                            counted.strategy, counted.remark.empty() ? "" : ": ", counted.remark,
                            counted.states, counted.transitions, counted.solve_calls));
  }
  if (invocation.options().json) {
    invocation.document(
        fmt::format("{{\"status\":\"ok\",\"traces\":{},\"complete\":{},\"exploration\":\"{}\","
                    "\"strategy\":\"{}\",{}\"timing\":{{\"wall_s\":{:.3f}}}}}\n",
                    number, counted.complete, counted.complete ? "complete" : "stopped",
                    counted.strategy, certifier.fields(), wall.count()));
  } else {
    invocation.result(number + '\n');
  }
  return counted.count == 0 && options.expect_traces ? 1 : 0;
}

/// Enumerates into the writer.
Ending enumerate(const compiler::CompiledModel& model, TraceWriter& writer) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(&stop_flag()));
  if (model.has_constraints) {
    runtime::PlanEnumerator enumerator(session);
    write_all(enumerator, writer);
    return {std::string(runtime::to_string(enumerator.exploration())),
            enumerator.exploration() == runtime::Exploration::kAllTracesExplored,
            {},
            {}};
  }
  runtime::ModelEnumerator enumerator(session);
  write_all(enumerator, writer);
  // At the limit one more call tells "these are all" from "there are more".
  if (writer.full() && !stop_flag().load()) (void)enumerator.next();
  return {enumerator.exhausted() ? "complete" : "stopped", enumerator.exhausted(), {}, {}};
}

int list_traces(const TracesOptions& options, Invocation& invocation) {
  const auto start = std::chrono::steady_clock::now();
  if (options.check && !options.model.compat.empty()) {
    invocation.sink().error_about(
        base::DiagnosticCode::kUsage, "",
        "--check evaluates the standard meaning and does not go with --compat");
    return 0;
  }
  if (options.check && names_artifact(options.model)) {
    invocation.sink().error_about(base::DiagnosticCode::kUsage, options.model.models.front(),
                                  "--check evaluates the texts of a model; name them instead");
    return 0;
  }
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
  std::optional<TraceCheck> check;
  if (options.check) check.emplace(*compilation->typed, &stop_flag(), invocation.sink());
  TraceWriter writer(options, check ? &*check : nullptr, certifier, invocation);
  auto ending = enumerate(compilation->model, writer);
  ending.add(certifier);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  close_list(options, writer, ending, wall.count(), invocation);
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
      "  parallax traces scenarios/two_regions/scenario.yaml --format jsonl\n"
      "  parallax traces domain.e --limit 0 --certify=domain.drat");
  add_model_options(*command, options->model);
  command->add_option("--limit", options->limit, "Stop after this many traces; 0: all")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--count", options->count, "Print only the number of traces");
  command->add_flag("--stats", options->model.stats,
                    "Show on standard error how traces were counted and what each axiom costs");
  command->add_flag("--expect-traces", options->expect_traces, "Exit with 1 if there is no trace");
  command->add_flag(
      "--check", options->check,
      "Evaluate the model on every trace by independent means; exit 5 if one differs");
  add_certify_option(*command, options->certify);
  command->add_option("--format", options->format, "text or jsonl")
      ->check(CLI::IsMember({"text", "jsonl"}))
      ->capture_default_str();
  return {command, [options](Invocation& invocation) { return list_traces(*options, invocation); }};
}

}  // namespace parallax::tools
