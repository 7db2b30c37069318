#include "runtime/induction/state_clause.h"

#include <map>
#include <string>
#include <string_view>

namespace parallax::runtime {

using compiler::AtomKind;
using compiler::CompiledModel;
using compiler::FluentId;
using compiler::Literal;
using compiler::Timepoint;

namespace {

/// `At(R1,Hall)`: `At(*,Hall)` and `At(R1,*)`.
std::vector<std::string> names_with_a_gap(std::string_view name) {
  std::vector<std::string> out;
  const auto open = name.find('(');
  if (open == std::string_view::npos) return out;
  std::size_t begin = open + 1;
  int depth = 0;
  for (auto i = begin; i < name.size(); ++i) {
    const bool ends = depth == 0 && (name[i] == ',' || name[i] == ')');
    if (ends && i > begin) {
      out.push_back(std::string(name.substr(0, begin)) + '*' + std::string(name.substr(i)));
    }
    if (ends) begin = i + 1;
    if (name[i] == '(') ++depth;
    if (name[i] == ')') --depth;
  }
  return out;
}

std::vector<StateClause> exclusions(const CompiledModel& model) {
  std::map<std::string, std::vector<FluentId>> groups;
  for (std::size_t i = 0; i < model.fluents.size(); ++i) {
    if (!model.fluents[i].slot) continue;
    for (auto& name : names_with_a_gap(model.fluents[i].name)) {
      groups[std::move(name)].push_back(FluentId(static_cast<std::uint32_t>(i)));
    }
  }
  std::vector<StateClause> out;
  for (const auto& [name, members] : groups) {
    if (out.size() + members.size() * (members.size() - 1) / 2 > kMostPairs) continue;
    for (std::size_t i = 0; i < members.size(); ++i) {
      for (std::size_t k = i + 1; k < members.size(); ++k) {
        out.push_back({{members[i], false, false}, {members[k], false, false}});
      }
    }
  }
  return out;
}

/// The invariants of the model about the state at t that name nothing but fluents.
void add_known(const CompiledModel& model, Timepoint t, std::vector<StateClause>& out) {
  const compiler::AtomIndex index(model);
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    if (model.clause_timepoints[i] != t ||
        model.origins[model.clause_origins[i]].kind != compiler::OriginKind::kInvariant) {
      continue;
    }
    StateClause clause;
    bool plain = true;
    for (const auto literal : model.clauses[i]) {
      const auto fluent = literal.var() > model.base() ? index.fluent(literal.var()) : std::nullopt;
      const auto atom = fluent ? model.atom(literal.var()) : compiler::Atom{};
      plain = plain && fluent && atom.time == t;
      if (!plain) break;
      clause.push_back({*fluent, atom.kind == AtomKind::kReleasedAt, literal.is_positive()});
    }
    if (plain) out.push_back(std::move(clause));
  }
}

}  // namespace

std::optional<std::vector<Literal>> clause_at(const CompiledModel& model, const StateClause& clause,
                                              Timepoint t) {
  std::vector<Literal> out;
  for (const auto& part : clause) {
    const auto atom =
        part.released ? model.released_at(part.fluent, t) : model.holds_at(part.fluent, t);
    if (atom) {
      out.push_back(part.positive ? *atom : ~*atom);
    } else if (!part.positive) {
      return std::nullopt;
    }
  }
  return out;
}

std::vector<StateClause> candidate_invariants(const CompiledModel& model, Timepoint t) {
  std::vector<StateClause> out;
  for (std::size_t i = 0; i < model.fluents.size(); ++i) {
    const FluentId fluent(static_cast<std::uint32_t>(i));
    for (const bool released : {false, true}) {
      if (released && !model.released_at(fluent, t)) continue;
      for (const bool positive : {false, true}) out.push_back({{fluent, released, positive}});
    }
  }
  for (auto& clause : exclusions(model)) out.push_back(std::move(clause));
  add_known(model, t, out);
  return out;
}

}  // namespace parallax::runtime
