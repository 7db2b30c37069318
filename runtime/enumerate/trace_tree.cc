#include "runtime/enumerate/trace_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/enumerate/projection.h"

namespace parallax::runtime {
namespace {

/// A node costs one call for each child and one more, and blocking clauses slow the calls down:
/// with 256 to 1024 children traces come four times as fast as with a level for every timepoint.
constexpr std::size_t kMostChildren = 1024;

}  // namespace

TraceTree::TraceTree(SolverSession& session, std::vector<std::vector<Literal>> levels,
                     std::string name, std::size_t most_children)
    : session_(&session),
      levels_(std::move(levels)),
      name_(std::move(name)),
      most_children_(most_children) {
  std::erase_if(levels_, [](const auto& level) { return level.empty(); });
  if (levels_.empty()) levels_.emplace_back();  // one trace, or none
}

std::optional<Trace> TraceTree::next() {
  if (exhausted_ || stopped_) return std::nullopt;
  if (!std::exchange(started_, true)) stopped_ = !expand();
  if (stopped_) return std::nullopt;
  while (!path_.empty()) {
    auto& node = path_.back();
    assumptions_.erase(assumptions_.begin() + static_cast<std::ptrdiff_t>(node.assumed),
                       assumptions_.end());
    if (node.next == node.children.size()) {
      path_.pop_back();
      continue;
    }
    auto& child = node.children[node.next++];
    if (path_.size() == levels_.size()) {
      child.trace.number = ++found_;
      return std::move(child.trace);
    }
    const auto& level = levels_[path_.size() - 1];
    for (std::size_t i = 0; i < level.size(); ++i) {
      assumptions_.push_back(child.values[i] ? level[i] : ~level[i]);
    }
    stopped_ = !expand();
    if (stopped_) return std::nullopt;
  }
  exhausted_ = true;
  return std::nullopt;
}

/// Adds the node below the path; false if the solver was stopped.
bool TraceTree::expand() {
  const auto level = path_.size();
  while (true) {
    Node node;
    node.assumed = assumptions_.size();
    bool too_many = false;
    if (!find_children(node, too_many)) return false;
    if (too_many) {
      halve(level);
      continue;
    }
    std::sort(node.children.begin(), node.children.end(),
              [](const Child& a, const Child& b) { return a.values < b.values; });
    path_.push_back(std::move(node));
    return true;
  }
}

bool TraceTree::find_children(Node& node, bool& too_many) {
  const auto n = session_->model().horizon;
  const auto& level = levels_[path_.size()];
  const bool is_last = path_.size() + 1 == levels_.size();
  const auto guard = session_->new_variable();
  auto assumed = assumptions_;
  assumed.push_back(guard);
  std::vector<Literal> blocking;
  auto status = SolveStatus::kUnsatisfiable;
  while ((status = session_->solve(n, assumed)) == SolveStatus::kSatisfiable) {
    too_many = node.children.size() == most_children_ && level.size() > 1;
    if (too_many) break;
    auto& child = node.children.emplace_back();
    blocking = {~guard};
    for (const auto atom : level) {
      child.values.push_back(session_->value(atom));
      blocking.push_back(child.values.back() ? ~atom : atom);
    }
    if (is_last) {
      session_->require_model(n);
      child.trace = decode_trace(session_->model(), n,
                                 [&](Literal literal) { return session_->value(literal); });
    }
    session_->add_clause(blocking);
  }
  session_->add_clause(std::vector{~guard});
  return status != SolveStatus::kUnknown;
}

void TraceTree::halve(std::size_t level) {
  auto& atoms = levels_[level];
  const auto middle = atoms.begin() + static_cast<std::ptrdiff_t>(atoms.size() / 2);
  std::vector<Literal> rest(middle, atoms.end());
  atoms.erase(middle, atoms.end());
  levels_.insert(levels_.begin() + static_cast<std::ptrdiff_t>(level) + 1, std::move(rest));
}

SourceStats TraceTree::stats() const {
  SourceStats stats;
  stats.strategy = name_;
  stats.solve_calls = session_->solve_calls();
  return stats;
}

std::unique_ptr<TraceTree> make_trace_tree(SolverSession& session, Distinct distinct) {
  std::vector<Literal> atoms;
  for (const auto& block : projection_blocks(session.model(), distinct)) {
    atoms.insert(atoms.end(), block.begin(), block.end());
  }
  return std::make_unique<TraceTree>(session, std::vector<std::vector<Literal>>{std::move(atoms)},
                                     "tree", kMostChildren);
}

std::unique_ptr<TraceTree> make_guarded_blocking(SolverSession& session, Distinct distinct) {
  const auto blocks = projection_blocks(session.model(), distinct);
  std::vector<std::vector<Literal>> halves(2);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    auto& half = halves[2 * i < blocks.size() ? 0 : 1];
    half.insert(half.end(), blocks[i].begin(), blocks[i].end());
  }
  return std::make_unique<TraceTree>(session, std::move(halves), "guarded",
                                     std::numeric_limits<std::size_t>::max());
}

}  // namespace parallax::runtime
