#include "runtime/graph/trace_graph.h"

#include <doctest/doctest.h>

#include "runtime/enumerate/model_enumerator.h"
#include "runtime/graph/model_traces.h"
#include "runtime/graph/trace_count.h"
#include "tests/support/random_model.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

using runtime::Timepoint;

/// "F() G()|E();F()|;" timepoint by timepoint.
std::string text_of(const std::vector<std::string>& holds, const std::vector<std::string>& events) {
  std::string out;
  for (const auto& name : holds) out += name + ' ';
  out += '|';
  for (const auto& name : events) out += name + ' ';
  return out + ';';
}

std::vector<std::string> blocking_traces(const compiler::CompiledModel& model, std::size_t limit) {
  runtime::SolverSession session(model, runtime::make_cadical_solver());
  runtime::ModelEnumerator enumerator(session);
  std::vector<std::string> traces;
  while (traces.size() < limit) {
    const auto trace = enumerator.next();
    if (!trace) break;
    auto& text = traces.emplace_back();
    for (std::size_t t = 0; t < trace->points.size(); ++t) {
      const auto holds = trace->holds(t), happens = trace->happens(t);
      text += text_of({holds.begin(), holds.end()}, {happens.begin(), happens.end()});
    }
  }
  return traces;
}

/// The graph's paths, in order.
class PathLister {
 public:
  PathLister(const runtime::TraceGraph& graph, const compiler::CompiledModel& model)
      : graph_(graph) {
    for (const auto& fluent : model.fluents) {
      if (fluent.slot) fluents_.push_back(fluent.name);
    }
    for (const auto& event : model.events) {
      if (event.slot) events_.push_back(event.name);
    }
  }
  std::vector<std::string> run() {
    for (const auto start : graph_.starts()) walk(0, start, "");
    return std::move(paths_);
  }

 private:
  static std::vector<std::string> names(const runtime::Bits& bits,
                                        const std::vector<std::string>& all) {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (bits[i]) out.push_back(all[i]);
    }
    std::sort(out.begin(), out.end());
    return out;
  }
  void walk(Timepoint t, std::uint32_t node, const std::string& before) {
    if (graph_.completions(t, node) == 0) return;
    const auto holds = names(graph_.node(node).observed, fluents_);
    if (t == graph_.model().horizon) {
      paths_.push_back(before + text_of(holds, {}));
      return;
    }
    for (const auto& edge : graph_.edges(t, node)) {
      walk(t + 1, edge.target, before + text_of(holds, names(graph_.events(edge.events), events_)));
    }
  }

  const runtime::TraceGraph& graph_;
  std::vector<std::string> fluents_, events_;
  std::vector<std::string> paths_;
};

struct Seen {
  std::size_t graphs = 0, traces = 0, undetermined = 0, nonlocal = 0, carried = 0;
};

void compare(const std::string& text, Seen& seen) {
  const TextModel model(text);
  if (model.ground == nullptr) return;
  constexpr std::size_t kLimit = 400;
  const auto wanted = blocking_traces(model.compiled, kLimit);
  if (wanted.empty() || wanted.size() == kLimit) return;
  CAPTURE(text);
  auto split = runtime::split_into_windows(model.compiled, runtime::Distinct::kObservable);
  if (!std::holds_alternative<runtime::LayeredModel>(split)) {
    ++seen.nonlocal;
    CHECK_FALSE(std::get<std::string>(split).empty());
    split = runtime::split_into_windows(model.compiled, runtime::Distinct::kObservable,
                                        runtime::FixedTies::kCarried);
    if (!std::holds_alternative<runtime::LayeredModel>(split)) return;
    ++seen.carried;
  }
  std::string reason;
  const auto graph =
      runtime::TraceGraph::build(std::get<runtime::LayeredModel>(split), {}, nullptr, reason);
  REQUIRE_MESSAGE(graph != nullptr, reason);
  CHECK(PathLister(*graph, model.compiled).run() == wanted);
  CHECK(graph->count() == wanted.size());
  ++seen.graphs;
  seen.traces += wanted.size();
  if (!graph->is_determined()) ++seen.undetermined;
}

}  // namespace

TEST_CASE("a predicate that ties all timepoints together is carried from state to state") {
  Seen seen;
  // With one value of `P` each event is free, with the other it is not; `Q` and `P` exclude each
  // other.
  compare(
      "predicate P()\npredicate Q()\nevent D()\nfluent F()\n"
      "[time] P() -> Happens(D(),time).\n[time] Q() -> !Happens(D(),time).\n"
      "P() | Q().\nHoldsAt(F(),0).\nrange time 0 6\n",
      seen);
  compare(
      "sort s\ns A, B, C\npredicate P(s)\nevent D(s)\nfluent F(s)\n"
      "[s,time] P(s) -> Initiates(D(s),F(s),time).\n[s] !HoldsAt(F(s),0).\n"
      "[s1,s2] P(s1) & P(s2) -> s1=s2.\n[s1,s2,time] Happens(D(s1),time) & "
      "Happens(D(s2),time) -> s1=s2.\nrange time 0 3\n",
      seen);
  CHECK(seen.graphs == 2);
  CHECK(seen.carried == 2);
  CHECK(seen.undetermined == 2);
}

TEST_CASE("the paths of the graph are the traces, in the same order") {
  Seen seen;
  for (std::uint64_t seed = 1; seed <= 2000; ++seed) {
    compare(random_model(seed, kBruteForceSize).print(), seen);
    if (seed % 4 == 0) compare(random_model(seed, kSolverSize).print(), seen);
  }
  // The comparison finds the differences that it is meant to find.
  CHECK(seen.graphs > 500);
  CHECK(seen.traces > 3000);
  CHECK(seen.undetermined > 5);
  CHECK(seen.nonlocal > 5);
  CHECK(seen.carried > 5);
}

TEST_CASE("counts are exact beyond 64 bits") {
  // Each of 70 steps presses any set of two switches: 4^70 traces.
  const TextModel model(
      "sort s\ns A, B\nfluent On(s)\nevent Press(s)\n[s,time] Initiates(Press(s),On(s),time).\n"
      "[s] !HoldsAt(On(s),0).\nrange time 0 70\n");
  REQUIRE(model.ground != nullptr);
  const auto counted = runtime::count_traces(model.compiled, {});
  CHECK(counted.complete);
  CHECK(counted.stats.strategy == "graph");
  mpz_class wanted;
  mpz_ui_pow_ui(wanted.get_mpz_t(), 4, 70);
  CHECK(counted.count == wanted);
}

TEST_CASE("what clauses tie together from afar is counted by components first") {
  // No lamp is switched at 0 and at 5; the graph would carry both for each lamp.
  const TextModel model(
      "sort lamp\nlamp L1, L2, L3, L4\nfluent Lit(lamp)\nevent Flip(lamp)\n"
      "[lamp,time] !HoldsAt(Lit(lamp),time) -> Initiates(Flip(lamp),Lit(lamp),time).\n"
      "[lamp,time] HoldsAt(Lit(lamp),time) -> Terminates(Flip(lamp),Lit(lamp),time).\n"
      "[lamp] !HoldsAt(Lit(lamp),0).\n[lamp] HoldsAt(Lit(lamp),6).\n"
      "[lamp] Happens(Flip(lamp),0) -> !Happens(Flip(lamp),5).\nrange time 0 6\n");
  const auto counted = runtime::count_traces(model.compiled, {});
  CHECK(counted.complete);
  CHECK(counted.stats.strategy == "components");
  // A lamp: an odd number of six flips, less the 8 with both 0 and 5 among them.
  CHECK(counted.count == 24 * 24 * 24 * 24);
  runtime::TraceQuery query;
  query.strategy = runtime::Strategy::kGraph;
  CHECK(runtime::count_traces(model.compiled, query).count == counted.count);
}

TEST_CASE("a limit that is hit leaves the graph for other ways, with the reason") {
  const TextModel model(
      "sort s\ns A, B, C\nfluent On(s)\nevent Press(s)\n[s,time] Initiates(Press(s),On(s),time).\n"
      "[s] !HoldsAt(On(s),0).\nrange time 0 3\n");
  runtime::TraceQuery query;
  query.search_first = 0;
  query.limits = {.nodes = 3, .edges = 3};
  const auto counted = runtime::count_traces(model.compiled, query);
  CHECK(counted.complete);
  CHECK(counted.stats.strategy != "graph");
  CHECK(counted.count == 512);
  CHECK_FALSE(counted.stats.remark.empty());
}

/// An event is noted by a predicate that nothing determines where the event does not happen.
TextModel free_predicate(int levels) {
  return TextModel("sort level: integer\nrange level 0 " + std::to_string(levels) +
                   "\nsort tin\ntin Red\npredicate Noted(event,time)\nfluent Mark(level)\n"
                   "event Ring()\nevent Set(level)\nevent Push(tin)\nrange time 0 1\n"
                   "[time] !Happens(Push(Red),time) -> Happens(Ring(),time).\n"
                   "[time,level,event] Happens(event,time) -> "
                   "!(Noted(event,0) -> HoldsAt(Mark(level),time)).\n");
}

TEST_CASE("hidden valuations count as ways on, so that a limit bounds the work on a graph") {
  const auto model = free_predicate(8);
  const auto split = runtime::split_into_windows(model.compiled, runtime::Distinct::kObservable,
                                                 runtime::FixedTies::kCarried);
  REQUIRE(std::holds_alternative<runtime::LayeredModel>(split));
  const auto& layered = std::get<runtime::LayeredModel>(split);
  std::string reason;
  std::int64_t work = 0;
  runtime::GraphLimits limits;
  limits.edges = 500;
  CHECK(runtime::TraceGraph::build(layered, limits, nullptr, reason, nullptr, &work) == nullptr);
  CHECK(work > 0);
  CHECK(work < 500 * 4 * std::int64_t{model.compiled.variable_count()});
}

TEST_CASE("a few traces of a model with many hidden valuations are searched, not left to a graph") {
  const auto model = free_predicate(4);
  const auto counted = runtime::count_traces(model.compiled, {});
  CHECK(counted.complete);
  CHECK(counted.stats.strategy == "search");
  runtime::TraceQuery blocking;
  blocking.strategy = runtime::Strategy::kBlocking;
  CHECK(counted.count == runtime::count_traces(model.compiled, blocking).count);
}

TEST_CASE("a raised stop flag ends the count early and says so") {
  const TextModel model(
      "sort s\ns A, B, C\nfluent On(s)\nevent Press(s)\n[s,time] Initiates(Press(s),On(s),time).\n"
      "range time 0 5\n");
  const std::atomic<bool> stop{true};
  runtime::TraceQuery query;
  query.stop = &stop;
  CHECK_FALSE(runtime::count_traces(model.compiled, query).complete);
}

}  // namespace parallax::test
