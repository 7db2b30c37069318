// A temporal formula over finite traces as a deterministic run through sets of goals.
//
// A goal is a node of the formula or its negation. A goal at t expands into choices: which goals
// remain for t + 1, and under which condition on t (always F: F now and the same goal later; F
// until G: G now, or F now and the same goal later). A state is a set of goals, a conjunction.
// The states that a trace so far allows are followed together, one variable for each state and
// timepoint, so the value for every end n is read off one run forwards, instead of one unrolled
// formula for each end. Choices that ask for more than another one with the same condition are
// left out.
//
// Cost: linear in the horizon, exponential in the operators at worst; the number of steps is
// limited, and the caller then unrolls the formula for each end. Operators about the past stay
// leaves.

#include "compiler/pipeline/temporal_automaton.h"

#include <algorithm>
#include <set>
#include <utility>

namespace parallax::compiler {
namespace {

using Kind = TemporalTree::Kind;

Kind dual(Kind kind) {
  switch (kind) {
    case Kind::kAnd:
      return Kind::kOr;
    case Kind::kOr:
      return Kind::kAnd;
    case Kind::kAll:
      return Kind::kAny;
    case Kind::kAny:
      return Kind::kAll;
    case Kind::kAlways:
      return Kind::kEventually;
    case Kind::kEventually:
      return Kind::kAlways;
    case Kind::kNext:
      return Kind::kWeakNext;
    case Kind::kWeakNext:
      return Kind::kNext;
    case Kind::kUntil:
      return Kind::kRelease;
    case Kind::kRelease:
      return Kind::kUntil;
    case Kind::kLeaf:
    case Kind::kHistorically:
    case Kind::kOnce:
    case Kind::kPreviously:
    case Kind::kWeakPreviously:
    case Kind::kSince:
    case Kind::kTriggered:
    case Kind::kAtStart:
      return kind;  // a leaf here, whose value is negated
  }
  return kind;
}

bool is_junction(Kind kind) { return kind >= Kind::kAnd && kind <= Kind::kAny; }
bool is_conjunction(Kind kind) { return kind == Kind::kAnd || kind == Kind::kAll; }

}  // namespace

TemporalAutomaton::TemporalAutomaton(const TemporalTree& tree,
                                     const std::vector<TemporalValues>& values,
                                     FormulaStore& formulas, Timepoint horizon)
    : tree_(tree), values_(values), formulas_(formulas), horizon_(horizon) {}

bool TemporalAutomaton::build(Number root, bool negated, std::size_t most) {
  if (!is_taken(root)) return false;
  root_ = root * 2 + (negated ? 1 : 0);
  most_ = most;
  std::set<Goals> states = {{root_}};
  for (Timepoint t = 0; t < horizon_ && speaks(root, 0); ++t) {
    expanded_.clear();
    std::set<Goals> next;
    auto& steps = steps_.emplace_back();
    for (const auto& state : states) {
      Choices choices = {{{}, formulas_.truth()}};
      for (const auto goal : state) choices = both(choices, expand(goal, t));
      size_ += choices.size();
      if (too_large_ || size_ > most_) return false;
      for (const auto& [to, guard] : choices) {
        steps.push_back({state, to, guard});
        next.insert(to);
      }
    }
    states = std::move(next);
  }
  return true;
}

TemporalAutomaton::Values TemporalAutomaton::values(
    const std::function<FormulaId(FormulaId)>& name) const {
  Values out(static_cast<std::size_t>(horizon_) + 1);
  if (!speaks(root_ / 2, 0)) return out;
  std::map<Goals, FormulaId> states = {{{root_}, formulas_.truth()}};
  for (Timepoint t = 0; t <= horizon_; ++t) {
    std::vector<FormulaId> fulfilled;
    for (const auto& [state, reached] : states) {
      std::vector<FormulaId> all = {reached};
      for (const auto goal : state) all.push_back(at_end(goal, t));
      fulfilled.push_back(formulas_.conjunction(std::move(all)));
    }
    out[static_cast<std::size_t>(t)] = formulas_.disjunction(std::move(fulfilled));
    if (t == horizon_) break;
    std::map<Goals, std::vector<FormulaId>> ways;
    for (const auto& step : steps_[static_cast<std::size_t>(t)]) {
      const auto from = states.find(step.from);
      if (from == states.end()) continue;
      ways[step.to].push_back(formulas_.conjunction(from->second, step.guard));
    }
    states.clear();
    for (auto& [state, reached] : ways) {
      const auto any = formulas_.disjunction(std::move(reached));
      if (any != formulas_.falsity()) states.emplace(state, name(any));
    }
  }
  return out;
}

bool TemporalAutomaton::is_taken(Number root) const {
  std::set<Number> seen;
  std::vector<Number> todo = {root};
  while (!todo.empty()) {
    const auto number = todo.back();
    todo.pop_back();
    const auto& node = tree_[number];
    if (!node.looks_on || !seen.insert(number).second) continue;
    if (node.kind >= Kind::kHistorically) return false;
    const bool next = node.kind == Kind::kNext || node.kind == Kind::kWeakNext;
    if (next && speaks_from(node.children[0]) > 1) return false;
    todo.insert(todo.end(), node.children.begin(), node.children.end());
  }
  return true;
}

/// The first timepoint from which on the node always says something.
Timepoint TemporalAutomaton::speaks_from(Number number) const {
  const auto& node = tree_[number];
  if (!node.looks_on) {
    Timepoint from = 0;
    for (Timepoint t = 0; t <= horizon_; ++t) {
      if (!values_[number].ends[static_cast<std::size_t>(t)]) from = t + 1;
    }
    return from;
  }
  Timepoint from = 0;
  if (is_junction(node.kind)) {
    for (const auto child : node.children) from = std::max(from, speaks_from(child));
  }
  return from;
}

bool TemporalAutomaton::speaks(Number number, Timepoint t) const {
  const auto& node = tree_[number];
  if (!node.looks_on) return values_[number].ends[static_cast<std::size_t>(t)].has_value();
  if (!is_junction(node.kind)) return true;
  const auto says = [&](Number child) { return speaks(child, t); };
  const bool quantified = node.kind == Kind::kAll || node.kind == Kind::kAny;
  return quantified ? std::any_of(node.children.begin(), node.children.end(), says)
                    : std::all_of(node.children.begin(), node.children.end(), says);
}

/// Expands a goal for a trace that goes on after t. The node must have a value there.
TemporalAutomaton::Choices TemporalAutomaton::expand(Goal goal, Timepoint t) {
  if (const auto known = expanded_.find(goal); known != expanded_.end()) return known->second;
  const auto& node = tree_[goal / 2];
  const bool negated = goal % 2 != 0;
  const Choices nothing, done = {{{}, formulas_.truth()}};
  const auto part = [&](std::size_t i, bool otherwise) {
    const auto child = node.children[i];
    if (!speaks(child, t)) return otherwise ? done : nothing;
    return expand(child * 2 + goal % 2, t);
  };
  const auto later = [&](Goal what) { return Choices{{{what}, formulas_.truth()}}; };
  Choices out;
  if (!node.looks_on) {
    const auto value = *values_[goal / 2].goes_on[static_cast<std::size_t>(t)];
    const auto guard = negated ? ~value : value;
    if (guard != formulas_.falsity()) out = {{{}, guard}};
    return out;
  }
  const auto kind = negated ? dual(node.kind) : node.kind;
  if (is_junction(kind)) {
    if (is_conjunction(kind)) out = done;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      if (!speaks(node.children[i], t)) continue;
      out =
          is_conjunction(kind) ? both(out, part(i, true)) : either(std::move(out), part(i, false));
    }
  } else if (kind == Kind::kAlways) {
    out = both(part(0, true), later(goal));
  } else if (kind == Kind::kEventually) {
    out = either(part(0, false), later(goal));
  } else if (kind == Kind::kUntil) {
    out = either(part(1, false), both(part(0, true), later(goal)));
  } else if (kind == Kind::kRelease) {
    out = both(part(1, true), either(part(0, false), later(goal)));
  } else {
    out = later(node.children[0] * 2 + goal % 2);
  }
  expanded_.emplace(goal, out);
  return out;
}

TemporalAutomaton::Choices TemporalAutomaton::both(const Choices& a, const Choices& b) {
  Choices out;
  if (too_large_ || a.size() * b.size() > most_) {
    too_large_ = true;
    return out;
  }
  for (const auto& [first, guard] : a) {
    for (const auto& [second, other] : b) {
      const auto all = formulas_.conjunction(guard, other);
      if (all == formulas_.falsity()) continue;
      Goals goals;
      std::set_union(first.begin(), first.end(), second.begin(), second.end(),
                     std::back_inserter(goals));
      const auto [known, added] = out.try_emplace(std::move(goals), all);
      if (!added) known->second = formulas_.disjunction(known->second, all);
    }
  }
  prune(out);
  return out;
}

TemporalAutomaton::Choices TemporalAutomaton::either(Choices a, const Choices& b) {
  for (const auto& [goals, guard] : b) {
    const auto [known, added] = a.try_emplace(goals, guard);
    if (!added) known->second = formulas_.disjunction(known->second, guard);
  }
  prune(a);
  return a;
}

/// Leaves out what asks for more than another choice that may be made whenever it may.
void TemporalAutomaton::prune(Choices& choices) const {
  if (choices.size() * choices.size() > most_) return;
  const auto is_less = [&](const auto& less, const auto& more) {
    return less.first.size() < more.first.size() &&
           (less.second == formulas_.truth() || less.second == more.second) &&
           std::includes(more.first.begin(), more.first.end(), less.first.begin(),
                         less.first.end());
  };
  for (auto more = choices.begin(); more != choices.end();) {
    const bool idle = std::any_of(choices.begin(), choices.end(),
                                  [&](const auto& less) { return is_less(less, *more); });
    more = idle ? choices.erase(more) : std::next(more);
  }
}

/// Value of a goal for a trace that ends at t. The node must have a value there.
FormulaId TemporalAutomaton::at_end(Goal goal, Timepoint t) const {
  const auto& node = tree_[goal / 2];
  const bool negated = goal % 2 != 0;
  if (!node.looks_on) {
    const auto value = *values_[goal / 2].ends[static_cast<std::size_t>(t)];
    return negated ? ~value : value;
  }
  const auto part = [&](std::size_t i, bool otherwise) {
    const auto child = node.children[i];
    return speaks(child, t) ? at_end(child * 2 + goal % 2, t) : formulas_.constant(otherwise);
  };
  const auto kind = negated ? dual(node.kind) : node.kind;
  if (is_junction(kind)) {
    std::vector<FormulaId> parts;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      if (speaks(node.children[i], t)) parts.push_back(part(i, true));
    }
    return is_conjunction(kind) ? formulas_.conjunction(std::move(parts))
                                : formulas_.disjunction(std::move(parts));
  }
  if (kind == Kind::kAlways) return part(0, true);
  if (kind == Kind::kEventually) return part(0, false);
  if (kind == Kind::kUntil) return part(1, false);
  if (kind == Kind::kRelease) return part(1, true);
  return formulas_.constant(kind == Kind::kWeakNext);
}

}  // namespace parallax::compiler
