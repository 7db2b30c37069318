#include <chrono>
#include <memory>

#include "runtime/enumerate/model_enumerator.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "tools/cli/scenario_model.h"
#include "tools/cli/signals.h"

namespace parallax::tools {
namespace {

struct TracesOptions {
  ModelOptions model;
  std::int64_t limit = 10;
  bool count = false;
  bool expect_traces = false;
  std::string format = "text";
};

/// Prints traces as they are found and counts them; under --json they are kept for the document.
class TraceWriter {
 public:
  TraceWriter(const TracesOptions& options, Invocation& invocation)
      : options_(options), invocation_(invocation) {}
  bool full() const { return !options_.count && options_.limit > 0 && count_ == options_.limit; }
  void write(const runtime::Trace& trace) {
    ++count_;
    if (options_.count) return;
    if (invocation_.options().json) {
      list_ += (list_.empty() ? "" : ",") + runtime::to_jsonl(trace);
    } else {
      invocation_.result(options_.format == "jsonl" ? runtime::to_jsonl(trace) + '\n'
                                                    : runtime::to_text(trace));
    }
  }
  std::int64_t count() const { return count_; }
  const std::string& list() const { return list_; }

 private:
  const TracesOptions& options_;
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

/// Says what is known of the rest: complete, up to the bound, or stopped by the limit.
void close_list(const TracesOptions& options, const TraceWriter& writer,
                const std::string& exploration, bool complete, double wall_s,
                Invocation& invocation) {
  if (stop_flag().load()) invocation.remark("stopped before the end: there may be more traces");
  const auto timing = fmt::format("\"timing\":{{\"wall_s\":{:.3f}}}", wall_s);
  if (invocation.options().json) {
    const auto list = options.count ? "" : fmt::format("\"list\":[{}],", writer.list());
    invocation.document(fmt::format("{{\"status\":\"ok\",\"traces\":{},\"complete\":{},{}{}}}\n",
                                    writer.count(), complete, list, timing));
  } else if (options.count) {
    invocation.result(fmt::format("{}\n", writer.count()));
  } else if (options.format == "jsonl") {
    invocation.result(fmt::format("{{\"summary\":true,\"traces\":{},\"complete\":{},{}}}\n",
                                  writer.count(), complete, timing));
  } else {
    invocation.result(fmt::format("{} {}, {}\n", writer.count(),
                                  writer.count() == 1 ? "trace" : "traces", exploration));
  }
}

int list_traces(const TracesOptions& options, Invocation& invocation) {
  const auto start = std::chrono::steady_clock::now();
  const auto compilation = compile_models(options.model, invocation);
  if (!compilation) return 0;
  const auto& model = compilation->model;
  runtime::SolverSession session(model, runtime::make_cadical_solver(&stop_flag()));
  TraceWriter writer(options, invocation);
  std::string exploration;
  bool complete = false;
  if (model.has_constraints) {
    runtime::PlanEnumerator enumerator(session);
    write_all(enumerator, writer);
    exploration = runtime::to_string(enumerator.exploration());
    complete = enumerator.exploration() == runtime::Exploration::kAllTracesExplored;
  } else {
    runtime::ModelEnumerator enumerator(session);
    write_all(enumerator, writer);
    // At the limit one more call tells "these are all" from "there are more".
    if (writer.full() && !stop_flag().load()) (void)enumerator.next();
    complete = enumerator.exhausted();
    exploration = complete ? "complete" : "stopped";
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  close_list(options, writer, exploration, complete, wall.count(), invocation);
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
      "  parallax traces scenarios/two_regions/scenario.yaml --format jsonl");
  add_model_options(*command, options->model);
  command->add_option("--limit", options->limit, "Stop after this many traces; 0: all")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_flag("--count", options->count, "Print only the number of traces");
  command->add_flag("--expect-traces", options->expect_traces, "Exit with 1 if there is no trace");
  command->add_option("--format", options->format, "text or jsonl")
      ->check(CLI::IsMember({"text", "jsonl"}))
      ->capture_default_str();
  return {command, [options](Invocation& invocation) { return list_traces(*options, invocation); }};
}

}  // namespace parallax::tools
