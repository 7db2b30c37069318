#include "runtime/explain/clause_text.h"

#include <algorithm>
#include <tuple>

namespace parallax::runtime {

using compiler::Atom;
using compiler::AtomKind;
using compiler::Literal;

namespace {

constexpr int kMaxDepth = 12;
constexpr int kMaxParts = 60;

std::string atom_text(const Atom& atom) {
  const auto timed = [&](const char* head) {
    return head + printed(atom) + ',' + std::to_string(atom.time.value_or(0)) + ')';
  };
  switch (atom.kind) {
    case AtomKind::kHoldsAt:
      return timed("HoldsAt(");
    case AtomKind::kHappens:
      return timed("Happens(");
    case AtomKind::kReleasedAt:
      return timed("ReleasedAt(");
    case AtomKind::kLocation:
      return timed("the plan is at (");
    case AtomKind::kHit:
      return "the state constraints hold at " + std::to_string(atom.time.value_or(0));
    case AtomKind::kRunning:
      return "the plan goes on at " + std::to_string(atom.time.value_or(0));
    case AtomKind::kSucceeded:
      return timed("the plan has succeeded at (");
    case AtomKind::kResult:
      return timed("the perform before returned (");
    case AtomKind::kRegister:
      return timed("the plan knows (");
    case AtomKind::kPredicate:
    case AtomKind::kAuxiliary:
    case AtomKind::kUnused:
      break;
  }
  return atom.name;
}

std::string grouped(const std::string& text) {
  return text.find(' ') == std::string::npos ? text : '(' + text + ')';
}

}  // namespace

ClauseText::ClauseText(const compiler::CompiledModel& model)
    : model_(model), auxiliary_(static_cast<std::size_t>(model.variable_count()) + 1, false) {
  for (std::size_t v = 1; v < auxiliary_.size(); ++v) {
    auxiliary_[v] = model.atom(static_cast<std::int32_t>(v)).kind == AtomKind::kAuxiliary;
  }
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    if (!model.clause_is_definition[i]) continue;
    const auto defined = model.clauses[i].front();  // the encoder puts it first
    definitions_[(~defined).dimacs()].push_back(i);
  }
}

const std::vector<std::size_t>& ClauseText::definitions(Literal literal) const {
  static const std::vector<std::size_t> none;
  const auto found = definitions_.find(literal.dimacs());
  return found == definitions_.end() ? none : found->second;
}

std::string ClauseText::literal(Literal literal) const {
  const auto text = atom_text(model_.atom(literal.var()));
  if (literal.is_positive()) return text;
  return '!' + grouped(text);
}

/// An auxiliary literal is as good as the conjunction of what its definition draws from it.
std::string ClauseText::meaning(Literal literal, Budget& budget) const {
  if (!is_auxiliary(literal.var())) return this->literal(literal);
  const auto& found = definitions(literal);
  if (found.empty() || budget.depth == 0 || budget.parts <= 0) return "...";
  --budget.depth;
  std::string text;
  for (const auto index : found) {
    std::vector<Literal> rest;
    const auto clause = model_.clauses[index].subspan(1);
    rest.assign(clause.begin(), clause.end());
    if (!text.empty()) text += " & ";
    const auto part = formula(rest, budget);
    text += found.size() > 1 ? grouped(part) : part;
    if (budget.parts <= 0) break;
  }
  ++budget.depth;
  return text;
}

/// Replaces a disjunction by its parts. In the order of time, then by bytes.
std::vector<Literal> ClauseText::flattened(std::span<const Literal> literals) const {
  std::vector<Literal> flat, open(literals.rbegin(), literals.rend());
  while (!open.empty() && flat.size() < kMaxParts) {
    const auto literal = open.back();
    open.pop_back();
    const auto* found = is_auxiliary(literal.var()) ? &definitions(literal) : nullptr;
    if (found == nullptr || found->size() != 1) {
      flat.push_back(literal);
      continue;
    }
    const auto rest = model_.clauses[found->front()].subspan(1);
    open.insert(open.end(), rest.rbegin(), rest.rend());
  }
  flat.insert(flat.end(), open.rbegin(), open.rend());
  std::stable_sort(flat.begin(), flat.end(), [&](Literal a, Literal b) {
    const auto key = [&](Literal literal) {
      const auto& atom = model_.atom(literal.var());
      const bool last = is_auxiliary(literal.var());
      return std::tuple(last, atom.time.value_or(0), last ? std::string() : atom_text(atom));
    };
    return key(a) < key(b);
  });
  return flat;
}

std::string ClauseText::formula(std::span<const Literal> literals, Budget& budget) const {
  std::string before, after;
  for (const auto literal : flattened(literals)) {
    if (budget.parts-- <= 0) return before + (before.empty() ? "" : " -> ") + after + " | ...";
    // Negated atoms are written before the arrow; auxiliaries, by their meaning, after it.
    const bool denied = !literal.is_positive() && !is_auxiliary(literal.var());
    auto& side = denied ? before : after;
    if (!side.empty()) side += denied ? " & " : " | ";
    side += grouped(denied ? this->literal(~literal) : meaning(literal, budget));
  }
  if (before.empty()) return after.empty() ? "false" : after;
  if (after.empty()) {
    return before.find(" & ") == std::string::npos ? '!' + grouped(before) : "!(" + before + ')';
  }
  return before + " -> " + after;
}

std::string ClauseText::clause(std::size_t index) const {
  Budget budget{kMaxDepth, kMaxParts};
  return formula(model_.clauses[index], budget);
}

}  // namespace parallax::runtime
