#include "tools/app/trace_fact.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "compiler/base/codes/campaigns.h"
#include "compiler/base/suggest.h"
#include "compiler/base/whole_number.h"
#include "compiler/syntax/lexer.h"
#include "compiler/syntax/parser.h"
#include "compiler/syntax/printer.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {
namespace {

using compiler::Ast;
using compiler::AtomKind;
using compiler::NodeId;
using compiler::NodeKind;

/// An atom as texts: `HoldsAt(F(a),3)` as HoldsAt, F(a), 3; other names are those of predicates.
struct Parts {
  AtomKind kind = AtomKind::kPredicate;
  std::string name;
  std::string time;
};

/// A term as traces print it.
std::string compact(const Ast& ast, NodeId term) {
  auto text = compiler::print_formula(ast, term);
  std::erase(text, ' ');
  return text;
}

Parts split(const Ast& ast, NodeId atom) {
  static constexpr std::pair<std::string_view, AtomKind> kKinds[] = {
      {"HoldsAt", AtomKind::kHoldsAt},
      {"Happens", AtomKind::kHappens},
      {"ReleasedAt", AtomKind::kReleasedAt}};
  const auto& node = ast[atom];
  for (const auto& [predicate, kind] : kKinds) {
    if (node.kind != NodeKind::kApply || ast.name(node) != predicate) continue;
    if (node.child_count == 0) return {kind, "", ""};
    return {kind, compact(ast, ast.child(node, 0)),
            node.child_count == 2 ? compact(ast, ast.child(node, 1)) : ""};
  }
  return {AtomKind::kPredicate, compact(ast, atom), ""};
}

std::vector<std::string> known_names(AtomKind kind, const compiler::CompiledModel& model) {
  if (kind == AtomKind::kHappens) return compiler::names_of(model.events);
  if (kind != AtomKind::kPredicate) return compiler::names_of(model.fluents);
  std::vector<std::string> names;
  for (const auto& atom : model.fixed) {
    if (atom.kind == AtomKind::kPredicate && !atom.time) names.push_back(atom.name);
  }
  return names;
}

}  // namespace

base::Result<TraceFact> parse_fact(const std::string& text, const compiler::CompiledModel& model,
                                   Context& context) {
  const auto range = formula_argument("--why", text, context);
  if (!range) return context.sink().already_reported();
  const auto fail = [&](base::SourceRange at, const std::string& problem) {
    return context.sink().error(codes::kNoSuchFact, at, compiler::shortened(text), problem);
  };
  base::DiagnosticSink own;
  const auto parsed = compiler::parse_formula(*range, context.files(), own);
  if (!parsed) {
    const auto first = own.sorted().front();
    return fail(first.range.value_or(*range), first.message);
  }
  const auto& ast = parsed->ast;
  TraceFact fact;
  auto atom = parsed->root;
  while (ast[atom].kind == NodeKind::kUnary && ast[atom].op == compiler::Operator::kNot) {
    atom = ast.child(ast[atom], 0);
    fact.negated = !fact.negated;
  }
  const auto place = ast.source(ast[atom]);
  const auto parts = split(ast, atom);
  fact.kind = parts.kind;
  fact.name = parts.name;
  const auto names = known_names(fact.kind, model);
  const auto known = [&](const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (!known(fact.name) && known(fact.name + "()")) fact.name += "()";
  if (!known(fact.name)) {
    const auto* what = fact.kind == AtomKind::kHappens     ? "event"
                       : fact.kind == AtomKind::kPredicate ? "atom of a predicate"
                                                           : "fluent";
    const auto near = base::nearest_name(fact.name, names);
    return fail(place, fmt::format("the model has no {} `{}`{}", what, fact.name,
                                   near ? fmt::format(", but `{}`", *near) : ""));
  }
  if (fact.kind != AtomKind::kPredicate) {
    fact.time = base::whole_number<compiler::Timepoint>(parts.time);
    if (fact.time.value_or(-1) < 0) {
      return fail(place, fmt::format("`{}` is no timepoint", parts.time));
    }
  }
  fact.atom = compiler::AtomIndex(model).find(fact.kind, fact.name, fact.time);
  return fact;
}

}  // namespace parallax::tools
