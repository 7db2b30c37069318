// Completed atoms that are reasons of each other, so that they may be true for no further
// reason.
//
// The reasons of each atom are distributed into conjunctions of literals. Three passes remove
// atoms that can be in no such circle: those that nothing can bring about (all their reasons ask
// for a removed atom), those with a reason that asks for certain atoms alone, and those that no
// open atom is a reason of. Among the rest a depth-first search looks for a circle whose
// literals do not contradict each other. A model without circles is tight, and completion then
// admits no unfounded atoms (Fages 1994).
//
// Cost: the first pass is linear in the reasons, the other two sweep over them until nothing
// changes. The search has a budget of steps and finds circles of up to 8 atoms; circles of the
// same axioms are reported once, at most 10 in all.

#include "compiler/ground/support_loops.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "compiler/base/codes/grounding.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostReasons = 200'000;
constexpr std::size_t kMostOfOne = 2'000;  // conjunctions that one formula is distributed into
constexpr Timepoint kMostCopies = 8;       // of a reason that is one at every timepoint
constexpr std::size_t kLongestCircle = 8;  // longer ones are not looked for
constexpr std::size_t kBudget = 200'000;   // steps of the search
constexpr std::size_t kMostWarnings = 10;

}  // namespace

void SupportLoops::add(const GroundAtom& atom, FormulaId reason, Timepoint width,
                       const base::SourceRange& source) {
  const bool always = width != Constraint::kOnce;
  const auto copies = always ? std::min(model_.horizon() - width + 1, kMostCopies) : 1;
  for (Timepoint s = 0; s < copies; ++s) {
    const auto t = atom.time == GroundAtom::kUntimed ? atom.time : atom.time + s;
    add_conjunctions({atom.kind, atom.index, t}, reason, s, source);
  }
}

/// One reason for each conjunction that the formula is distributed into.
void SupportLoops::add_conjunctions(const Key& head, FormulaId root, Timepoint steps,
                                    const base::SourceRange& source) {
  struct Part {
    std::vector<FormulaId> todo;
    std::vector<Literal> literals;
  };
  const auto& formulas = model_.formulas();
  std::vector<Part> parts = {{{root}, {}}};
  std::size_t made = 0;
  while (!parts.empty()) {
    auto part = std::move(parts.back());
    parts.pop_back();
    if (part.todo.empty()) {
      by_head_[head].push_back(reasons_.size());
      reasons_.push_back({head, std::move(part.literals), source});
      full_ = full_ || ++made > kMostOfOne || reasons_.size() >= kMostReasons;
      if (full_) return;
      continue;
    }
    const auto formula = part.todo.back();
    part.todo.pop_back();
    if (formula == formulas.falsity()) continue;
    if (formulas.kind(formula) == FormulaNodeKind::kAtom) {
      const auto& atom = model_.atom(formulas.variable(formula));
      const auto t = atom.time == GroundAtom::kUntimed ? atom.time : atom.time + steps;
      part.literals.push_back({{atom.kind, atom.index, t}, !formula.negated()});
    } else if (formulas.kind(formula) == FormulaNodeKind::kAnd && formula.negated()) {
      for (const auto child : formulas.children(formula)) {
        parts.push_back(part);
        parts.back().todo.push_back(~child);
      }
      continue;
    } else if (formulas.kind(formula) == FormulaNodeKind::kAnd) {
      const auto children = formulas.children(formula);
      part.todo.insert(part.todo.end(), children.begin(), children.end());
    }
    parts.push_back(std::move(part));
  }
}

void SupportLoops::settle(const std::function<bool(const GroundAtom&)>& completes) {
  const auto note = [&](const Key& key) {
    if (completes({std::get<0>(key), std::get<1>(key), std::get<2>(key)})) open_.insert(key);
  };
  for (const auto& reason : reasons_) {
    note(reason.head);
    for (const auto& literal : reason.literals) note(literal.atom);
  }
  drop_impossible();
  drop_certain();
  drop_ends();
}

/// Atoms all of whose reasons ask for an impossible atom.
void SupportLoops::drop_impossible() {
  std::map<Key, std::vector<std::size_t>> asked_by;
  std::map<Key, std::size_t> left;
  std::vector<Key> todo;
  for (std::size_t r = 0; r < reasons_.size(); ++r) {
    for (const auto& literal : reasons_[r].literals) {
      if (literal.positive) asked_by[literal.atom].push_back(r);
    }
  }
  for (const auto& key : open_) {
    const auto found = by_head_.find(key);
    left[key] = found == by_head_.end() ? 0 : found->second.size();
    if (left[key] == 0) todo.push_back(key);
  }
  while (!todo.empty()) {
    const auto key = todo.back();
    todo.pop_back();
    open_.erase(key);
    for (const auto r : asked_by[key]) {
      if (std::exchange(reasons_[r].dead, true)) continue;
      const auto head = left.find(reasons_[r].head);
      if (head != left.end() && --head->second == 0) todo.push_back(head->first);
    }
  }
}

/// Atoms with a reason that asks for certain atoms alone.
void SupportLoops::drop_certain() {
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& reason : reasons_) {
      if (reason.dead || !is_open(reason.head)) continue;
      const bool certain =
          std::all_of(reason.literals.begin(), reason.literals.end(), [&](const Literal& literal) {
            return literal.positive && !is_open(literal.atom) && by_head_.contains(literal.atom);
          });
      if (certain) changed = open_.erase(reason.head) > 0 || changed;
    }
  }
}

/// Atoms that no open atom is a reason of.
void SupportLoops::drop_ends() {
  for (bool changed = true; changed;) {
    changed = false;
    for (auto key = open_.begin(); key != open_.end();) {
      const auto& own = by_head_.at(*key);
      const bool goes_on = std::any_of(own.begin(), own.end(), [&](std::size_t r) {
        return !reasons_[r].dead &&
               std::any_of(reasons_[r].literals.begin(), reasons_[r].literals.end(),
                           [&](const Literal& one) { return one.positive && is_open(one.atom); });
      });
      changed = changed || !goes_on;
      key = goes_on ? std::next(key) : open_.erase(key);
    }
  }
}

/// A circle that leads from the atom to itself and can hold, if one is found.
std::optional<SupportLoops::Circle> SupportLoops::circle_from(const Key& start,
                                                              std::size_t& budget) const {
  struct Step {
    Key atom;
    std::size_t reason = 0, literal = 0;  // the next to be tried
  };
  std::vector<Step> path = {{start}};
  std::map<Literal, int> said = {{{start, true}, 1}};
  Circle circle;
  const auto leave = [&](std::size_t r) {
    for (const auto& literal : reasons_[r].literals) --said[literal];
  };
  const auto contradicts = [&](const Literal& literal) {
    const auto found = said.find({literal.atom, !literal.positive});
    return found != said.end() && found->second > 0;
  };
  while (!path.empty() && budget > 0) {
    --budget;
    auto& step = path.back();
    const auto& own = by_head_.at(step.atom);
    if (step.reason == own.size()) {
      path.pop_back();
      if (circle.empty()) continue;
      leave(circle.back());
      circle.pop_back();
      continue;
    }
    const auto r = own[step.reason];
    const auto& reason = reasons_[r];
    if (reason.dead || step.literal == reason.literals.size()) {
      ++step.reason;
      step.literal = 0;
      continue;
    }
    const auto& literal = reason.literals[step.literal++];
    if (!literal.positive || !is_open(literal.atom)) continue;
    if (std::any_of(reason.literals.begin(), reason.literals.end(), contradicts)) {
      ++step.reason;
      step.literal = 0;
      continue;
    }
    const bool closes = literal.atom == start;
    if (closes) {
      circle.push_back(r);
      return circle;
    }
    const bool known = std::any_of(path.begin(), path.end(),
                                   [&](const Step& one) { return one.atom == literal.atom; });
    if (known || path.size() >= kLongestCircle) continue;
    for (const auto& one : reason.literals) ++said[one];
    circle.push_back(r);
    path.push_back({literal.atom});
  }
  return std::nullopt;
}

std::string SupportLoops::text(const Key& key) const {
  const auto& [kind, index, time] = key;
  const auto name = model_.atom_name({kind, index, time});
  if (time == GroundAtom::kUntimed) return name;
  return fmt::format("{}({},{})", to_string(kind), name, time);
}

void SupportLoops::report(const std::function<bool(const GroundAtom&)>& completes,
                          base::DiagnosticSink& sink) {
  if (full_) return;
  settle(completes);
  const auto place = [](const base::SourceRange& range) {
    return std::tuple(range.file, range.begin, range.end);
  };
  std::set<std::set<std::tuple<base::FileId, std::uint32_t, std::uint32_t>>> known;
  auto budget = kBudget;
  for (const auto& start : open_) {
    const auto circle = circle_from(start, budget);
    if (!circle) continue;
    std::map<std::tuple<base::FileId, std::uint32_t, std::uint32_t>, base::SourceRange> axioms;
    for (const auto r : *circle) axioms.emplace(place(reasons_[r].source), reasons_[r].source);
    std::set<std::tuple<base::FileId, std::uint32_t, std::uint32_t>> places;
    for (const auto& [at, range] : axioms) places.insert(at);
    if (!known.insert(std::move(places)).second) continue;
    std::string way;
    for (std::size_t i = 1; i < circle->size(); ++i) {
      way += (way.empty() ? " by way of `" : "`, `") + text(reasons_[(*circle)[i]].head);
    }
    if (!way.empty()) way += '`';
    auto warning = sink.warning(codes::kSupportLoop, axioms.begin()->second, text(start), way);
    for (auto axiom = std::next(axioms.begin()); axiom != axioms.end(); ++axiom) {
      warning.note(axiom->second, "this formula takes part");
    }
    if (known.size() == kMostWarnings) return;
  }
}

}  // namespace parallax::compiler
