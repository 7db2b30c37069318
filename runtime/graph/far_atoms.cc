#include "runtime/graph/far_atoms.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <vector>

#include "compiler/artifact/extended_model.h"

namespace parallax::runtime {
namespace {

using compiler::Literal;
using compiler::Timepoint;

class FarAtoms {
 public:
  explicit FarAtoms(const CompiledModel& model) : model_(model) {}

  bool any() const {
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      const auto last = last_window(model_.clauses[c]);
      for (const auto literal : model_.clauses[c]) {
        if (is_far(literal, last)) return true;
      }
    }
    return false;
  }
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
    const compiler::FixedInsertion moved(model_, fixed_.size());
    std::vector<Literal> written;
    for (std::size_t c = 0; c < model_.clauses.size(); ++c) {
      const auto last = last_window(model_.clauses[c]);
      written.clear();
      for (const auto literal : model_.clauses[c]) {
        written.push_back(moved(is_far(literal, last) ? of_fixed(literal) : literal));
      }
      add(written, model_.clause_origins[c], out);
      // The clause that needs the variable is also the origin of its definition.
      for (const auto literal : model_.clauses[c]) {
        if (!is_far(literal, last)) continue;
        const auto fixed = moved(of_fixed(literal));
        add(std::array{fixed, ~moved(literal)}, model_.clause_origins[c], out);
        add(std::array{~fixed, moved(literal)}, model_.clause_origins[c], out);
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
  /// By the number that an insertion takes for the added variable.
  Literal of_fixed(Literal literal) const {
    const auto fixed = Literal::positive(model_.variable_count() + fixed_.at(literal.var()) + 1);
    return literal.is_positive() ? fixed : ~fixed;
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

bool looks_far(const CompiledModel& model) { return FarAtoms(model).any(); }

}  // namespace parallax::runtime
