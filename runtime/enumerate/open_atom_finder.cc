#include "runtime/enumerate/open_atom_finder.h"

#include <algorithm>
#include <utility>

#include "runtime/enumerate/open_variables.h"

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::AtomRef;

namespace {

/// Beyond so many conflicts traces are asked about one by one.
constexpr std::int64_t kMostConflicts = 2'000;

bool is_hidden(AtomKind kind) {
  return kind == AtomKind::kReleasedAt || kind == AtomKind::kPredicate;
}

Literal as(bool value, const AtomRef& atom) { return value ? atom.literal() : ~atom.literal(); }

/// The value that the trace fixes for an atom: HoldsAt, Happens and, with a plan, its performs and
/// their results. None for atoms that the trace does not mention.
std::optional<bool> told_value(const Trace& trace, const AtomRef& atom, std::size_t plan_size) {
  if (!atom.time) return std::nullopt;
  const auto time = static_cast<std::size_t>(*atom.time);
  switch (atom.kind) {
    case AtomKind::kHoldsAt:
      return contains(trace.points[time].holds, atom.fluent());
    case AtomKind::kHappens:
      return contains(trace.points[time].happens, atom.event());
    case AtomKind::kLocation: {
      const auto* step = std::get_if<compiler::PlanStepId>(&atom.plan);
      const bool ends = time + 1 == trace.points.size();
      if (step == nullptr || ends || step->index() >= plan_size) return std::nullopt;
      return trace.points[time].plan_step == step->index();
    }
    case AtomKind::kResult: {
      const auto* returned = std::get_if<compiler::ReturnedObject>(&atom.plan);
      return returned != nullptr && trace.points[time - 1].returned == returned->object;
    }
    case AtomKind::kReleasedAt:
    case AtomKind::kPredicate:
    case AtomKind::kHit:
    case AtomKind::kRunning:
    case AtomKind::kSucceeded:
    case AtomKind::kRegister:
    case AtomKind::kAuxiliary:
    case AtomKind::kUnused:
      break;
  }
  return std::nullopt;
}

}  // namespace

bool has_hidden_atoms(const CompiledModel& model) {
  const auto is_predicate = [](const auto& atom) { return atom.kind == AtomKind::kPredicate; };
  return std::any_of(model.fixed.begin(), model.fixed.end(), is_predicate) ||
         std::any_of(model.release_slots.begin(), model.release_slots.end(),
                     [](const auto& slot) { return slot.has_value(); });
}

OpenAtomFinder::OpenAtomFinder(const CompiledModel& model, MakeSolver make_solver, bool all_hits)
    : model_(&model),
      make_solver_(std::move(make_solver)),
      all_hits_(all_hits),
      has_hidden_(has_hidden_atoms(model)) {}

OpenAtomFinder::~OpenAtomFinder() = default;

bool OpenAtomFinder::none_is_open() {
  if (!none_) none_ = !has_hidden_ || (!model_->has_constraints && is_defined());
  return *none_;
}

/// Padoa's method: HoldsAt and Happens have one variable, all else one in each of two copies.
bool OpenAtomFinder::is_defined() const {
  const auto count = model_->variable_count();
  std::vector<bool> shared(static_cast<std::size_t>(count) + 1, false);
  std::vector<Literal> hidden;
  model_->for_each_atom([&](const AtomRef& atom) {
    const bool is_told = atom.kind == AtomKind::kHoldsAt || atom.kind == AtomKind::kHappens;
    shared[static_cast<std::size_t>(atom.variable)] = is_told;
    if (is_hidden(atom.kind)) hidden.push_back(atom.literal());
  });
  const auto copy_of = [&](Literal literal) {
    if (shared[static_cast<std::size_t>(literal.var())]) return literal;
    const auto copy = Literal::positive(literal.var() + count);
    return literal.is_positive() ? copy : ~copy;
  };
  const auto solver = make_solver_();
  std::vector<Literal> clause;
  for (std::size_t i = 0; i < model_->clauses.size(); ++i) {
    clause.assign(model_->clauses[i].begin(), model_->clauses[i].end());
    solver->add_clause(clause);
    const auto first = clause;
    std::transform(clause.begin(), clause.end(), clause.begin(), copy_of);
    if (clause != first) solver->add_clause(clause);
  }
  std::vector<Literal> differ;
  for (const auto literal : hidden) {
    const auto here = Literal::positive(2 * count + static_cast<std::int32_t>(differ.size()) + 1);
    solver->add_clause(std::vector{~here, literal, copy_of(literal)});
    solver->add_clause(std::vector{~here, ~literal, ~copy_of(literal)});
    differ.push_back(here);
  }
  solver->add_clause(differ);
  solver->limit_conflicts(kMostConflicts);
  return solver->solve() == SolveStatus::kUnsatisfiable;
}

/// The trace's length, and what it tells.
std::vector<Literal> OpenAtomFinder::assumptions_of(const Trace& trace) const {
  std::vector<Literal> out;
  const auto n = trace.length();
  if (model_->has_constraints) {
    for (Timepoint t = all_hits_ ? n : 0; t <= n; ++t) {
      const auto hit = index_->hit(t);
      if (hit) out.push_back(t < n ? ~*hit : *hit);  // at 0 some models have none
    }
  }
  model_->for_each_atom([&](const AtomRef& atom) {
    if (atom.needed_horizon(model_->horizon) > n) return;
    if (const auto value = told_value(trace, atom, model_->plan.size()))
      out.push_back(as(*value, atom));
  });
  return out;
}

/// The other atoms as they are in the trace.
std::vector<Literal> OpenAtomFinder::hidden_of(const Trace& trace) const {
  std::vector<Literal> out;
  model_->for_each_atom([&](const AtomRef& atom) {
    if (!is_hidden(atom.kind) || atom.needed_horizon(model_->horizon) > trace.length()) return;
    const bool value =
        atom.kind == AtomKind::kPredicate
            ? contains(trace.predicates, atom.name)
            : contains(trace.points[static_cast<std::size_t>(*atom.time)].released, atom.fluent());
    out.push_back(as(value, atom));
  });
  return out;
}

/// Is there a valuation in which not all of `same` are true?
SolveStatus OpenAtomFinder::find_other(Timepoint n, std::vector<Literal>& assumptions,
                                       const std::vector<Literal>& same) {
  const auto wanted = session_->new_variable();
  std::vector<Literal> clause = {~wanted};
  for (const auto literal : same) clause.push_back(~literal);
  session_->add_clause(clause);
  assumptions.push_back(wanted);
  const auto status = session_->solve_whole(n, assumptions);
  assumptions.pop_back();
  const auto retired = ~wanted;
  session_->add_clause(std::span(&retired, 1));
  return status;
}

/// Every clause counts, and there is no end to be met.
std::optional<std::vector<std::int32_t>> OpenAtomFinder::open_of_whole(const Trace& trace) {
  if (variables_ == nullptr) {
    variables_ = std::make_unique<OpenVariables>(*model_, hidden_of(trace), make_solver_);
  }
  return variables_->find(assumptions_of(trace));
}

std::optional<std::vector<std::int32_t>> OpenAtomFinder::open_of_prefix(const Trace& trace) {
  if (session_ == nullptr) {
    session_ = std::make_unique<SolverSession>(*model_, make_solver_());
    index_.emplace(*model_);
  }
  auto assumptions = assumptions_of(trace);
  auto same = hidden_of(trace);
  std::vector<std::int32_t> open;
  for (;;) {
    std::erase_if(same, [&](Literal literal) { return session_->is_fixed(literal); });
    if (same.empty()) return open;
    const auto status = find_other(trace.length(), assumptions, same);
    if (status == SolveStatus::kUnknown) return std::nullopt;
    if (status == SolveStatus::kUnsatisfiable) return open;
    std::erase_if(same, [&](Literal literal) {
      const bool differs = !session_->value(literal);
      if (differs) open.push_back(literal.var());
      return differs;
    });
  }
}

OpenAtoms OpenAtomFinder::atoms_of(const Trace& trace, std::vector<std::int32_t> variables) const {
  OpenAtoms atoms;
  if (variables.empty()) return atoms;
  std::sort(variables.begin(), variables.end());
  atoms.released.resize(trace.points.size());
  model_->for_each_atom([&](const AtomRef& atom) {
    if (!std::binary_search(variables.begin(), variables.end(), atom.variable)) return;
    if (atom.kind == AtomKind::kPredicate) {
      atoms.predicates.push_back(atom.name);
    } else {
      atoms.released[static_cast<std::size_t>(*atom.time)].push_back(atom.fluent());
    }
  });
  std::sort(atoms.predicates.begin(), atoms.predicates.end());
  for (auto& fluents : atoms.released) std::sort(fluents.begin(), fluents.end());
  return atoms;
}

std::optional<OpenAtoms> OpenAtomFinder::find(const Trace& trace) {
  if (!has_hidden_ || none_.value_or(false)) return OpenAtoms();
  auto open = model_->has_constraints ? open_of_prefix(trace) : open_of_whole(trace);
  if (!open) return std::nullopt;
  return atoms_of(trace, *std::move(open));
}

OpenAtoms OpenAtomFinder::all_hidden(const Trace& trace) const {
  std::vector<std::int32_t> variables;
  for (const auto literal : hidden_of(trace)) variables.push_back(literal.var());
  return atoms_of(trace, std::move(variables));
}

}  // namespace parallax::runtime
