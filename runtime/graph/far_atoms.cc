#include "runtime/graph/far_atoms.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace parallax::runtime {
namespace {

using compiler::Literal;
using compiler::Timepoint;

class FarAtoms {
 public:
  explicit FarAtoms(const CompiledModel& model) : model_(model) {}

  /// False: more than `most` of them.
  bool find(std::size_t most) {
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      const auto last = last_window(model_.clauses[c]);
      for (const auto literal : model_.clauses[c]) {
        if (is_far(literal, last)) {
          fixed_.try_emplace(literal.var(), static_cast<std::int32_t>(fixed_.size()));
        }
      }
      if (fixed_.size() > most) return false;
    }
    return !fixed_.empty();
  }

  CompiledModel replaced() const {
    CompiledModel out;
    out.horizon = model_.horizon;
    out.fixed = model_.fixed;
    out.fixed.resize(model_.fixed.size() + fixed_.size());
    out.slots = model_.slots;
    out.state_slots = model_.state_slots;
    out.fluents = model_.fluents;
    out.release_slots = model_.release_slots;
    out.events = model_.events;
    out.origins = model_.origins;
    std::vector<Literal> written;
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      const auto last = last_window(model_.clauses[c]);
      written.clear();
      for (const auto literal : model_.clauses[c]) {
        written.push_back(is_far(literal, last) ? of_fixed(literal) : moved(literal));
      }
      add(written, model_.clause_origins[c], out);
      // The clause that needs the variable also says what it is.
      for (const auto literal : model_.clauses[c]) {
        if (!is_far(literal, last)) continue;
        add(std::array{of_fixed(literal), ~moved(literal)}, model_.clause_origins[c], out);
        add(std::array{~of_fixed(literal), moved(literal)}, model_.clause_origins[c], out);
      }
    }
    return out;
  }

 private:
  /// When the step begins that is the last one that the clause speaks of; -1 for the state at 0.
  Timepoint last_window(std::span<const Literal> clause) const {
    Timepoint last = -1;
    for (const auto literal : clause) {
      if (is_timed(literal))
        last = std::max(last, is_state(literal) ? time(literal) - 1 : time(literal));
    }
    return last;
  }
  bool is_far(Literal literal, Timepoint last) const {
    return is_timed(literal) && time(literal) < last;
  }
  bool is_timed(Literal literal) const { return literal.var() > model_.base(); }
  Timepoint time(Literal literal) const {
    return (literal.var() - model_.base() - 1) / model_.stride();
  }
  bool is_state(Literal literal) const {
    return (literal.var() - model_.base() - 1) % model_.stride() <
           static_cast<std::int32_t>(model_.state_slots);
  }
  Literal of_fixed(Literal literal) const {
    const auto fixed = Literal::positive(model_.base() + fixed_.at(literal.var()) + 1);
    return literal.is_positive() ? fixed : ~fixed;
  }
  Literal moved(Literal literal) const {
    const auto by = is_timed(literal) ? static_cast<std::int32_t>(fixed_.size()) : 0;
    const auto there = Literal::positive(literal.var() + by);
    return literal.is_positive() ? there : ~there;
  }
  static void add(std::span<const Literal> clause, std::uint32_t origin, CompiledModel& out) {
    out.clauses.add(clause);
    out.clause_origins.push_back(origin);
  }

  const CompiledModel& model_;
  std::map<std::int32_t, std::int32_t> fixed_;  // by variable: which of the added ones
};

}  // namespace

std::optional<CompiledModel> with_far_atoms_fixed(const CompiledModel& model, std::size_t most) {
  FarAtoms atoms(model);
  if (!atoms.find(most)) return std::nullopt;
  return atoms.replaced();
}

}  // namespace parallax::runtime
