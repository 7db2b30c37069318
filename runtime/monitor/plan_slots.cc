#include "runtime/monitor/plan_slots.h"

#include <algorithm>
#include <map>
#include <optional>
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
  bool needs_anchor(std::size_t c) const {
    const auto clause = model_.clauses[c];
    const auto binds = model_.clause_timepoints[c];
    return !says_where_it_ends(clause) &&
           std::all_of(clause.begin(), clause.end(),
                       [&](Literal literal) { return needed_by(literal.var()) < binds; });
  }
  bool needs_anchor() const {
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (needs_anchor(c)) return true;
    }
    return false;
  }

  void name_slots() {
    for (const auto& atom : model_.fixed) {
      if (is_of_state(atom)) places_.try_emplace({atom.kind, atom.plan}, 0);
    }
    if (needs_anchor()) places_.try_emplace(kAnchor, 0);
    for (auto& [key, place] : places_) {
      place = static_cast<std::uint32_t>(keys_.size());
      keys_.push_back(&key);
    }
    // By variable - 1: where it is among the fixed ones, or which slot of which timepoint it is.
    for (const auto& atom : model_.fixed) {
      if (is_of_state(atom)) {
        fixed_.emplace_back(0);
        present_.emplace(places_.at({atom.kind, atom.plan}), *atom.time);
      } else {
        out_.fixed.push_back(atom);
        fixed_.push_back(static_cast<std::int32_t>(out_.fixed.size()));
      }
    }
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

  std::int32_t moved(std::int32_t variable) const {
    if (variable <= model_.base()) {
      const auto& atom = model_.fixed[static_cast<std::size_t>(variable) - 1];
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
    std::vector<Literal> written;
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      if (says_where_it_ends(model_.clauses[c])) continue;
      written.clear();
      for (const auto literal : model_.clauses[c]) {
        const auto positive = Literal::positive(moved(literal.var()));
        written.push_back(literal.is_positive() ? positive : ~positive);
      }
      const auto t = model_.clause_timepoints[c];
      if (needs_anchor(c)) {
        written.push_back(
            Literal::positive(out_.variable(model_.state_slots + places_.at(kAnchor), t)));
      }
      add(written, t, model_.clause_origins[c]);
    }
    for (std::uint32_t place = 0; place < added(); ++place) {
      for (Timepoint t = 0; t <= model_.horizon; ++t) {
        if (present_.contains({place, t})) continue;
        written = {~Literal::positive(out_.variable(model_.state_slots + place, t))};
        add(written, t, 0);
      }
    }
  }

  void add(const std::vector<Literal>& clause, Timepoint t, std::uint32_t origin) {
    out_.clauses.add(clause);
    out_.clause_timepoints.push_back(t);
    out_.clause_origins.push_back(origin);
    out_.clause_is_definition.push_back(false);
  }

  const CompiledModel& model_;
  std::map<Key, std::uint32_t> places_;  // among the slots that are added
  std::vector<const Key*> keys_;
  std::set<std::pair<std::uint32_t, Timepoint>> present_;
  std::vector<std::int32_t> fixed_;
  CompiledModel out_;
};

}  // namespace

CompiledModel with_plan_slots(const CompiledModel& model) { return SlotWriter(model).run(); }

}  // namespace parallax::runtime
