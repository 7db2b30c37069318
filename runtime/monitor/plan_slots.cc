// Makes the atoms of a plan's control slots of the state, so that equal steps have equal
// clauses.
//
// A compiled model has the plan's locations, outcomes and registers at single timepoints as
// fixed variables. Here each gets a slot in the block of every timepoint; where the model has no
// such atom the slot is false. An auxiliary may be shared by clauses that bind at different
// timepoints, so each of these gets a copy of its own with all the definitions it needs.
// Literals are ordered by their place as the step sees it, auxiliaries by a hash of their
// meaning, so that the order does not depend on numbers. A clause that binds later than its
// atoms need gets one more literal, a slot that is false everywhere. Clauses that say where a
// trace ends are left out.
//
// Cost: linear in the clauses and the copies of definitions but for look-ups and sorting.

#include "runtime/monitor/plan_slots.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace parallax::runtime {
namespace {

using compiler::Atom;
using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::Literal;
using compiler::PlanAtom;
using compiler::Timepoint;

bool is_of_state(const Atom& atom) {
  switch (atom.kind) {
    case AtomKind::kLocation:
    case AtomKind::kSucceeded:
    case AtomKind::kResult:
    case AtomKind::kRegister:
      return atom.time.has_value();
    case AtomKind::kHoldsAt:
    case AtomKind::kHappens:
    case AtomKind::kReleasedAt:
    case AtomKind::kPredicate:
    case AtomKind::kHit:
    case AtomKind::kRunning:
    case AtomKind::kAuxiliary:
    case AtomKind::kUnused:
      break;
  }
  return false;
}

class SlotWriter {
 public:
  explicit SlotWriter(const CompiledModel& model) : model_(model) {}

  CompiledModel run() && {
    name_slots();
    write_symbols();
    write_clauses();
    return std::move(out_);
  }

 private:
  using Key = std::pair<AtomKind, PlanAtom>;
  /// A slot that is false at every timepoint. Clauses that bind from a later timepoint on than
  /// those that they mention get it as a literal, so that they stand where they bind.
  inline static const Key kAnchor{AtomKind::kUnused, {}};

  /// The horizon that the atom of a variable needs; 0 for those without a timepoint.
  Timepoint needed_by(std::int32_t variable) const {
    if (variable <= model_.base()) {
      const auto& atom = model_.fixed[static_cast<std::size_t>(variable) - 1];
      return is_of_state(atom) ? *atom.time : 0;
    }
    const auto place = variable - model_.base() - 1;
    const bool is_step = place % model_.stride() >= static_cast<std::int32_t>(model_.state_slots);
    return place / model_.stride() + (is_step ? 1 : 0);
  }
  bool needs_anchor(std::span<const Literal> clause, Timepoint binds) const {
    return std::all_of(clause.begin(), clause.end(),
                       [&](Literal literal) { return needed_by(literal.var()) < binds; });
  }

  void name_slots() {
    for (const auto& atom : model_.fixed) {
      if (is_of_state(atom)) places_.try_emplace({atom.kind, atom.plan}, 0);
    }
    places_.try_emplace(kAnchor, 0);
    for (auto& [key, place] : places_) {
      place = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(&key);
    }
    // By variable - 1: its place among the fixed ones, or its slot and timepoint.
    for (const auto& atom : model_.fixed) {
      if (is_of_state(atom)) {
        fixed_.emplace_back(0);
        present_.emplace(places_.at({atom.kind, atom.plan}), *atom.time);
      } else if (atom.kind == AtomKind::kAuxiliary) {
        fixed_.emplace_back(0);  // copy()
      } else {
        out_.fixed.push_back(atom);
        fixed_.push_back(static_cast<std::int32_t>(out_.fixed.size()));
      }
    }
    definitions_.resize(model_.fixed.size());
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (is_part(c)) definitions_[index(model_.clauses[c].front())].push_back(c);
    }
    // The copies of auxiliaries are fixed variables, so all are made before anything is numbered.
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (!is_part(c) && !says_where_it_ends(model_.clauses[c])) {
        copy_parts(model_.clauses[c], model_.clause_timepoints[c]);
      }
    }
  }

  static std::size_t index(Literal literal) { return static_cast<std::size_t>(literal.var()) - 1; }
  bool is_auxiliary(Literal literal) const {
    return literal.var() <= model_.base() &&
           model_.fixed[index(literal)].kind == AtomKind::kAuxiliary;
  }
  /// Does the clause define a fixed auxiliary? What is defined stands in front.
  bool is_part(std::size_t c) const {
    const auto clause = model_.clauses[c];
    return model_.clause_is_definition[c] && !clause.empty() && is_auxiliary(clause.front());
  }

  /// A part of a formula may be about one state and be used by clauses that bind before it and
  /// behind it. Each timepoint at which a clause binds gets auxiliaries of its own, with their
  /// definitions, which say the same about everything else.
  void copy_parts(std::span<const Literal> clause, Timepoint binds) {
    std::vector<std::size_t> todo;
    const auto note = [&](std::span<const Literal> literals) {
      for (const auto literal : literals) {
        if (!is_auxiliary(literal)) continue;
        if (!copies_.try_emplace({index(literal), binds}, 0).second) continue;
        todo.push_back(index(literal));
      }
    };
    note(clause);
    while (!todo.empty()) {
      const auto auxiliary = todo.back();
      todo.pop_back();
      out_.fixed.push_back(model_.fixed[auxiliary]);
      copies_[{auxiliary, binds}] = static_cast<std::int32_t>(out_.fixed.size());
      for (const auto c : definitions_[auxiliary]) note(model_.clauses[c]);
    }
  }

  /// Hash of an auxiliary's meaning at a timepoint, whatever its number: equal steps are to have
  /// equal clauses.
  std::uint64_t shape(std::size_t auxiliary, Timepoint binds) {
    std::vector<std::size_t> todo = {auxiliary};
    while (!todo.empty()) {
      const auto next = todo.back();
      const auto before = todo.size();
      if (!shapes_.contains({next, binds})) {
        for (const auto c : definitions_[next]) {
          for (const auto literal : model_.clauses[c]) {
            if (!is_auxiliary(literal) || index(literal) == next) continue;
            if (!shapes_.contains({index(literal), binds})) todo.push_back(index(literal));
          }
        }
        if (todo.size() != before) continue;  // its parts come first
        shapes_.emplace(Part(next, binds), shape_of_known(next, binds));
      }
      todo.pop_back();
    }
    return shapes_.at({auxiliary, binds});
  }
  std::uint64_t shape_of_known(std::size_t auxiliary, Timepoint binds) {
    std::vector<std::uint64_t> parts;
    for (const auto c : definitions_[auxiliary]) {
      std::uint64_t sum = 1;
      for (const auto literal : model_.clauses[c]) {
        const std::uint64_t sign = literal.is_positive() ? 1 : 0;
        const bool is_self = is_auxiliary(literal) && index(literal) == auxiliary;
        sum += is_self ? 3 + sign : mixed(order_of(literal, binds) * 2 + sign);
      }
      parts.push_back(mixed(sum));
    }
    std::sort(parts.begin(), parts.end());
    std::uint64_t out = 7;
    for (const auto part : parts) out = mixed(out ^ part);
    return out;
  }
  static std::uint64_t mixed(std::uint64_t value) {
    value *= 0x9E3779B97F4A7C15U;
    value ^= value >> 29U;
    value *= 0xBF58476D1CE4E5B9U;
    return value ^ (value >> 32U);
  }
  /// A number for the variable as the step to `binds` sees it.
  std::uint64_t order_of(Literal literal, Timepoint binds) {
    if (is_auxiliary(literal)) return shape(index(literal), binds) | (std::uint64_t{1} << 63U);
    const auto variable = moved(literal.var(), binds);
    if (variable <= out_.base()) return static_cast<std::uint64_t>(variable);
    const auto place = variable - out_.base() - 1;
    const auto ahead = place / out_.stride() - binds + out_.horizon + 1;
    return (std::uint64_t{1} << 62U) +
           static_cast<std::uint64_t>(ahead) * static_cast<std::uint64_t>(out_.stride()) +
           static_cast<std::uint64_t>(place % out_.stride());
  }

  std::uint32_t added() const { return static_cast<std::uint32_t>(keys_.size()); }

  void write_symbols() {
    out_.horizon = model_.horizon;
    out_.state_slots = model_.state_slots + added();
    const auto states = static_cast<std::ptrdiff_t>(model_.state_slots);
    out_.slots.assign(model_.slots.begin(), model_.slots.begin() + states);
    for (const auto* key : keys_) {
      out_.slots.push_back({key->first, to_string(key->first, key->second)});
    }
    out_.slots.insert(out_.slots.end(), model_.slots.begin() + states, model_.slots.end());
    out_.fluents = model_.fluents;
    out_.release_slots = model_.release_slots;
    out_.events = model_.events;
    for (auto& event : out_.events) {
      if (event.slot) *event.slot += added();
    }
    out_.origins = model_.origins;
    out_.plan = model_.plan;
    out_.plan_cuts = model_.plan_cuts;
  }

  std::int32_t moved(std::int32_t variable, Timepoint binds) const {
    if (variable <= model_.base()) {
      const auto& atom = model_.fixed[static_cast<std::size_t>(variable) - 1];
      if (atom.kind == AtomKind::kAuxiliary) {
        return copies_.at({static_cast<std::size_t>(variable) - 1, binds});
      }
      if (!is_of_state(atom)) return fixed_[static_cast<std::size_t>(variable) - 1];
      const auto place = places_.at({atom.kind, atom.plan});
      return out_.variable(model_.state_slots + place, *atom.time);
    }
    const auto place = variable - model_.base() - 1;
    auto slot = static_cast<std::uint32_t>(place % model_.stride());
    if (slot >= model_.state_slots) slot += added();
    return out_.variable(slot, place / model_.stride());
  }

  bool says_where_it_ends(std::span<const Literal> clause) const {
    return std::any_of(clause.begin(), clause.end(), [&](Literal literal) {
      if (literal.var() > model_.base()) return false;
      const auto kind = model_.fixed[static_cast<std::size_t>(literal.var()) - 1].kind;
      return kind == AtomKind::kHit || kind == AtomKind::kRunning;
    });
  }

  void write_clauses() {
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (!is_part(c) && !says_where_it_ends(model_.clauses[c])) {
        write(c, model_.clause_timepoints[c]);
      }
    }
    for (std::uint32_t place = 0; place < added(); ++place) {
      for (Timepoint t = 0; t <= model_.horizon; ++t) {
        if (present_.contains({place, t})) continue;
        add({~Literal::positive(out_.variable(model_.state_slots + place, t))}, t, 0, false);
      }
    }
  }

  /// Adds the clause as it binds at a timepoint, and the definitions of its parts unless they are
  /// there.
  void write(std::size_t root, Timepoint binds) {
    std::vector<std::size_t> todo = {root};
    while (!todo.empty()) {
      const auto c = todo.back();
      todo.pop_back();
      const auto clause = model_.clauses[c];
      std::vector<std::pair<std::uint64_t, Literal>> ordered;
      for (const auto literal : clause) ordered.emplace_back(order_of(literal, binds), literal);
      // The auxiliary that is defined stays in front.
      const bool is_definition = model_.clause_is_definition[c];
      std::stable_sort(ordered.begin() + (is_definition ? 1 : 0), ordered.end(),
                       [](const auto& one, const auto& other) { return one.first < other.first; });
      std::vector<Literal> written;
      for (const auto& [order, literal] : ordered) {
        const auto positive = Literal::positive(moved(literal.var(), binds));
        written.push_back(literal.is_positive() ? positive : ~positive);
        if (!is_auxiliary(literal) || !defined_.emplace(index(literal), binds).second) continue;
        const auto& parts = definitions_[index(literal)];
        todo.insert(todo.end(), parts.rbegin(), parts.rend());
      }
      if (needs_anchor(clause, binds)) {
        written.push_back(
            Literal::positive(out_.variable(model_.state_slots + places_.at(kAnchor), binds)));
      }
      add(written, binds, model_.clause_origins[c], is_definition);
    }
  }

  void add(const std::vector<Literal>& clause, Timepoint t, std::uint32_t origin,
           bool is_definition) {
    out_.clauses.add(clause);
    out_.clause_timepoints.push_back(t);
    out_.clause_origins.push_back(origin);
    out_.clause_is_definition.push_back(is_definition);
  }

  const CompiledModel& model_;
  std::map<Key, std::uint32_t> places_;  // among the slots that are added
  std::vector<const Key*> keys_;
  std::set<std::pair<std::uint32_t, Timepoint>> present_;
  std::vector<std::int32_t> fixed_;
  std::vector<std::vector<std::size_t>> definitions_;  // by fixed auxiliary: clauses
  using Part = std::pair<std::size_t, Timepoint>;      // of a formula, where it is used
  std::map<Part, std::int32_t> copies_;                // their variables
  std::map<Part, std::uint64_t> shapes_;
  std::set<Part> defined_;
  CompiledModel out_;
};

}  // namespace

CompiledModel with_plan_slots(const CompiledModel& model) { return SlotWriter(model).run(); }

}  // namespace parallax::runtime
