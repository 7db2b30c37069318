// Traces that only one of two models has: a witness for either side, and numbers.
//
// A witness comes from difference_finder.cc. It is then improved: as long as some trace is
// excluded by an earlier timepoint it takes the place, questions that the finder leaves open
// going to the second model cut to that horizon; among those the one with the fewest shared
// events before is sought with a counter. The origins that exclude it are shrunk to a minimal
// set, edited axioms being kept to the last.
//
// Numbers: traces are listed up to a limit; beyond it both models are counted by graphs
// (trace_graph.cc), and the common traces by the product of the graphs: pairs of nodes that the
// same observations reach, layer by layer, counted backwards. What is lost is the difference.
// Cost: pairs times their edges, and a few calls for each improvement.

#include "runtime/compare/trace_difference.h"

#include <gmpxx.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "runtime/graph/trace_graph.h"
#include "runtime/session/solver_session.h"

namespace parallax::runtime {

using compiler::CompiledModel;
using compiler::GroundName;

namespace {

using NodePair = std::pair<std::uint32_t, std::uint32_t>;

/// For every bit of a graph's vectors its number among the names of all.
class BitNames {
 public:
  BitNames(const std::vector<GroundName>& names,
           const std::map<std::string_view, std::uint32_t>& all) {
    for (const auto& name : names) {
      if (name.slot) numbers_.push_back(all.at(name.name));
    }
  }
  std::vector<std::uint32_t> true_names(const Bits& bits) const {
    std::vector<std::uint32_t> out;
    for (std::size_t i = 0; i < bits.size(); ++i) {
      if (bits[i]) out.push_back(numbers_[i]);
    }
    std::sort(out.begin(), out.end());
    return out;
  }

 private:
  std::vector<std::uint32_t> numbers_;
};

std::map<std::string_view, std::uint32_t> numbered(const std::vector<GroundName>& names) {
  std::map<std::string_view, std::uint32_t> out;
  for (const auto& name : names) out.emplace(name.name, static_cast<std::uint32_t>(out.size()));
  return out;
}

/// One graph with states and events in the numbers of both.
class Side {
 public:
  Side(const TraceGraph& graph, const CompiledModel& model,
       const std::map<std::string_view, std::uint32_t>& fluents,
       const std::map<std::string_view, std::uint32_t>& events)
      : graph_(graph), fluents_(model.fluents, fluents), events_(model.events, events) {}

  using Label = std::pair<std::vector<std::uint32_t>, std::vector<std::uint32_t>>;
  const TraceGraph& graph() const { return graph_; }
  std::vector<std::uint32_t> state(std::uint32_t node) const {
    return fluents_.true_names(graph_.node(node).observed);
  }
  /// The events of an edge and the fluents that hold after it; each label leads to one node.
  Label label(const GraphEdge& edge) const {
    return {events_.true_names(graph_.events(edge.events)), state(edge.target)};
  }

 private:
  const TraceGraph& graph_;
  BitNames fluents_, events_;
};

/// Pairs of nodes that are reached by the same observations, layer by layer; then counted back.
class CommonPaths {
 public:
  CommonPaths(const Side& first, const Side& second) : first_(first), second_(second) {}

  mpz_class count() {
    const auto horizon = first_.graph().model().horizon;
    std::vector<std::map<NodePair, std::vector<NodePair>>> layers;
    layers.emplace_back();
    for (const auto& pair : starts()) layers.back()[pair];
    for (Timepoint t = 0; t < horizon; ++t) {
      std::map<NodePair, std::vector<NodePair>> next;
      for (auto& [pair, ways] : layers.back()) {
        ways = common_ways(t, pair);
        for (const auto& way : ways) next[way];
      }
      layers.push_back(std::move(next));
    }
    std::map<NodePair, mpz_class> counts;
    for (const auto& [pair, ways] : layers.back()) counts[pair] = is_live(horizon, pair) ? 1 : 0;
    for (Timepoint t = horizon; t-- > 0;) {
      std::map<NodePair, mpz_class> before;
      for (const auto& [pair, ways] : layers[static_cast<std::size_t>(t)]) {
        auto& sum = before[pair];
        for (const auto& way : ways) sum += counts[way];
      }
      counts = std::move(before);
    }
    mpz_class total;
    for (const auto& [pair, count] : counts) total += count;
    return total;
  }

 private:
  bool is_live(Timepoint t, const NodePair& pair) const {
    return first_.graph().completions(t, pair.first) != 0 &&
           second_.graph().completions(t, pair.second) != 0;
  }

  std::vector<NodePair> starts() const {
    std::map<std::vector<std::uint32_t>, std::uint32_t> others;
    for (const auto node : second_.graph().starts()) others.emplace(second_.state(node), node);
    std::vector<NodePair> out;
    for (const auto node : first_.graph().starts()) {
      const auto found = others.find(first_.state(node));
      if (found != others.end() && is_live(0, {node, found->second})) {
        out.emplace_back(node, found->second);
      }
    }
    return out;
  }

  std::vector<NodePair> common_ways(Timepoint t, const NodePair& from) const {
    std::map<Side::Label, std::uint32_t> others;
    for (const auto& edge : second_.graph().edges(t, from.second)) {
      others.emplace(second_.label(edge), edge.target);
    }
    std::vector<NodePair> out;
    for (const auto& edge : first_.graph().edges(t, from.first)) {
      const auto found = others.find(first_.label(edge));
      if (found == others.end()) continue;
      const NodePair way{edge.target, found->second};
      if (is_live(t + 1, way)) out.push_back(way);
    }
    return out;
  }

  const Side& first_;
  const Side& second_;
};

/// The number of traces that both graphs have. They are compared by the names of the true atoms, so
/// both models must have the same ground fluents and events. Cost: pairs of nodes that a common
/// prefix reaches, times their edges.
mpz_class count_common(const TraceGraph& first, const CompiledModel& first_model,
                       const TraceGraph& second, const CompiledModel& second_model) {
  const auto fluents = numbered(first_model.fluents), events = numbered(first_model.events);
  const Side a(first, first_model, fluents, events), b(second, second_model, fluents, events);
  return CommonPaths(a, b).count();
}

/// A minimal set of origins (indices, ascending) whose clauses up to timepoint `by` cannot hold
/// together with the observation: dropping any one of them lets it pass. Origins for which
/// `dispensable` says yes are dropped first, so that those of them that remain are needed with all
/// others at hand. Empty if the solver was stopped. The observation is no trace of the model.
/// Cost: a solver call for each member of the first core.
std::vector<std::uint32_t> excluding_origins(const compiler::CompiledModel& model,
                                             compiler::Timepoint by,
                                             std::span<const compiler::Literal> observation,
                                             const std::function<bool(std::uint32_t)>& dispensable,
                                             const std::atomic<bool>* stop);

std::vector<std::uint32_t> excluding_origins(const compiler::CompiledModel& model,
                                             compiler::Timepoint by,
                                             std::span<const Literal> observation,
                                             const std::function<bool(std::uint32_t)>& dispensable,
                                             const std::atomic<bool>* stop) {
  SelectedOrigins selected(model, by, make_cadical_solver(stop));
  for (const auto literal : observation) selected.require(literal);
  // Candidates are tried from the end.
  std::vector<std::uint32_t> candidates;
  for (const bool last : {false, true}) {
    for (std::uint32_t i = 0; i < model.origins.size(); ++i) {
      if (dispensable(i) == last) candidates.push_back(i);
    }
  }
  if (selected.solve(candidates) != SolveStatus::kUnsatisfiable) return {};
  auto needed = shrink_to_needed(selected, std::move(candidates));
  if (needed.stopped) return {};
  return std::move(needed.origins);
}

/// Counters larger than this are not built; the witness may then have more events than needed.
constexpr std::size_t kMaxCounter = 4'000'000;

std::string describe(const SharedAtom& atom, const SharedVocabulary& vocabulary) {
  return std::string(atom.kind == AtomKind::kHappens ? "Happens " : "HoldsAt ") +
         vocabulary.names[atom.name] + " " + std::to_string(atom.time);
}

/// One direction: the traces that the first model has and the second does not have.
class Direction {
 public:
  Direction(const CompiledModel& first, const CompiledModel& second, SharedVocabulary vocabulary,
            std::shared_ptr<const Definitions> of_first,
            std::shared_ptr<const Definitions> of_second, const std::vector<bool>& second_edited,
            const DifferenceOptions& options)
      : first_(first),
        second_(second),
        vocabulary_(std::move(vocabulary)),
        edited_(second_edited),
        options_(options),
        of_first_(std::move(of_first)),
        finder_(first, of_first_, second, std::move(of_second), vocabulary_,
                options.max_refinements, options.stop) {}

  OneSided run() {
    OneSided out;
    out.answer = options_.counts_only ? finder_.find_any() : finder_.find();
    if (out.answer == DifferenceAnswer::kFound) {
      if (!options_.counts_only) {
        keep(finder_);
        find_earliest();
        explain();
        out.witness = std::move(witness_);
      }
      if (!options_.any_difference) list(out.count);
    } else if (out.answer == DifferenceAnswer::kNone) {
      out.count.exact = true;
    }
    out.solve_calls = solve_calls_ + finder_.solve_calls();
    out.refinements = refinements_ + finder_.refinements();
    return out;
  }

 private:
  void keep(const DifferenceFinder& finder) {
    witness_.trace = finder.trace();
    witness_.excluded_by = finder.excluded_by();
    witness_.events = finder.events_before(witness_.excluded_by);
    observation_ = finder.observation();
    const auto impossible = finder.impossible();
    witness_.impossible =
        impossible ? std::optional(describe(*impossible, vocabulary_)) : std::nullopt;
  }

  /// The present finder answers most questions for earlier timepoints; questions that it leaves
  /// open go to the truncated second model.
  void find_earliest() {
    for (;;) {
      auto answer = DifferenceAnswer::kNone;
      if (witness_.excluded_by > 0) answer = finder_.find(witness_.excluded_by - 1);
      if (answer == DifferenceAnswer::kFound) {
        keep(finder_);
        continue;
      }
      if (answer == DifferenceAnswer::kUnknown && find_exactly(witness_.excluded_by - 1)) continue;
      break;
    }
    find_fewest_events();
  }

  /// True if the witness got better.
  bool find_exactly(Timepoint by) {
    const auto second = truncated(second_, by);
    DifferenceFinder finder(first_, of_first_, second, of_truncated(second), vocabulary_,
                            options_.max_refinements, options_.stop);
    const auto answer = finder.find();
    if (answer == DifferenceAnswer::kFound) keep(finder);
    note(finder, answer);
    return answer == DifferenceAnswer::kFound;
  }

  void find_fewest_events() {
    if (witness_.events == 0) return;
    const auto by = witness_.excluded_by;
    const auto happens = std::count_if(
        vocabulary_.shared.begin(), vocabulary_.shared.end(),
        [&](const SharedAtom& atom) { return atom.kind == AtomKind::kHappens && atom.time < by; });
    if (static_cast<std::size_t>(happens) * witness_.events > kMaxCounter) {
      witness_.is_shortest = false;
      return;
    }
    const auto second = truncated(second_, by);
    DifferenceFinder finder(first_, of_first_, second, of_truncated(second), vocabulary_,
                            options_.max_refinements, options_.stop);
    auto answer = DifferenceAnswer::kFound;
    while (answer == DifferenceAnswer::kFound) {
      answer = finder.find_with_fewer(witness_.events);
      if (answer == DifferenceAnswer::kFound) keep(finder);
    }
    note(finder, answer);
  }

  std::shared_ptr<const Definitions> of_truncated(const CompiledModel& second) const {
    return definitions_for(second, vocabulary_, &SharedAtom::second, options_.stop);
  }

  void note(const DifferenceFinder& finder, DifferenceAnswer answer) {
    solve_calls_ += finder.solve_calls();
    refinements_ += finder.refinements();
    if (answer == DifferenceAnswer::kUnknown) witness_.is_shortest = false;
  }

  void explain() {
    if (witness_.impossible) return;
    witness_.excluding = excluding_origins(
        second_, witness_.excluded_by, observation_,
        [&](std::uint32_t origin) { return origin < edited_.size() && edited_[origin]; },
        options_.stop);
  }

  void list(TraceNumber& count) {
    auto answer = DifferenceAnswer::kFound;
    while (count.value < options_.list_limit) {
      answer = finder_.find_any();
      if (answer != DifferenceAnswer::kFound) break;
      ++count.value;
      finder_.block();
    }
    count.exact = answer == DifferenceAnswer::kNone;
    if (count.value == 0) count.value = 1;  // the witness itself
  }

  const CompiledModel& first_;
  const CompiledModel& second_;
  const SharedVocabulary vocabulary_;
  const std::vector<bool>& edited_;
  const DifferenceOptions& options_;
  const std::shared_ptr<const Definitions> of_first_;
  DifferenceFinder finder_;
  Witness witness_;
  std::vector<Literal> observation_;
  std::int64_t solve_calls_ = 0;  // of finders for truncated models
  std::size_t refinements_ = 0;
};

/// A graph with the model that it looks into.
struct Graph {
  LayeredModel layered;
  std::unique_ptr<TraceGraph> graph;
};

/// Null where the model has none or the limits are hit.
std::unique_ptr<Graph> graph_of(const CompiledModel& model, const DifferenceOptions& options) {
  auto split = split_into_windows(model, Distinct::kObservable);
  if (!std::holds_alternative<LayeredModel>(split)) return nullptr;
  auto out = std::make_unique<Graph>();
  out->layered = std::get<LayeredModel>(std::move(split));
  std::string reason;
  out->graph = TraceGraph::build(out->layered, options.graph, options.stop, reason);
  return out->graph == nullptr ? nullptr : std::move(out);
}

base::Known has_traces(const CompiledModel& model, const DifferenceOptions& options) {
  SolverSession session(model, make_cadical_solver(options.stop));
  return possible(session.solve(model.horizon, {}));
}

/// Exact numbers where the graphs of both models are small. The graph of a model without traces is
/// not to be built, and not needed.
void count_with_graphs(const CompiledModel& first, const CompiledModel& second,
                       const DifferenceOptions& options, TraceDifference& out) {
  const auto has_first = has_traces(first, options), has_second = has_traces(second, options);
  if (has_first == base::Known::kUndecided || has_second == base::Known::kUndecided) return;
  const bool no_first = has_first == base::Known::kNo;
  const bool no_second = has_second == base::Known::kNo;
  const auto a = no_first ? nullptr : graph_of(first, options);
  if (a == nullptr && !no_first) return;
  const auto b = no_second ? nullptr : graph_of(second, options);
  if (b == nullptr && !no_second) return;
  const mpz_class of_first = a == nullptr ? mpz_class(0) : a->graph->count();
  const mpz_class of_second = b == nullptr ? mpz_class(0) : b->graph->count();
  mpz_class common = 0;
  if (a != nullptr && b != nullptr) common = count_common(*a->graph, first, *b->graph, second);
  out.first_count = TraceNumber{of_first, true};
  out.second_count = TraceNumber{of_second, true};
  out.lost.count = {of_first - common, true};
  out.gained.count = {of_second - common, true};
}

}  // namespace

const CompiledModel& ComparedModel::up_to(Timepoint horizon) {
  if (horizon == model_->horizon) return *model_;
  if (shorter_ == nullptr || shorter_->horizon != horizon) {
    shorter_ = std::make_unique<const CompiledModel>(truncated(*model_, horizon));
  }
  return *shorter_;
}

std::shared_ptr<const Definitions> ComparedModel::definitions(
    const SharedVocabulary& vocabulary, std::optional<Literal> SharedAtom::*side, Timepoint horizon,
    const std::atomic<bool>* stop) {
  const auto& model = up_to(horizon);
  auto observed = observed_in(model, vocabulary, side);
  auto& known = known_[{horizon, observed}];
  if (known == nullptr) {
    known = std::make_shared<const Definitions>(find_definitions(model, observed, stop));
  }
  return known;
}

TraceDifference compare_traces(ComparedModel& first, ComparedModel& second,
                               const DifferenceOptions& options) {
  TraceDifference out;
  out.horizon = std::min(first.model().horizon, second.model().horizon);
  const auto& a = first.up_to(out.horizon);
  const auto& b = second.up_to(out.horizon);
  out.vocabulary = shared_vocabulary(a, b, out.horizon);
  const auto of_a =
      first.definitions(out.vocabulary, &SharedAtom::first, out.horizon, options.stop);
  const auto of_b =
      second.definitions(out.vocabulary, &SharedAtom::second, out.horizon, options.stop);
  out.lost = Direction(a, b, out.vocabulary, of_a, of_b, options.second_edited, options).run();
  if (options.any_difference && out.lost.answer == DifferenceAnswer::kFound) return out;
  out.gained =
      Direction(b, a, exchanged(out.vocabulary), of_b, of_a, options.first_edited, options).run();
  const bool open = !out.lost.count.exact || !out.gained.count.exact;
  if (options.any_difference) return out;
  if (open && out.vocabulary.is_same()) count_with_graphs(a, b, options, out);
  return out;
}

TraceDifference compare_traces(const CompiledModel& first, const CompiledModel& second,
                               const DifferenceOptions& options) {
  ComparedModel a(first), b(second);
  return compare_traces(a, b, options);
}

}  // namespace parallax::runtime
