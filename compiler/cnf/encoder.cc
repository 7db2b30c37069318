#include "compiler/cnf/encoder.h"

#include <algorithm>

namespace parallax::compiler {
namespace {

class Encoder {
 public:
  explicit Encoder(const GroundModel& model) : model_(model), formulas_(model.formulas()) {
    out_.horizon = model.horizon();
    out_.atoms = model.atoms();
    out_.variable_count = static_cast<std::int32_t>(out_.atoms.size());
    out_.origins = model.origins();
    for (const auto id : model.fluents()) {
      out_.fluents.push_back(model.terms().text(id, model.typed()));
    }
    for (const auto id : model.events()) {
      out_.events.push_back(model.terms().text(id, model.typed()));
    }
    variables_.resize(formulas_.node_count(), 0);
    defined_.resize(formulas_.node_count(), 0);
    compute_times();
  }

  CompiledModel run() && {
    for (const auto& constraint : model_.constraints()) {
      origin_ = constraint.origin;
      assert_top(constraint.formula);
      define_pending();
    }
    return std::move(out_);
  }

 private:
  /// Nodes are made after their children, so one pass in order of ids is enough.
  void compute_times() {
    times_.resize(formulas_.node_count(), 0);
    for (std::uint32_t node = 0; node < formulas_.node_count(); ++node) {
      const auto id = formulas_.at(node);
      if (formulas_.kind(id) == FormulaNodeKind::kAtom) {
        times_[node] =
            needed_horizon(out_.atoms[static_cast<std::size_t>(formulas_.variable(id)) - 1]);
      } else if (formulas_.kind(id) == FormulaNodeKind::kAnd) {
        for (const auto child : formulas_.children(id)) {
          times_[node] = std::max(times_[node], times_[child.node()]);
        }
      }
    }
  }

  void assert_top(FormulaId root) {
    std::vector<FormulaId> todo = {root};
    while (!todo.empty()) {
      const auto id = todo.back();
      todo.pop_back();
      if (formulas_.kind(id) == FormulaNodeKind::kAnd && !id.negated()) {
        const auto children = formulas_.children(id);
        todo.insert(todo.end(), children.rbegin(), children.rend());
        continue;
      }
      std::vector<Literal> clause;
      if (formulas_.kind(id) == FormulaNodeKind::kAnd) {
        for (const auto child : formulas_.children(id)) clause.push_back(use(~child));
      } else if (id == formulas_.falsity()) {
        // The empty clause: whatever asserted it is contradictory.
      } else {
        clause.push_back(use(id));
      }
      emit(clause, times_[id.node()], false);
    }
  }

  /// A literal that implies `id`; its definition is queued if this polarity has none yet.
  Literal use(FormulaId id) {
    const auto node = id.node();
    if (formulas_.kind(id) == FormulaNodeKind::kAtom) {
      const auto literal = Literal::positive(formulas_.variable(id));
      return id.negated() ? ~literal : literal;
    }
    if (variables_[node] == 0) variables_[node] = ++out_.variable_count;
    const std::uint8_t polarity = id.negated() ? 2 : 1;
    if ((defined_[node] & polarity) == 0) {
      defined_[node] = static_cast<std::uint8_t>(defined_[node] | polarity);
      pending_.push_back(id);
    }
    const auto literal = Literal::positive(variables_[node]);
    return id.negated() ? ~literal : literal;
  }

  void define_pending() {
    while (!pending_.empty()) {
      const auto id = pending_.back();
      pending_.pop_back();
      const auto self = Literal::positive(variables_[id.node()]);
      const auto time = times_[id.node()];
      if (!id.negated()) {
        for (const auto child : formulas_.children(id)) emit({~self, use(child)}, time, true);
      } else {
        std::vector<Literal> clause = {self};
        for (const auto child : formulas_.children(id)) clause.push_back(use(~child));
        emit(clause, time, true);
      }
    }
  }

  void emit(const std::vector<Literal>& clause, Timepoint time, bool is_definition) {
    out_.clauses.add(clause);
    out_.clause_timepoints.push_back(time);
    out_.clause_origins.push_back(origin_);
    out_.clause_is_definition.push_back(is_definition);
  }

  const GroundModel& model_;
  const FormulaStore& formulas_;
  CompiledModel out_;
  std::vector<std::int32_t> variables_;  // auxiliary variable by node; 0: none yet
  std::vector<std::uint8_t> defined_;    // polarities that have their definition, by node
  std::vector<Timepoint> times_;         // latest timepoint mentioned, by node
  std::vector<FormulaId> pending_;
  std::uint32_t origin_ = 0;
};

}  // namespace

CompiledModel encode(const GroundModel& model) { return Encoder(model).run(); }

}  // namespace parallax::compiler
