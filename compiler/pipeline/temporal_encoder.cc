// Linear temporal logic over finite traces (De Giacomo and Vardi 2013) as formulas of the model.
//
// The value of an operator at t follows from its parts at t and from itself at t + 1 (until,
// ...) or at t - 1 (since, ...), so each operator is one small definition for each timepoint,
// named by an auxiliary. Each node has two values: for traces that end at t, where nothing
// happens, and for those that go on. A goal is asked about every end; the first of these ways
// that applies is taken: an equal formula that looks back, whose values for all ends are found
// in one pass; the automaton of the formula or of its negation (temporal_automaton.cc); or else
// one unrolled formula for each end. A violation is asked about one end, the first hit, so one
// unrolling suffices, in which a trace that is not complete counts only what is false however it
// goes on.
//
// Cost: operators times the horizon for a past formula or a violation, times the horizon squared
// when unrolled for each end.

#include "compiler/pipeline/temporal_encoder.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "compiler/base/codes/grounding.h"

namespace parallax::compiler {

TemporalEncoder::TemporalEncoder(const StateConstraint& formula, std::uint32_t origin,
                                 GroundModel& model, FormulaGrounder& grounder,
                                 base::DiagnosticSink& sink)
    : formula_(formula),
      origin_(origin),
      model_(model),
      grounder_(grounder),
      sink_(sink),
      formulas_(model.formulas()),
      tree_(model, grounder, formula.source, sink) {}

std::optional<TemporalEncoder::Values> TemporalEncoder::fulfilled() {
  auto root = tree_.add(formula_.formula.formula, false);
  if (!root) return std::nullopt;
  if (!settle(*root) || !says_something()) return std::nullopt;
  return tree_[*root].looks_on ? fulfilled(*root) : nodes_[*root].ends;
}

/// By n, of the trace from 0 to n: the node at 0.
std::optional<TemporalEncoder::Values> TemporalEncoder::fulfilled(Number part) {
  const auto node = tree_[part];
  const auto size = static_cast<std::size_t>(model_.horizon()) + 1;
  if (node.looks_on && node.kind >= Kind::kAnd && node.kind <= Kind::kAny) {
    std::vector<Values> children;
    for (const auto child : node.children) {
      auto values = fulfilled(child);
      if (!values) return std::nullopt;
      children.push_back(*std::move(values));
    }
    Values out;
    for (std::size_t n = 0; n < size; ++n) {
      out.push_back(junction(part, [&](std::size_t i) { return children[i][n]; }));
    }
    return out;
  }
  if (const auto back = tree_.looking_back(part)) {
    if (!settle(*back)) return std::nullopt;
    return nodes_[*back].ends;
  }
  if (!settle(part)) return std::nullopt;
  if (auto values = by_automaton(part)) return values;
  // Another formula for each end.
  Values out;
  for (Timepoint n = 0; n <= model_.horizon(); ++n) {
    const View view{n, nullptr, nullptr};
    settle_future(view);
    out.push_back(any(part, 0, view));
  }
  return out;
}

/// Values by the smaller automaton, of the formula or of its negation. None: both are larger than
/// one formula for each end, and larger than a size that is small in any case.
std::optional<TemporalEncoder::Values> TemporalEncoder::by_automaton(Number part) {
  constexpr std::size_t kSmall = 64;  // steps for each timepoint
  const auto size = static_cast<std::size_t>(model_.horizon()) + 1;
  const auto operators = static_cast<std::size_t>(std::count_if(
      wanted_.begin(), wanted_.end(), [&](Number number) { return tree_[number].looks_on; }));
  auto most = size * std::max(operators * size / 2, kSmall);
  TemporalAutomaton straight(tree_, nodes_, formulas_, model_.horizon());
  TemporalAutomaton opposite(tree_, nodes_, formulas_, model_.horizon());
  const bool has_straight = straight.build(part, false, most);
  if (has_straight) most = straight.size() > 0 ? straight.size() - 1 : 0;
  const bool has_opposite = opposite.build(part, true, most);
  if (!has_straight && !has_opposite) return std::nullopt;
  const auto name = [&](FormulaId formula) { return *named(formula); };
  if (!has_opposite) return straight.values(name);
  auto out = opposite.values(name);
  for (auto& value : out) {
    if (value) value = ~*value;
  }
  return out;
}

base::Status TemporalEncoder::require_violation(const std::vector<FormulaId>& hit,
                                                const std::vector<FormulaId>& complete,
                                                const std::vector<FormulaId>& known) {
  auto root = tree_.add(formula_.formula.formula, true);
  if (!root) return sink_.already_reported();
  if (!tree_[*root].looks_on) root = tree_.wrap(Kind::kEventually, {*root});
  if (!settle(*root) || !says_something()) return sink_.already_reported();
  const View view{model_.horizon(), &hit, &complete};
  settle_future(view);
  const auto violated = any(*root, 0, view).value_or(formulas_.falsity());
  // A hit that nothing were said of would have no variable.
  const bool in_any_case = violated == formulas_.truth();
  for (std::size_t n = 0; n < hit.size(); ++n) {
    const auto may_end = formulas_.conjunction(violated, known[n]);
    model_.require(in_any_case ? formulas_.equivalence(hit[n], known[n])
                               : formulas_.implication(hit[n], may_end),
                   origin_);
  }
  return base::Unit{};
}

/// Works out all that does not depend on where traces end, but for the end itself.
bool TemporalEncoder::settle(Number root) {
  nodes_.resize(tree_.size());
  std::set<Number> wanted;
  std::vector<Number> todo = {root};
  while (!todo.empty()) {
    const auto number = todo.back();
    todo.pop_back();
    if (!wanted.insert(number).second) continue;
    const auto& children = tree_[number].children;
    todo.insert(todo.end(), children.begin(), children.end());
  }
  wanted_.assign(wanted.begin(), wanted.end());
  for (const auto number : wanted_) {
    if (!nodes_[number].ends.empty()) continue;
    if (tree_[number].kind == Kind::kLeaf) {
      if (!settle_leaf(number)) return false;
    } else if (!tree_[number].looks_on) {
      settle_past(number);
    }
  }
  return true;
}

/// A state formula of which no instance names timepoints that there are makes what stands around it
/// true or false by being left out, so it is reported. To be asked behind `settle` of the root.
bool TemporalEncoder::says_something() {
  std::map<std::size_t, std::pair<TypedFormulaId, bool>> said;  // by formula
  for (const auto number : wanted_) {
    if (tree_[number].kind != Kind::kLeaf) continue;
    const auto& ends = nodes_[number].ends;
    const bool any = std::any_of(ends.begin(), ends.end(), [](const auto& v) { return bool(v); });
    const auto formula = tree_[number].formula;
    auto& before = said.try_emplace(formula.index(), formula, false).first->second.second;
    before = before || any;
  }
  for (const auto& [number, entry] : said) {
    if (entry.second) continue;
    sink_.error(codes::kNothingToSay, tree_.source(entry.first), model_.horizon());
    return false;
  }
  return true;
}

// --- leaves ----------------------------------------------------------------------------------

bool TemporalEncoder::settle_leaf(Number number) {
  const auto& leaf = tree_[number];
  auto& node = nodes_[number];
  const auto source = tree_.source(leaf.formula);
  grounder_.start(source);
  grounder_.name_last_events(true);
  tree_.bind(leaf.binding);
  bool fine = true;
  for (Timepoint t = 0; t <= model_.horizon() && !grounder_.failed(); ++t) {
    if (formula_.formula.time) {
      grounder_.bind(*formula_.formula.time, model_.terms().integer(t));
    }
    auto value = grounder_.ground(leaf.formula);
    fine = !value || !looks_ahead(*value, t);
    if (!fine) {
      sink_.error(codes::kConstraintLooksAhead, source);
      break;
    }
    if (value && leaf.negated) value = ~*value;
    node.ends.push_back(value ? Value(at_last(*value, t, true)) : Value());
    node.surely.push_back(value ? Value(at_last(*value, t, false)) : Value());
    if (t < model_.horizon()) node.goes_on.push_back(value);
  }
  tree_.unbind(leaf.binding);
  grounder_.name_last_events(false);
  return fine && !grounder_.failed();
}

bool TemporalEncoder::looks_ahead(FormulaId formula, Timepoint t) const {
  const auto atoms = atoms_of(formulas_, std::vector{formula});
  return std::any_of(atoms.begin(), atoms.end(),
                     [&](std::int32_t variable) { return model_.atom(variable).time > t; });
}

/// The formula where t is the last timepoint: nothing happens there, or its events are not known
/// and the formula is true in any case.
FormulaId TemporalEncoder::at_last(FormulaId root, Timepoint t, bool nothing_happens) const {
  const auto is_event = [&](std::int32_t variable) {
    const auto& atom = model_.atom(variable);
    return atom.kind == AtomKind::kHappens && atom.time == t;
  };
  const auto atoms = atoms_of(formulas_, std::vector{root});
  if (std::none_of(atoms.begin(), atoms.end(), is_event)) return root;
  // By node: the formula and its negation, children first.
  std::set<std::uint32_t> nodes;
  std::vector<FormulaId> todo = {root};
  while (!todo.empty()) {
    const auto id = todo.back();
    todo.pop_back();
    if (!nodes.insert(id.node()).second) continue;
    if (formulas_.kind(id) != FormulaNodeKind::kAnd) continue;
    const auto children = formulas_.children(id);
    todo.insert(todo.end(), children.begin(), children.end());
  }
  std::map<std::uint32_t, std::pair<FormulaId, FormulaId>> made;
  const auto of = [&](FormulaId id) {
    const auto& both = made.at(id.node());
    return id.negated() ? both.second : both.first;
  };
  for (const auto number : nodes) {
    const auto id = formulas_.at(number);
    auto& both = made[number] = {id, ~id};
    if (formulas_.kind(id) == FormulaNodeKind::kAtom && is_event(formulas_.variable(id))) {
      both = {formulas_.falsity(), formulas_.constant(nothing_happens)};
    } else if (formulas_.kind(id) == FormulaNodeKind::kAnd) {
      const auto children = formulas_.children(id);
      std::vector<FormulaId> all, some;
      for (const auto child : std::vector(children.begin(), children.end())) {
        all.push_back(of(child));
        some.push_back(of(~child));
      }
      both = {formulas_.conjunction(std::move(all)), formulas_.disjunction(std::move(some))};
    }
  }
  return of(root);
}

// --- what looks back -------------------------------------------------------------------------

void TemporalEncoder::settle_past(Number number) {
  auto& node = nodes_[number];
  for (Timepoint t = 0; t <= model_.horizon(); ++t) {
    node.ends.push_back(past(number, t, &Node::ends));
    node.surely.push_back(past(number, t, &Node::surely));
    if (t == model_.horizon()) break;
    node.goes_on.push_back(named(past(number, t, &Node::goes_on)));
  }
}

/// Value of an inner node that is not about later timepoints. `column` gives its children's values
/// at t; at earlier timepoints the trace went on.
TemporalEncoder::Value TemporalEncoder::past(Number number, Timepoint t,
                                             const Values Node::*column) {
  const auto& node = tree_[number];
  const auto at = static_cast<std::size_t>(t);
  const auto child = [&](std::size_t i) { return (nodes_[node.children[i]].*column)[at]; };
  const auto before = [&](Number of) { return t > 0 ? nodes_[of].goes_on[at - 1] : std::nullopt; };
  const auto truth = formulas_.truth(), falsity = formulas_.falsity();
  switch (node.kind) {
    case Kind::kOnce:
      return formulas_.disjunction(child(0).value_or(falsity), before(number).value_or(falsity));
    case Kind::kHistorically:
      return formulas_.conjunction(child(0).value_or(truth), before(number).value_or(truth));
    case Kind::kPreviously:
      return t > 0 ? before(node.children[0]) : falsity;
    case Kind::kWeakPreviously:
      return t > 0 ? before(node.children[0]) : truth;
    case Kind::kSince: {
      const auto held =
          formulas_.conjunction(child(0).value_or(truth), before(number).value_or(falsity));
      return formulas_.disjunction(child(1).value_or(falsity), held);
    }
    case Kind::kTriggered: {
      const auto held =
          formulas_.disjunction(child(0).value_or(falsity), before(number).value_or(truth));
      return formulas_.conjunction(child(1).value_or(truth), held);
    }
    case Kind::kAtStart:
      return t > 0 ? nodes_[node.children[0]].goes_on[0] : child(0);
    case Kind::kAnd:
    case Kind::kOr:
    case Kind::kAll:
    case Kind::kAny:
      return junction(number, child);
    case Kind::kLeaf:
    case Kind::kAlways:
    case Kind::kEventually:
    case Kind::kNext:
    case Kind::kWeakNext:
    case Kind::kUntil:
    case Kind::kRelease:
      break;
  }
  return std::nullopt;
}

TemporalEncoder::Value TemporalEncoder::junction(
    Number number, const std::function<Value(std::size_t)>& child) const {
  const auto kind = tree_[number].kind;
  const auto parts = tree_[number].children.size();
  std::vector<FormulaId> there;
  for (std::size_t i = 0; i < parts; ++i) {
    if (const auto part = child(i)) there.push_back(*part);
  }
  const bool quantified = kind == Kind::kAll || kind == Kind::kAny;
  if (there.size() < parts && (!quantified || there.empty())) return std::nullopt;
  return kind == Kind::kAnd || kind == Kind::kAll ? formulas_.conjunction(std::move(there))
                                                  : formulas_.disjunction(std::move(there));
}

// --- what looks on ---------------------------------------------------------------------------

void TemporalEncoder::settle_future(const View& view) {
  any_.clear();
  for (const auto number : wanted_) {
    if (!tree_[number].looks_on) continue;
    auto& node = nodes_[number];
    const auto size = static_cast<std::size_t>(view.last) + 1;
    node = {Values(size), Values(size), Values(size)};
    const bool backwards = tree_[number].kind < Kind::kHistorically;
    for (Timepoint i = 0; i <= view.last; ++i) {
      const auto t = backwards ? view.last - i : i;
      const auto at = static_cast<std::size_t>(t);
      if (view.hit != nullptr || t == view.last) {
        node.ends[at] = node.surely[at] = ending(number, t, view);
      }
      if (t == view.last) continue;
      node.goes_on[at] = going_on(number, t, view);
      if (!backwards) node.goes_on[at] = named(node.goes_on[at]);
    }
  }
}

/// Value of a node for a trace that ends at t. If the trace is not complete, only what is true in
/// any case counts.
TemporalEncoder::Value TemporalEncoder::end_value(Number number, Timepoint t,
                                                  const View& view) const {
  const auto& node = nodes_[number];
  const auto at = static_cast<std::size_t>(t);
  if (view.hit == nullptr || tree_[number].looks_on || !node.ends[at]) return node.ends[at];
  return formulas_.disjunction(*node.surely[at],
                               formulas_.conjunction(complete(t, view), *node.ends[at]));
}

FormulaId TemporalEncoder::complete(Timepoint t, const View& view) const {
  return view.complete == nullptr ? formulas_.truth()
                                  : (*view.complete)[static_cast<std::size_t>(t)];
}

TemporalEncoder::Value TemporalEncoder::ending(Number number, Timepoint t, const View& view) {
  const auto& node = tree_[number];
  const auto child = [&](std::size_t i) { return end_value(node.children[i], t, view); };
  const auto truth = formulas_.truth(), falsity = formulas_.falsity();
  switch (node.kind) {
    case Kind::kAlways:
      return formulas_.conjunction(child(0).value_or(truth), complete(t, view));
    case Kind::kEventually:
      return child(0).value_or(falsity);
    case Kind::kNext:
      return falsity;
    case Kind::kWeakNext:
      return complete(t, view);
    case Kind::kUntil:
      return child(1).value_or(falsity);
    case Kind::kRelease:
      return formulas_.conjunction(
          child(1).value_or(truth),
          formulas_.disjunction(child(0).value_or(falsity), complete(t, view)));
    case Kind::kAnd:
    case Kind::kOr:
    case Kind::kAll:
    case Kind::kAny:
      return junction(number, child);
    case Kind::kLeaf:
    case Kind::kHistorically:
    case Kind::kOnce:
    case Kind::kPreviously:
    case Kind::kWeakPreviously:
    case Kind::kSince:
    case Kind::kTriggered:
    case Kind::kAtStart:
      break;
  }
  if (view.hit == nullptr) return past(number, t, &Node::ends);
  const auto certain = past(number, t, &Node::surely);
  const auto ended = past(number, t, &Node::ends);
  if (!certain || !ended) return std::nullopt;
  return formulas_.disjunction(*certain, formulas_.conjunction(complete(t, view), *ended));
}

TemporalEncoder::Value TemporalEncoder::going_on(Number number, Timepoint t, const View& view) {
  const auto& node = tree_[number];
  const auto child = [&](std::size_t i) {
    return nodes_[node.children[i]].goes_on[static_cast<std::size_t>(t)];
  };
  const auto truth = formulas_.truth(), falsity = formulas_.falsity();
  switch (node.kind) {
    case Kind::kAlways:
      return formulas_.conjunction(child(0).value_or(truth), *any(number, t + 1, view));
    case Kind::kEventually:
      return formulas_.disjunction(child(0).value_or(falsity), *any(number, t + 1, view));
    case Kind::kNext:
    case Kind::kWeakNext:
      return any(node.children[0], t + 1, view);
    case Kind::kUntil: {
      const auto on = formulas_.conjunction(child(0).value_or(truth), *any(number, t + 1, view));
      return formulas_.disjunction(child(1).value_or(falsity), on);
    }
    case Kind::kRelease: {
      const auto on = formulas_.disjunction(child(0).value_or(falsity), *any(number, t + 1, view));
      return formulas_.conjunction(child(1).value_or(truth), on);
    }
    case Kind::kAnd:
    case Kind::kOr:
    case Kind::kAll:
    case Kind::kAny:
    case Kind::kLeaf:
    case Kind::kHistorically:
    case Kind::kOnce:
    case Kind::kPreviously:
    case Kind::kWeakPreviously:
    case Kind::kSince:
    case Kind::kTriggered:
    case Kind::kAtStart:
      return past(number, t, &Node::goes_on);
  }
  return std::nullopt;
}

/// At t, wherever the trace ends.
TemporalEncoder::Value TemporalEncoder::any(Number number, Timepoint t, const View& view) {
  const auto at = static_cast<std::size_t>(t);
  if (t == view.last && view.hit == nullptr) return end_value(number, t, view);
  const auto [known, added] = any_.try_emplace({number, t});
  if (!added) return known->second;
  const auto ends = view.hit == nullptr ? Value() : end_value(number, t, view);
  const auto goes_on = t == view.last ? Value() : nodes_[number].goes_on[at];
  auto& value = known->second;
  if (view.hit == nullptr) {
    value = named(goes_on);
  } else if (ends == goes_on) {
    value = ends;
  } else if (ends) {
    value = model_.auxiliary_atom(t);
    const auto hit = (*view.hit)[at];
    model_.require(formulas_.implication(formulas_.conjunction(hit, *value), *ends), origin_);
    if (goes_on) {
      model_.require(formulas_.implication(formulas_.conjunction(~hit, *value), *goes_on), origin_);
    }
  }
  return value;
}

/// The formula, or an atom defined as equivalent to it, which keeps the formulas built from it
/// small.
TemporalEncoder::Value TemporalEncoder::named(Value value) {
  if (!value || formulas_.kind(*value) != FormulaNodeKind::kAnd) return value;
  const auto [known, added] = names_.try_emplace(*value);
  if (added) {
    const auto name = model_.auxiliary_atom(model_.needed_horizon_of(*value));
    model_.require(formulas_.equivalence(name, *value), origin_);
    known->second = name;
  }
  return known->second;
}

}  // namespace parallax::compiler
