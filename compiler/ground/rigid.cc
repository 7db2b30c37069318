#include "compiler/ground/rigid.h"

#include <optional>
#include <set>

#include "compiler/formula/formula.h"
#include "compiler/ground/time_profile.h"

namespace parallax::compiler {
namespace {

constexpr std::int64_t kLargestTable = 200'000;

class Tabulator {
 public:
  Tabulator(GroundModel& model, const CompletionWriter& completion, PossibleAtoms& possible)
      : model_(model), completion_(completion), possible_(possible) {
    const auto& typed = model.typed();
    for (const auto& axiom : typed.axioms) {
      if (time_profile(typed, axiom.formula).shape != TimeShape::kRigid) {
        note_predicates(axiom.formula);
      }
    }
  }

  void run() {
    values_.assign(model_.atom_count() + 1, Truth::kUnknown);
    while (propagate()) {
    }
    const auto& typed = model_.typed();
    for (std::size_t i = 0; i < typed.symbols.size(); ++i) {
      const auto symbol = typed.symbols.id_at(i);
      if (typed.symbols[symbol].kind == SymbolKind::kPredicate && is_settled(symbol)) {
        tabulate(symbol);
      }
    }
  }

 private:
  void note_predicates(TypedFormulaId root) {
    std::vector<TypedFormulaId> todo = {root};
    while (!todo.empty()) {
      const auto& formula = model_.typed().formulas[todo.back()];
      todo.pop_back();
      todo.insert(todo.end(), formula.children.begin(), formula.children.end());
      if (formula.kind == FormulaKind::kAtom) timed_.insert(formula.predicate.index());
    }
  }
  bool is_closed(SymbolId symbol) const {
    return completion_.completion_of(symbol) != nullptr && !timed_.contains(symbol.index());
  }
  Truth value(std::int32_t variable) const { return values_[static_cast<std::size_t>(variable)]; }
  bool set(FormulaId literal) {
    const auto& formulas = model_.formulas();
    if (formulas.kind(literal) != FormulaNodeKind::kAtom) return false;
    auto& slot = values_[static_cast<std::size_t>(formulas.variable(literal))];
    if (slot != Truth::kUnknown) return false;
    slot = literal.negated() ? Truth::kFalse : Truth::kTrue;
    return true;
  }

  /// One round of unit propagation; true if it learned something.
  bool propagate() {
    bool learned = false;
    const auto& formulas = model_.formulas();
    for (const auto& constraint : model_.constraints()) {
      const auto id = constraint.formula;
      if (formulas.kind(id) == FormulaNodeKind::kAnd && !id.negated()) {
        for (const auto part : formulas.children(id)) learned |= propagate(part);
      } else {
        learned |= propagate(id);
      }
    }
    for (std::size_t i = 0; i < model_.atom_count(); ++i) {
      const auto variable = static_cast<std::int32_t>(i + 1);
      const auto& atom = model_.atom(variable);
      if (atom.kind != AtomKind::kPredicate || value(variable) != Truth::kUnknown) continue;
      if (!is_closed(model_.terms()[GroundTermId(atom.index)].symbol)) continue;
      if (evaluate(formulas, completion_.reason(atom), [&](std::int32_t v) { return value(v); }) !=
          Truth::kFalse) {
        continue;
      }
      values_[static_cast<std::size_t>(variable)] = Truth::kFalse;
      learned = true;
    }
    return learned;
  }

  bool propagate(FormulaId part) {
    const auto& formulas = model_.formulas();
    if (formulas.kind(part) == FormulaNodeKind::kAtom) return set(part);
    if (formulas.kind(part) != FormulaNodeKind::kAnd) return false;
    // A clause: a single literal that is left must be true.
    std::optional<FormulaId> open;
    for (const auto child : formulas.children(part)) {
      const auto known = evaluate(formulas, child, [&](std::int32_t v) { return value(v); });
      if (known == Truth::kFalse) return false;
      if (known == Truth::kTrue) continue;
      if (open) return false;
      open = child;
    }
    return open && set(~*open);
  }

  /// Is some atom of the predicate known to be false?
  bool is_settled(SymbolId symbol) const {
    if (is_closed(symbol)) return true;
    for (std::size_t i = 0; i < model_.atom_count(); ++i) {
      const auto variable = static_cast<std::int32_t>(i + 1);
      const auto& atom = model_.atom(variable);
      if (atom.kind == AtomKind::kPredicate && value(variable) == Truth::kFalse &&
          model_.terms()[GroundTermId(atom.index)].symbol == symbol) {
        return true;
      }
    }
    return false;
  }

  void tabulate(SymbolId symbol) {
    const auto& declared = model_.typed().symbols[symbol];
    std::int64_t size = 1;
    for (const auto sort : declared.arguments) {
      const auto count = static_cast<std::int64_t>(model_.universe().domain(sort).size());
      if (count == 0 || __builtin_mul_overflow(size, count, &size) || size > kLargestTable) return;
    }
    GroundTable table(declared.arguments.size());
    std::vector<std::size_t> odometer(declared.arguments.size(), 0);
    std::vector<GroundTermId> row(odometer.size());
    for (std::int64_t k = 0; k < size; ++k) {
      for (std::size_t a = 0; a < row.size(); ++a) {
        row[a] = model_.universe().domain(declared.arguments[a])[odometer[a]];
      }
      if (may_be_true(symbol, row)) table.add(row);
      for (std::size_t a = odometer.size(); a-- > 0;) {
        if (++odometer[a] < model_.universe().domain(declared.arguments[a]).size()) break;
        odometer[a] = 0;
      }
    }
    possible_.set_predicate_table(symbol, std::move(table));
  }

  bool may_be_true(SymbolId symbol, const std::vector<GroundTermId>& row) {
    const auto variable = model_.find_predicate(model_.terms().apply(symbol, row));
    if (!variable) return !is_closed(symbol);
    return static_cast<std::size_t>(*variable) >= values_.size() ||
           value(*variable) != Truth::kFalse;
  }

  GroundModel& model_;
  const CompletionWriter& completion_;
  PossibleAtoms& possible_;
  std::set<std::uint32_t> timed_;  // symbols that axioms about time mention
  std::vector<Truth> values_;      // by variable
};

}  // namespace

void tabulate_predicates(GroundModel& model, const CompletionWriter& completion,
                         PossibleAtoms& possible) {
  Tabulator(model, completion, possible).run();
}

}  // namespace parallax::compiler
