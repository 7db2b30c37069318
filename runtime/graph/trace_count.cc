// Counts the traces of a model, and draws from them uniformly.
//
// Several methods count, and none is always the best, so they are tried by rising cost. Where
// clauses look far a short trial of counting by components comes first (component_counter.cc).
// Then traces are listed one by one; if there are many, graphs of growing size are tried
// (trace_graph.cc), between them graphs with one state for each orbit of a symmetry
// (state_orbits.cc), then components in full; what is left is listed to the end. Each gives the
// same number.
//
// A sample draws numbers below the count, by bits until they are below it, and seeks each of
// these traces in canonical order. So a seed gives the same traces whatever counted them. Cost:
// one seek for each different number drawn; without a graph or components all traces are listed
// twice.

#include "runtime/graph/trace_count.h"

#include <map>
#include <optional>
#include <random>
#include <utility>
#include <variant>

#include "runtime/graph/far_atoms.h"
#include "runtime/graph/state_orbits.h"

namespace parallax::runtime {
namespace {

/// The number is that of the graph.
void take_from(const TraceGraph& graph, TraceCount& result) {
  result.count = graph.count();
  result.complete = true;
  result.stats.states = graph.node_count();
  result.stats.transitions = graph.edge_count();
  result.stats.remark.clear();
}

/// On a graph that has one state of each orbit. For a model that has a trace.
class OrbitGraphs {
 public:
  OrbitGraphs(const CompiledModel& model, const TraceQuery& query) : model_(model), query_(query) {}

  bool count(const GraphLimits& limits, TraceCount& result) {
    if (!may_ || !prepare()) return may_ = false;
    std::string reason;
    const auto graph = TraceGraph::build(*layered_, limits, query_.stop, reason, &*orbits_);
    if (graph == nullptr) return false;
    take_from(*graph, result);
    result.stats.strategy = "graph of orbits";
    result.stats.solve_calls += graph->solve_calls();
    result.stats.by_symmetry = true;
    return true;
  }

 private:
  bool prepare() {
    if (orbits_) return true;
    auto split = split_into_windows(model_, query_.distinct, FixedTies::kCarried);
    if (!std::holds_alternative<LayeredModel>(split)) return false;
    layered_ = std::get<LayeredModel>(std::move(split));
    orbits_ = GraphOrbits::of(model_, *layered_);
    return !orbits_->empty();
  }

  const CompiledModel& model_;
  const TraceQuery& query_;
  bool may_ = true;  // there are symmetries that act on states
  std::optional<LayeredModel> layered_;
  std::optional<GraphOrbits> orbits_;
};

bool count_components(const CompiledModel& model, const TraceQuery& query, ComponentEffort effort,
                      TraceCount& result) {
  const ComponentTraces components(model, query.distinct, query.stop, effort);
  if (!components.total()) return false;
  result.count = *components.total();
  result.complete = true;
  result.stats = components.stats();
  return true;
}

}  // namespace

TraceCount count_traces(const CompiledModel& model, const TraceQuery& query) {
  TraceCount result;
  // Atoms that clauses tie together from afar have to be carried along in a graph.
  if (query.strategy == Strategy::kAuto && looks_far(model) &&
      count_components(model, query, ComponentEffort::kTrial, result)) {
    return result;
  }
  auto of_all = query;
  of_all.number_only = true;
  ModelTraces traces(model, of_all);
  if (traces.graph() == nullptr && !traces.refusal().empty()) {
    result.refusal = traces.refusal();
    return result;
  }
  const auto stopped = [&] { return query.stop != nullptr && query.stop->load(); };
  const bool chooses = query.strategy == Strategy::kAuto;
  OrbitGraphs orbits(model, query);
  const auto graphs = traces.graphs_left();
  std::size_t orbits_tried = 0;  // as many as graphs of the model itself were not enough
  while (true) {
    if (const auto* graph = traces.graph()) {
      result.stats = traces.stats();
      take_from(*graph, result);
      result.stats.strategy = "graph";  // it may count what it cannot list
      return result;
    }
    if (stopped()) break;
    // Once a small graph was not enough, and before a large one.
    const auto graphs_left = traces.graphs_left();
    const bool is_due =
        chooses && result.count > 0 && graphs_left > 0 && orbits_tried < graphs - graphs_left;
    if (is_due && query.breaks_symmetry) {
      const auto& limits = orbits_tried == 0 ? kMediumGraph : query.limits;
      if (orbits.count(limits.within(query.limits), result)) return result;
    }
    if (is_due) ++orbits_tried;
    if (query.strategy == Strategy::kComponents || (is_due && orbits_tried == 2)) {
      if (count_components(model, query, ComponentEffort::kFull, result)) {
        result.stats.remark = traces.stats().remark;
        return result;
      }
    }
    if (traces.next()) {
      ++result.count;
    } else if (traces.graph() == nullptr && traces.graphs_left() == graphs_left) {
      break;
    }
  }
  result.complete = traces.exhausted();
  result.stats = traces.stats();
  return result;
}

namespace {

/// A number below `bound`, which is positive: bits are drawn until they are below it.
mpz_class draw_below(const mpz_class& bound, std::mt19937_64& random) {
  const auto bits = mpz_sizeinbase(bound.get_mpz_t(), 2);
  while (true) {
    mpz_class number = 0;
    for (std::size_t have = 0; have < bits; have += 32) {
      number <<= 32;
      number += static_cast<unsigned long>(random() >> 32U);
    }
    number >>= (32 - bits % 32) % 32;
    if (number < bound) return number;
  }
}

}  // namespace

DrawnTraces sample_traces(const CompiledModel& model, const TraceQuery& query, std::size_t size,
                          std::uint64_t seed) {
  DrawnTraces sample;
  const auto counted = count_traces(model, query);
  sample.population = counted.count;
  sample.complete = counted.complete;
  sample.stats = counted.stats;
  sample.refusal = counted.refusal;
  if (!counted.complete || counted.count == 0) return sample;
  std::mt19937_64 random(seed);
  std::multimap<mpz_class, std::size_t> draws;  // by the number of traces before
  for (std::size_t i = 0; i < size; ++i) draws.emplace(draw_below(counted.count, random), i);
  sample.traces.resize(size);
  ModelTraces traces(model, query);
  std::optional<Trace> last;
  mpz_class next = 0;  // how many traces come before the one that is next
  for (const auto& [before, place] : draws) {
    if (!last || before >= next) {
      traces.seek(before);
      last = traces.next();
      next = before + 1;
    }
    if (!last) {
      sample.complete = false;
      sample.traces.clear();
      return sample;
    }
    sample.traces[place] = *last;
    sample.traces[place].number = static_cast<std::int64_t>(place) + 1;
  }
  return sample;
}

}  // namespace parallax::runtime
