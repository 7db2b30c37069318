// Traces in canonical order from a layered graph, without a solver.
//
// Edges of a node are in canonical order, so a depth-first walk meets the traces in theirs. Each
// node knows how many ways it has to the last layer: the walk skips edges without one and thus
// never turns back in vain. The same numbers find the k-th trace: at each node, edges are passed
// over and their numbers subtracted from k until the remainder lies within one. Printing keeps
// the text up to the timepoint at which the next trace leaves the last one, and the text of a
// step by its two nodes and its events.
//
// Cost: at most the edges of the nodes on one path for each trace; for the walk only those
// behind the place where two traces part.

#include "runtime/graph/graph_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace parallax::runtime {
namespace {

using compiler::AtomKind;

/// Most bytes of pieces that are kept.
constexpr std::size_t kPieces = std::size_t{64} << 20U;

template <typename Id>
void append_true(const Bits& bits, const std::vector<std::optional<Id>>& ids, std::size_t offset,
                 std::vector<Id>& out) {
  for (std::size_t i = 0; i < ids.size(); ++i) {
    if (bits[offset + i] && ids[i]) out.push_back(*ids[i]);
  }
}

/// By slot: the fluent whose release it is.
std::map<std::uint32_t, compiler::FluentId> releases(const CompiledModel& model) {
  std::map<std::uint32_t, compiler::FluentId> out;
  for (std::uint32_t f = 0; f < model.fluents.size(); ++f) {
    if (model.release_slots[f]) out.emplace(*model.release_slots[f], compiler::FluentId(f));
  }
  return out;
}

}  // namespace

std::string GraphPaths::obstacle(const TraceGraph& graph, const CompiledModel& model) {
  if (!graph.is_determined()) return "hidden atoms differ between traces that look the same";
  for (const auto v : graph.model().open_fixed) {
    const auto& atom = model.fixed[static_cast<std::size_t>(v) - 1];
    if (atom.kind != AtomKind::kPredicate) continue;
    return fmt::format("`{}` is not the same in every trace", atom.name);
  }
  if (graph.model().loose_releases.empty()) return "";
  return "ReleasedAt atoms are free";
}

GraphPaths::GraphPaths(const TraceGraph& graph, const CompiledModel& model)
    : graph_(graph), symbols_(symbols_of(model)) {
  const auto& layered = graph.model();
  for (std::uint32_t f = 0; f < model.fluents.size(); ++f) {
    if (model.fluents[f].slot) fluents_.emplace_back(compiler::FluentId(f));
  }
  for (std::uint32_t e = 0; e < model.events.size(); ++e) {
    if (model.events[e].slot) events_.emplace_back(compiler::EventId(e));
  }
  const auto released = releases(model);
  const auto release_of = [&](std::uint32_t slot) {
    const auto found = released.find(slot);
    return found == released.end() ? std::nullopt : std::optional(found->second);
  };
  for (auto i = fluents_.size(); i < layered.observed.size(); ++i) {
    released_in_observed_.push_back(release_of(layered.observed[i]));
  }
  for (const auto slot : layered.hidden) released_in_hidden_.push_back(release_of(slot));
  for (const auto v : layered.true_fixed) {
    const auto& atom = model.fixed[static_cast<std::size_t>(v) - 1];
    if (atom.kind == AtomKind::kPredicate) predicates_.push_back(atom.name);
  }
  std::sort(predicates_.begin(), predicates_.end());
}

void GraphPaths::push(std::uint32_t node) {
  const auto t = static_cast<Timepoint>(path_.size());
  Step step;
  step.node = node;
  if (t < graph_.model().horizon) step.edges = &graph_.edges(t, node);
  path_.push_back(step);
}

/// Takes the first way from `edge` on that leads to a trace.
bool GraphPaths::take_way(Step& step, Timepoint t, std::size_t edge) {
  if (step.edges == nullptr) return false;
  for (; edge < step.edges->size(); ++edge) {
    if (graph_.completions(t + 1, (*step.edges)[edge].target) == 0) continue;
    step.edge = edge;
    return true;
  }
  return false;
}

/// Goes on from the last step by the first ways.
void GraphPaths::descend() {
  while (path_.back().edges != nullptr) {
    push((*path_.back().edges)[path_.back().edge].target);
    take_way(path_.back(), static_cast<Timepoint>(path_.size()) - 1, 0);
  }
}

bool GraphPaths::advance() {
  if (std::exchange(is_placed_, false)) return true;
  if (is_at_end_) return false;
  while (!path_.empty()) {
    const auto t = path_.size() - 1;
    if (take_way(path_.back(), static_cast<Timepoint>(t), path_.back().edge + 1)) {
      unchanged_ = std::min(unchanged_, t);
      descend();
      return true;
    }
    path_.pop_back();
  }
  unchanged_ = 0;
  for (; start_ < graph_.starts().size(); ++start_) {
    const auto node = graph_.starts()[start_];
    if (graph_.completions(0, node) == 0) continue;
    ++start_;
    push(node);
    take_way(path_.back(), 0, 0);
    descend();
    return true;
  }
  is_at_end_ = true;
  return false;
}

void GraphPaths::seek(mpz_class before) {
  path_.clear();
  unchanged_ = 0;
  number_ = before;
  is_at_end_ = before >= graph_.count();
  is_placed_ = !is_at_end_;
  if (is_at_end_) return;
  const auto skip = [&](Timepoint t, std::uint32_t node) {
    const auto& ways = graph_.completions(t, node);
    if (before < ways) return false;
    before -= ways;
    return true;
  };
  start_ = 0;
  while (skip(0, graph_.starts()[start_])) ++start_;
  push(graph_.starts()[start_++]);
  while (path_.back().edges != nullptr) {
    auto& step = path_.back();
    while (skip(static_cast<Timepoint>(path_.size()), (*step.edges)[step.edge].target)) ++step.edge;
    push((*step.edges)[step.edge].target);
  }
}

const TracePoint& GraphPaths::state(std::uint32_t node) {
  const auto [entry, added] = states_.try_emplace(node);
  auto& point = entry->second;
  if (!added) return point;
  const auto& bits = graph_.node(node);
  append_true(bits.observed, fluents_, 0, point.holds);
  append_true(bits.observed, released_in_observed_, fluents_.size(), point.released);
  append_true(bits.hidden.front(), released_in_hidden_, 0, point.released);
  std::sort(point.released.begin(), point.released.end());
  return point;
}

GraphPaths::Shown GraphPaths::shown(std::size_t t) const {
  const auto& step = path_[t];
  return {t == 0 ? 0 : path_[t - 1].node + 1, step.node,
          step.edges == nullptr ? 0 : (*step.edges)[step.edge].events + 1};
}

TracePoint GraphPaths::point(const Shown& shown) {
  auto point = state(shown.node);
  if (shown.events == 0) return point;
  append_true(graph_.events(shown.events - 1), events_, 0, point.happens);
  return point;
}

std::optional<Trace> GraphPaths::next() {
  if (!advance()) return std::nullopt;
  ++number_;
  Trace trace;
  trace.symbols = symbols_;
  trace.number = number_.fits_slong_p() ? number_.get_si() : 0;
  for (std::size_t t = 0; t < path_.size(); ++t) trace.points.push_back(point(shown(t)));
  trace.predicates = predicates_;
  return trace;
}

std::size_t GraphPaths::ShownHash::operator()(const Shown& shown) const {
  std::uint64_t hash = 0;
  for (const auto part : {shown.before, shown.node, shown.events}) {
    hash = (hash ^ part) * 0x9E3779B97F4A7C15U;
    hash ^= hash >> 29U;
  }
  return hash;
}

const std::string& GraphPaths::piece(const TraceFormat& format, std::size_t t) {
  if (pieces_size_ > kPieces) {
    pieces_.clear();
    pieces_size_ = 0;
  }
  const auto key = shown(t);
  const auto [entry, added] = pieces_.try_emplace(key);
  if (!added) return entry->second;
  const auto* before = key.before == 0 ? nullptr : &state(key.before - 1);
  entry->second = format.point(*symbols_, before, point(key));
  pieces_size_ += entry->second.size() + sizeof(*entry);
  return entry->second;
}

bool GraphPaths::print_next(const TraceFormat& format, std::string& out) {
  if (!advance()) return false;
  ++number_;
  if (format_ != &format) {
    format_ = &format;
    pieces_.clear();
    pieces_size_ = 0;
    unchanged_ = 0;
  }
  body_.resize(unchanged_ == 0 ? 0 : path_[unchanged_ - 1].printed);
  for (auto t = unchanged_; t < path_.size(); ++t) {
    body_ += format.introduction(static_cast<Timepoint>(t));
    body_ += piece(format, t);
    path_[t].printed = body_.size();
  }
  unchanged_ = path_.size();
  out += format.head(number_.get_str(), {});
  out += body_;
  out += format.tail(predicates_);
  return true;
}

SourceStats GraphPaths::stats() const {
  SourceStats stats;
  stats.strategy = "graph";
  stats.states = graph_.node_count();
  stats.transitions = graph_.edge_count();
  stats.solve_calls = graph_.solve_calls();
  return stats;
}

}  // namespace parallax::runtime
