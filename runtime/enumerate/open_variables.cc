#include "runtime/enumerate/open_variables.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "compiler/base/contract.h"

namespace parallax::runtime {

namespace {

constexpr auto kEnd = ClausePropagation::kEnd;
/// Components are forgotten when there are so many.
constexpr std::size_t kMostKnown = 20'000;

std::size_t variable_of(ClausePropagation::Code code) { return code >> 1U; }

}  // namespace

OpenVariables::OpenVariables(const compiler::CompiledModel& model, std::span<const Literal> asked,
                             MakeSolver make_solver, Bounds bounds)
    : state_(model.variable_count()),
      is_asked_(static_cast<std::size_t>(model.variable_count()), false),
      make_solver_(std::move(make_solver)),
      parents_(static_cast<std::size_t>(model.variable_count())),
      bounds_(bounds) {
  Codes codes;
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    codes.clear();
    for (const auto literal : model.clauses[i]) codes.push_back(ClausePropagation::code(literal));
    if (codes.size() == 1) units_.push_back(codes.front());
    if (codes.size() > 1) clauses_.push_back(state_.add(codes));
  }
  for (const auto literal : asked) {
    asked_.push_back(literal.var());
    is_asked_[static_cast<std::size_t>(literal.var()) - 1] = true;
  }
}

void OpenVariables::set(std::span<const Literal> told) {
  state_.undo(0);
  bool fine = true;
  for (const auto unit : units_) fine = fine && state_.assume(unit);
  for (const auto literal : told) fine = fine && state_.assume(ClausePropagation::code(literal));
  PARALLAX_REQUIRE(fine && state_.propagate(), "what is told is true in some valuation");
}

std::uint32_t OpenVariables::root_of(std::uint32_t variable) {
  while (parents_[variable] != variable) {
    parents_[variable] = parents_[parents_[variable]];
    variable = parents_[variable];
  }
  return variable;
}

/// Connected components of the clauses that are not satisfied, in their order.
std::vector<OpenVariables::Component> OpenVariables::components() {
  std::iota(parents_.begin(), parents_.end(), 0U);
  Codes rest;
  for (const auto clause : clauses_) {
    const auto begin = rest.size();
    bool holds = false;
    for (const auto* code = state_.literals(clause); *code != kEnd && !holds; ++code) {
      holds = state_.is_true(*code);
      if (state_.is_open(*code)) rest.push_back(*code);
    }
    if (holds) {
      rest.resize(begin);
      continue;
    }
    const auto first = static_cast<std::uint32_t>(variable_of(rest[begin]));
    for (auto i = begin; i < rest.size(); ++i) {
      parents_[root_of(static_cast<std::uint32_t>(variable_of(rest[i])))] = root_of(first);
    }
    rest.push_back(kEnd);
  }
  std::map<std::uint32_t, Component> by_root;
  for (auto at = rest.begin(); at != rest.end();) {
    const auto end = std::next(std::find(at, rest.end(), kEnd));
    auto& component = by_root[root_of(static_cast<std::uint32_t>(variable_of(*at)))];
    component.insert(component.end(), at, end);
    at = end;
  }
  std::vector<Component> out;
  for (auto& [root, component] : by_root) out.push_back(std::move(component));
  return out;
}

/// A solver of its own with variables of its own: it knows nothing of the rest.
std::optional<std::vector<std::int32_t>> OpenVariables::open_in(const Component& component) const {
  std::map<std::size_t, Literal> numbers;
  const auto solver = make_solver_();
  std::vector<Literal> clause;
  for (const auto code : component) {
    if (code == kEnd) {
      solver->add_clause(clause);
      clause.clear();
      continue;
    }
    const auto next = Literal::positive(static_cast<std::int32_t>(numbers.size()) + 1);
    const auto literal = numbers.try_emplace(variable_of(code), next).first->second;
    clause.push_back((code & 1U) == 0 ? literal : ~literal);
  }
  auto status = solver->solve();
  PARALLAX_REQUIRE(status != SolveStatus::kUnsatisfiable, "the rest of clauses that hold together");
  std::vector<std::pair<std::int32_t, Literal>> same;  // as in all valuations that were found
  for (const auto& [variable, literal] : numbers) {
    if (status != SolveStatus::kSatisfiable || !is_asked_[variable]) continue;
    same.emplace_back(static_cast<std::int32_t>(variable) + 1,
                      solver->value(literal) ? literal : ~literal);
  }
  std::vector<std::int32_t> open;
  while (status == SolveStatus::kSatisfiable && !same.empty()) {
    clause.clear();
    for (const auto& [variable, literal] : same) clause.push_back(~literal);
    solver->add_clause(clause);  // it stays: the next one, over fewer of them, implies it
    status = solver->solve();
    if (status != SolveStatus::kSatisfiable) break;
    std::erase_if(same, [&](const auto& one) {
      const bool differs = !solver->value(one.second);
      if (differs) open.push_back(one.first);
      return differs;
    });
  }
  if (status == SolveStatus::kUnknown) return std::nullopt;
  return open;
}

void OpenVariables::keep(Component component, const std::vector<std::int32_t>& open) {
  if (component.size() > bounds_.one) return;
  if (known_.size() == kMostKnown || kept_codes_ + component.size() > bounds_.all) {
    known_.clear();
    kept_codes_ = 0;
  }
  kept_codes_ += component.size();
  known_.emplace(std::move(component), open);
}

std::optional<std::vector<std::int32_t>> OpenVariables::find(std::span<const Literal> told) {
  set(told);
  std::vector<std::int32_t> open;
  std::vector<bool> is_bound(is_asked_.size(), false);
  for (auto& component : components()) {
    bool is_asked = false;
    for (const auto code : component) {
      if (code == kEnd) continue;
      is_bound[variable_of(code)] = true;
      is_asked = is_asked || is_asked_[variable_of(code)];
    }
    if (!is_asked) continue;
    if (const auto known = known_.find(component); known != known_.end()) {
      open.insert(open.end(), known->second.begin(), known->second.end());
      continue;
    }
    const auto found = open_in(component);
    if (!found) return std::nullopt;
    open.insert(open.end(), found->begin(), found->end());
    keep(std::move(component), *found);
  }
  // A variable without a remaining clause may have either value.
  for (const auto variable : asked_) {
    const auto place = static_cast<std::size_t>(variable) - 1;
    if (!is_bound[place] && state_.is_open(static_cast<std::uint32_t>(2 * place))) {
      open.push_back(variable);
    }
  }
  return open;
}

}  // namespace parallax::runtime
