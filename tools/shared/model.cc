#include <atomic>
#include <memory>
#include <optional>
#include <utility>

#include "compiler/pipeline/compile.h"
#include "parallax/parallax.h"
#include "runtime/enumerate/plan_enumerator.h"
#include "runtime/graph/model_traces.h"
#include "runtime/graph/trace_count.h"
#include "runtime/session/solver_session.h"
#include "tools/app/model_options.h"
#include "tools/app/scenario_model.h"
#include "tools/shared/messages.h"

namespace parallax::api {

struct Model::Body {
  compiler::Compilation compilation;
  std::vector<Message> warnings;
};

namespace {

std::vector<std::string> texts(const runtime::Names& names) { return {names.begin(), names.end()}; }

Trace shown(const runtime::Trace& trace) {
  Trace out;
  out.number = trace.number;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    out.points.push_back({texts(trace.holds(t)), texts(trace.happens(t))});
  }
  out.text = runtime::to_text(trace);
  out.json = runtime::to_jsonl(trace);
  return out;
}

Explored explored(runtime::Exploration exploration) {
  switch (exploration) {
    case runtime::Exploration::kAllTracesExplored:
      return Explored::kAll;
    case runtime::Exploration::kCompleteUpToBound:
      return Explored::kUpToBound;
    case runtime::Exploration::kStopped:
      break;
  }
  return Explored::kStopped;
}

/// Traces of a model with a plan or constraints, until `take` returns false.
template <typename Take>
Explored each_plan_trace(const compiler::CompiledModel& model, const std::atomic<bool>* stop,
                         Take take) {
  runtime::SolverSession session(model, runtime::make_cadical_solver(stop));
  runtime::PlanEnumerator traces(session);
  while (const auto trace = traces.next()) {
    if (!take(*trace)) return Explored::kStopped;
  }
  return explored(traces.exploration());
}

template <typename Take>
Explored each_model_trace(const compiler::CompiledModel& model, std::int64_t limit,
                          const std::atomic<bool>* stop, Take take) {
  runtime::TraceQuery query;
  query.wanted = limit;
  query.stop = stop;
  runtime::ModelTraces traces(model, query);
  while (const auto trace = traces.next()) {
    if (!take(*trace)) return Explored::kStopped;
  }
  return traces.exhausted() ? Explored::kAll : Explored::kStopped;
}

}  // namespace

Model::Model(std::unique_ptr<Body> body) : body_(std::move(body)) {}
Model::~Model() = default;
Model::Model(Model&& other) noexcept = default;
Model& Model::operator=(Model&& other) noexcept = default;

Model Model::load(const ModelOptions& options) {
  tools::Context context;
  tools::ModelOptions asked;
  asked.models = options.files;
  asked.include_dirs = options.include_folders;
  if (options.as_decreasoner) asked.compat = "decreasoner";
  asked.horizon = options.horizon;
  asked.until = options.until;
  asked.plan = options.plan;
  asked.bind = options.bindings;
  asked.plan_entry = options.plan_entry;
  auto compiled = tools::compile_models(asked, context);
  if (!compiled) fail(context);
  return Model(std::make_unique<Body>(Body{*std::move(compiled), messages_of(context)}));
}

Model Model::of_scenario(const std::string& path) {
  tools::Context context;
  auto loaded = tools::load_scenario_model(path, context);
  if (!loaded) fail(context);
  return Model(std::make_unique<Body>(Body{std::move(loaded->compilation), messages_of(context)}));
}

int Model::horizon() const { return body_->compilation.model.horizon; }
std::int64_t Model::variables() const { return body_->compilation.model.variable_count(); }
std::int64_t Model::clauses() const {
  return static_cast<std::int64_t>(body_->compilation.model.clauses.size());
}
const std::vector<Message>& Model::warnings() const { return body_->warnings; }

Explored Model::traces(std::int64_t limit, const std::function<bool(const Trace&)>& take,
                       const std::atomic<bool>* stop) const {
  if (!take) throw Failure("Model::traces was given nobody to take the traces", {});
  const auto& model = body_->compilation.model;
  std::int64_t given = 0;
  const auto next = [&](const runtime::Trace& trace) {
    return take(shown(trace)) && ++given != limit;
  };
  return model.has_constraints ? each_plan_trace(model, stop, next)
                               : each_model_trace(model, limit, stop, next);
}

std::string Model::count(const std::atomic<bool>* stop) const {
  const auto& model = body_->compilation.model;
  const auto unknown = [] { return Failure("stopped before the traces were counted", {}); };
  if (model.has_constraints) {
    std::int64_t count = 0;
    const auto ended = each_plan_trace(model, stop, [&](const auto&) { return ++count > 0; });
    if (ended == Explored::kStopped) throw unknown();
    return std::to_string(count);
  }
  runtime::TraceQuery query;
  query.number_only = true;
  query.stop = stop;
  const auto counted = runtime::count_traces(model, query);
  if (!counted.complete) throw unknown();
  return counted.count.get_str();
}

}  // namespace parallax::api
