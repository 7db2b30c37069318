#include "runtime/explain/group_solver.h"

#include <map>
#include <tuple>
#include <utility>

namespace parallax::runtime {

using compiler::Literal;
using compiler::Timepoint;

ExecutionFormula::ExecutionFormula(const compiler::CompiledModel& model,
                                   std::optional<Observed> observed)
    : model_(model),
      observed_(std::move(observed)),
      variables_(model.variable_count() + (is_guarded() ? 2 * model.horizon : 0)) {}

Literal ExecutionFormula::reaches(Timepoint t) const {
  return Literal::positive(model_.variable_count() + t);
}

Literal ExecutionFormula::ends(Timepoint n) const {
  return Literal::positive(model_.variable_count() + model_.horizon + n);
}

std::span<const Literal> ExecutionFormula::clause(std::size_t index) {
  const auto t = model_.clause_timepoints[index];
  if (!is_guarded() || t == 0 || is_definition(index)) return model_.clauses[index];
  clause_.assign(model_.clauses[index].begin(), model_.clauses[index].end());
  clause_.push_back(~reaches(t));
  return clause_;
}

void ExecutionFormula::for_each_always(const std::function<void(std::span<const Literal>)>& visit) {
  for (std::size_t i = 0; i < model_.clauses.size(); ++i) {
    if (is_definition(i)) visit(model_.clauses[i]);
  }
  if (!observed_) {
    if (model_.has_constraints) choose_length(visit);
    return;
  }
  for (Timepoint t = 1; t <= model_.horizon; ++t) {
    const auto reached = t <= observed_->length ? reaches(t) : ~reaches(t);
    visit(std::span(&reached, 1));
  }
  for (const auto& fact : observed_->facts) visit(std::span(&fact, 1));
}

void ExecutionFormula::choose_length(
    const std::function<void(std::span<const Literal>)>& visit) const {
  const compiler::AtomIndex index(model_);
  std::vector<Literal> some;
  for (Timepoint n = 1; n <= model_.horizon; ++n) {
    some.push_back(ends(n));
    const auto hit = index.hit(n);
    PARALLAX_REQUIRE(hit.has_value(), "every timepoint from 1 has its hit atom");
    const Literal hits[] = {~ends(n), *hit};
    const Literal reached[] = {~ends(n), reaches(n)};
    visit(hits);
    visit(reached);
    if (n == 1) continue;
    const Literal before[] = {~reaches(n), reaches(n - 1)};
    visit(before);
  }
  visit(some);
}

namespace {

/// File, begin, end; without a place, the number of the origin.
using Key = std::tuple<std::size_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t,
                       std::uint32_t>;

/// Files in the order in which they are first seen; a compiled model names the places of the texts
/// it was made from.
Key key_of(const compiler::Origin& origin, std::uint32_t index,
           std::map<std::string, std::size_t>& files) {
  const auto& place = origin.place;
  const auto& source = origin.source;
  if (!place.file.empty()) {
    const auto file = files.emplace(place.file, files.size()).first->second;
    return {file, place.begin.line, place.begin.column, place.end.line, place.end.column, 0};
  }
  if (source.end > source.begin) {
    return {SIZE_MAX - 1,
            static_cast<std::uint32_t>(source.file.index()),
            source.begin,
            source.end,
            0,
            0};
  }
  return {SIZE_MAX, 0, 0, 0, 0, index};
}

}  // namespace

AxiomGroups group_axioms(const compiler::CompiledModel& model) {
  std::vector<bool> used(model.origins.size(), false);
  for (const auto origin : model.clause_origins) used[origin] = true;
  std::map<std::string, std::size_t> files;
  std::map<Key, std::vector<std::uint32_t>> by_place;
  for (std::uint32_t i = 0; i < model.origins.size(); ++i) {
    if (!used[i] || model.origins[i].kind == compiler::OriginKind::kInvariant) continue;
    by_place[key_of(model.origins[i], i, files)].push_back(i);
  }
  AxiomGroups groups;
  groups.group_of.assign(model.origins.size(), AxiomGroups::kNone);
  for (auto& [key, origins] : by_place) {
    for (const auto origin : origins) {
      groups.group_of[origin] = static_cast<std::uint32_t>(groups.origins.size());
    }
    groups.origins.push_back(std::move(origins));
  }
  return groups;
}

GroupSolver::GroupSolver(std::int32_t variables, std::size_t groups,
                         std::unique_ptr<SatSolver> solver)
    : solver_(std::move(solver)), variables_(variables), groups_(groups) {
  // Groups that are not asked for are switched on where that costs nothing.
  for (std::uint32_t g = 0; g < groups; ++g) solver_->set_phase(selector(g));
}

void GroupSolver::add(std::span<const Literal> clause, std::uint32_t group) {
  clause_.assign(clause.begin(), clause.end());
  clause_.push_back(~selector(group));
  solver_->add_clause(clause_);
}

SolveStatus GroupSolver::solve(const IndexSet& groups, Effort* effort) {
  asked_ = groups;
  for (const auto group : groups) solver_->assume(selector(group));
  if (effort == nullptr) return solver_->solve();
  const auto before = solver_->conflicts();
  solver_->limit_conflicts(effort->share());
  const auto status = solver_->solve();
  effort->spend(solver_->conflicts() - before);
  return status;
}

IndexSet GroupSolver::core() const {
  IndexSet used;
  for (const auto group : asked_) {
    if (solver_->failed(selector(group))) used.push_back(group);
  }
  return used;
}

IndexSet GroupSolver::satisfied() const {
  IndexSet holding;
  for (std::uint32_t g = 0; g < groups_; ++g) {
    if (solver_->value(selector(g))) holding.push_back(g);
  }
  return holding;
}

GroupSolver load_axioms(ExecutionFormula& formula, const AxiomGroups& groups,
                        std::unique_ptr<SatSolver> fresh, std::size_t more) {
  const auto& model = formula.model();
  GroupSolver solver(formula.variables(), groups.size() + more, std::move(fresh));
  formula.for_each_always([&](std::span<const Literal> clause) { solver.add_definition(clause); });
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    const auto group = groups.group_of[model.clause_origins[i]];
    if (formula.is_definition(i) || group == AxiomGroups::kNone) continue;
    solver.add(formula.clause(i), group);
  }
  return solver;
}

}  // namespace parallax::runtime
