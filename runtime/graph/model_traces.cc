#include "runtime/graph/model_traces.h"

#include <utility>
#include <variant>

#include "runtime/enumerate/trace_tree.h"

namespace parallax::runtime {
namespace {

/// Up to so many traces blocking is quicker than finding every state.
constexpr std::int64_t kFirst = 64;
/// Up to so many it is quick enough, if no more are wanted.
constexpr std::int64_t kFew = 1000;

}  // namespace

ModelGraph build_graph(const CompiledModel& model, const TraceQuery& query) {
  ModelGraph result;
  auto split = split_into_windows(model, query.distinct);
  if (auto* layered = std::get_if<LayeredModel>(&split)) {
    result.layered = std::make_unique<LayeredModel>(std::move(*layered));
    result.graph = TraceGraph::build(*result.layered, query.limits, query.stop, result.reason);
  } else {
    result.reason = std::get<std::string>(split);
  }
  return result;
}

ModelTraces::ModelTraces(const CompiledModel& model, TraceQuery query)
    : model_(model), query_(query), session_(model, make_cadical_solver(query.stop)) {
  source_ = std::make_unique<ModelEnumerator>(session_, query.distinct);
  switch (query.strategy) {
    case Strategy::kAuto:
      is_final_ = query.wanted > 0 && query.wanted <= kFew;
      break;
    case Strategy::kBlocking:
      break;
    case Strategy::kGuarded:
      source_ = make_guarded_blocking(session_, query.distinct);
      break;
    case Strategy::kTree:
      source_ = make_trace_tree(session_, query.distinct);
      break;
    case Strategy::kGraph:
      // The graph needs a model that has a trace.
      if (session_.solve(model.horizon, {}) != SolveStatus::kSatisfiable) break;
      use_graph();
      if (paths_ == nullptr) refusal_ = remark_;
      break;
  }
}

void ModelTraces::use_graph() {
  graph_ = build_graph(model_, query_);
  remark_ = graph_.graph == nullptr ? graph_.reason : GraphPaths::obstacle(*graph_.graph, model_);
  if (!remark_.empty()) return;
  auto paths = std::make_unique<GraphPaths>(*graph_.graph, model_);
  paths_ = paths.get();
  source_ = std::move(paths);
}

/// From here on the graph gives the traces, or the tree.
void ModelTraces::leave_blocking() {
  is_final_ = true;
  use_graph();
  if (paths_ != nullptr) {
    paths_->seek(given_);
    return;
  }
  // The blocking clauses must not hold in the tree.
  tree_session_.emplace(model_, make_cadical_solver(query_.stop));
  source_ = make_trace_tree(*tree_session_, query_.distinct);
  for (std::int64_t i = 0; i < given_ && source_->next(); ++i) continue;
}

std::optional<Trace> ModelTraces::next() {
  if (!is_final_ && given_ == kFirst) leave_blocking();
  auto trace = source_->next();
  if (trace) ++given_;
  return trace;
}

bool ModelTraces::print_next(const TraceFormat& format, std::string& out) {
  if (!is_final_ && given_ == kFirst) leave_blocking();
  const bool found = source_->print_next(format, out);
  if (found) ++given_;
  return found;
}

void ModelTraces::seek(const mpz_class& before) {
  if (query_.strategy == Strategy::kAuto && before >= kFirst) {
    // What lies so far ahead is not worth to be found one by one.
    if (given_ < kFirst) is_final_ = false;
    while (given_ < kFirst && next()) continue;
    if (!is_final_ && given_ == kFirst) leave_blocking();
  }
  if (paths_ != nullptr) {
    paths_->seek(before);
    return;
  }
  for (mpz_class i = given_; i < before && next(); ++i) continue;
}

SourceStats ModelTraces::stats() const {
  auto stats = source_->stats();
  stats.remark = remark_;
  if (paths_ != nullptr) stats.solve_calls += session_.solve_calls();
  return stats;
}

}  // namespace parallax::runtime
