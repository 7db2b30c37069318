// Temporal formulas in negation normal form, without quantifiers around their operators.
//
// Negations are pushed down to the state formulas by the duals of the operators (until and
// release, next and weak next, since and triggered), quantifiers over temporal operators are
// expanded into their instances, and a part under the same bindings is one node. Children come
// before their parents, so passes go through the nodes in order. A formula about the future
// whose operators are not nested has an equal one that looks back from the end: eventually F is
// once F, always F is historically F, until and release likewise. Cost: linear in the expanded
// formula; its size and depth are limited.

#include "compiler/pipeline/temporal_tree.h"

#include <algorithm>

#include "compiler/base/codes/texts.h"

namespace parallax::compiler {
namespace {

using Kind = TemporalTree::Kind;

/// By formula up to the root: parts are added to the store before what they are parts of.
std::vector<bool> with_operators(const TypedModel& model, TypedFormulaId root) {
  std::vector<bool> out(root.index() + 1, false);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const auto& formula = model.formulas[model.formulas.id_at(i)];
    out[i] = formula.kind == FormulaKind::kTemporal ||
             std::any_of(formula.children.begin(), formula.children.end(),
                         [&](TypedFormulaId child) { return out[child.index()]; });
  }
  return out;
}

Kind kind_of(TemporalOp op, bool negated) {
  switch (op) {
    case TemporalOp::kAlways:
      return negated ? Kind::kEventually : Kind::kAlways;
    case TemporalOp::kEventually:
      return negated ? Kind::kAlways : Kind::kEventually;
    case TemporalOp::kNext:
      return negated ? Kind::kWeakNext : Kind::kNext;
    case TemporalOp::kWeakNext:
      return negated ? Kind::kNext : Kind::kWeakNext;
    case TemporalOp::kUntil:
      return negated ? Kind::kRelease : Kind::kUntil;
    case TemporalOp::kHistorically:
      return negated ? Kind::kOnce : Kind::kHistorically;
    case TemporalOp::kOnce:
      return negated ? Kind::kHistorically : Kind::kOnce;
    case TemporalOp::kPreviously:
      return negated ? Kind::kWeakPreviously : Kind::kPreviously;
    case TemporalOp::kSince:
      return negated ? Kind::kTriggered : Kind::kSince;
  }
  return Kind::kAlways;
}

bool is_about_later(Kind kind) { return kind >= Kind::kAlways && kind <= Kind::kRelease; }

}  // namespace

TemporalTree::TemporalTree(GroundModel& model, FormulaGrounder& grounder, base::SourceRange place,
                           base::DiagnosticSink& sink)
    : model_(model), grounder_(grounder), place_(place), sink_(sink) {}

base::SourceRange TemporalTree::source(TypedFormulaId formula) const {
  const auto& own = model_.typed().formulas[formula].source;
  return own.file == place_.file ? own : place_;
}

std::optional<TemporalTree::Number> TemporalTree::add(TypedFormulaId formula, bool negated) {
  temporal_ = with_operators(model_.typed(), formula);
  grounder_.start(place_);
  return made(formula, negated, 0, 1);
}

TemporalTree::Number TemporalTree::push(Node node) {
  node.looks_on = is_about_later(node.kind);
  for (const auto child : node.children) node.looks_on |= nodes_[child].looks_on;
  nodes_.push_back(std::move(node));
  return static_cast<Number>(nodes_.size() - 1);
}

TemporalTree::Number TemporalTree::wrap(Kind kind, std::vector<Number> children) {
  Node node;
  node.kind = kind;
  node.formula = nodes_[children.back()].formula;
  node.children = std::move(children);
  return push(std::move(node));
}

std::optional<TemporalTree::Number> TemporalTree::made(TypedFormulaId id, bool negated,
                                                       Number binding, std::size_t level) {
  const std::tuple key(id.index(), negated, binding);
  const auto found = known_.find(key);
  if (found != known_.end()) return found->second;
  if (level > kMostLevels) {
    sink_.error(codes::kFormulaTooDeep, source(id), kMostLevels);
    return std::nullopt;
  }
  const auto node = grounder_.spend(1) ? make(id, negated, binding, level) : std::nullopt;
  if (node) known_.emplace(key, *node);
  return node;
}

std::optional<TemporalTree::Number> TemporalTree::make(TypedFormulaId id, bool negated,
                                                       Number binding, std::size_t level) {
  const auto& formula = model_.typed().formulas[id];
  Node node;
  node.formula = id;
  if (!temporal_[id.index()]) {
    node.negated = negated;
    node.binding = binding;
    return push(std::move(node));
  }
  const auto part = [&](std::size_t i, bool sign) {
    return made(formula.children[i], sign, binding, level + 1);
  };
  const auto joined = [&](Kind kind, const std::vector<std::optional<Number>>& parts) {
    node.kind = kind;
    for (const auto& child : parts) {
      if (!child) return std::optional<Number>();
      node.children.push_back(*child);
    }
    return std::optional(push(node));
  };
  switch (formula.kind) {
    case FormulaKind::kNot:
      return part(0, !negated);
    case FormulaKind::kAnd:
    case FormulaKind::kOr: {
      std::vector<std::optional<Number>> parts;
      for (std::size_t i = 0; i < formula.children.size(); ++i) parts.push_back(part(i, negated));
      return joined((formula.kind == FormulaKind::kAnd) != negated ? Kind::kAnd : Kind::kOr, parts);
    }
    case FormulaKind::kImplies:
      return joined(negated ? Kind::kAnd : Kind::kOr, {part(0, !negated), part(1, negated)});
    case FormulaKind::kIff: {
      const auto a = part(0, false), b = part(1, false), no_a = part(0, true), no_b = part(1, true);
      if (!a || !b || !no_a || !no_b) return std::nullopt;
      const auto same = wrap(Kind::kAnd, {*a, negated ? *no_b : *b});
      const auto none = wrap(Kind::kAnd, {*no_a, negated ? *b : *no_b});
      return joined(Kind::kOr, {same, none});
    }
    case FormulaKind::kForall:
    case FormulaKind::kExists:
      return quantified(id, negated, binding, level);
    case FormulaKind::kTemporal:
      if (formula.children.size() == 1) {
        return joined(kind_of(formula.temporal, negated), {part(0, negated)});
      }
      return joined(kind_of(formula.temporal, negated), {part(0, negated), part(1, negated)});
    case FormulaKind::kTrue:
    case FormulaKind::kFalse:
    case FormulaKind::kAtom:
    case FormulaKind::kCompare:
    case FormulaKind::kAggregate:
      break;
  }
  return std::nullopt;
}

std::optional<TemporalTree::Number> TemporalTree::quantified(TypedFormulaId id, bool negated,
                                                             Number binding, std::size_t level) {
  const auto& formula = model_.typed().formulas[id];
  Node node;
  node.kind = (formula.kind == FormulaKind::kForall) != negated ? Kind::kAll : Kind::kAny;
  node.formula = id;
  // Bindings of the first variables, then of the first two, ...
  std::vector<Number> bindings = {binding};
  for (const auto variable : formula.variables) {
    std::vector<Number> longer;
    for (const auto outer : bindings) {
      for (const auto value : model_.universe().domain(model_.typed().variables[variable].sort)) {
        if (!grounder_.spend(1)) return std::nullopt;
        bindings_.push_back({outer, variable, value});
        longer.push_back(static_cast<Number>(bindings_.size() - 1));
      }
    }
    bindings = std::move(longer);
  }
  for (const auto inner : bindings) {
    const auto child = made(formula.children[0], negated, inner, level + 1);
    if (!child) return std::nullopt;
    node.children.push_back(*child);
  }
  return push(std::move(node));
}

void TemporalTree::bind(Number binding) {
  for (; binding != 0; binding = bindings_[binding].outer) {
    grounder_.bind(bindings_[binding].variable, bindings_[binding].value);
  }
}

void TemporalTree::unbind(Number binding) {
  for (; binding != 0; binding = bindings_[binding].outer) {
    grounder_.unbind(bindings_[binding].variable);
  }
}

std::optional<TemporalTree::Number> TemporalTree::looking_back(Number number) {
  const auto node = nodes_[number];
  if (!node.looks_on) return wrap(Kind::kAtStart, {number});
  std::vector<Number> parts;
  if (!is_about_later(node.kind)) {
    const bool junction = node.kind >= Kind::kAnd && node.kind <= Kind::kAny;
    for (const auto child : node.children) {
      const auto part = junction ? looking_back(child) : std::nullopt;
      if (!part) return std::nullopt;
      parts.push_back(*part);
    }
    return wrap(node.kind, std::move(parts));
  }
  for (const auto child : node.children) {
    if (nodes_[child].looks_on) return std::nullopt;
  }
  const auto last = node.children.back();
  if (node.kind == Kind::kEventually) return wrap(Kind::kOnce, {last});
  if (node.kind == Kind::kAlways) return wrap(Kind::kHistorically, {last});
  if (node.kind == Kind::kUntil) {
    // The right side at some timepoint, the left one at all before it.
    const auto before = wrap(Kind::kHistorically, {node.children[0]});
    return wrap(Kind::kOnce, {wrap(Kind::kAnd, {wrap(Kind::kWeakPreviously, {before}), last})});
  }
  if (node.kind != Kind::kRelease) return std::nullopt;
  // The right side at all timepoints up to one with the left one, or up to the end.
  const auto so_far = wrap(Kind::kHistorically, {last});
  const auto released = wrap(Kind::kOnce, {wrap(Kind::kAnd, {node.children[0], so_far})});
  return wrap(Kind::kOr, {released, so_far});
}

}  // namespace parallax::compiler
