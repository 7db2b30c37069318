#include "compiler/reference/expanded_model.h"

#include <algorithm>
#include <utility>

#include "compiler/base/contract.h"
#include "compiler/base/integer_range.h"
#include "compiler/reference/model_expander.h"

namespace parallax::compiler {
namespace {

std::optional<std::uint32_t> look_up(const std::map<std::string, std::uint32_t>& numbers,
                                     const std::string& text) {
  const auto found = numbers.find(text);
  if (found == numbers.end()) return std::nullopt;
  return found->second;
}

std::vector<std::uint32_t> ascending(std::vector<std::uint32_t> numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

}  // namespace

ReferenceTerms::ReferenceTerms(const TypedModel& model, ReferenceBudget& budget)
    : model_(model),
      budget_(budget),
      domains_(model.sorts.size()),
      members_(model.sorts.size()),
      listed_(model.sorts.size(), false) {
  for (std::size_t i = 0; i < model.sorts.size(); ++i) list_domain(model.sorts.id_at(i));
  for (const auto& entry : model.function_values) {
    std::vector<Value> arguments;
    for (const auto id : entry.arguments) {
      if (const auto value = term(id, {})) arguments.push_back(*value);
    }
    const auto value = term(entry.value, {});
    if (!value || arguments.size() != entry.arguments.size()) continue;
    const auto left = applied(model.symbols[entry.function], arguments);
    function_values_[intern(left, std::nullopt)] = *value;
  }
}

ReferenceTerms::Value ReferenceTerms::intern(const std::string& text,
                                             std::optional<std::int64_t> number) {
  const auto [found, is_new] = values_.emplace(text, static_cast<Value>(texts_.size()));
  if (is_new) {
    texts_.push_back(text);
    numbers_.push_back(number);
  }
  return found->second;
}

/// Subsorts first, then constants, ranges and constructor terms; each value once.
void ReferenceTerms::list_domain(SortId sort) {
  if (listed_[sort.index()]) return;
  listed_[sort.index()] = true;
  std::vector<Value> all;
  for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
    const auto below = model_.sorts.id_at(i);
    const auto& parents = model_.sorts[below].parents;
    if (std::find(parents.begin(), parents.end(), sort) == parents.end()) continue;
    list_domain(below);
    const auto& inner = domain(below);
    all.insert(all.end(), inner.begin(), inner.end());
  }
  for (const auto object : model_.sorts[sort].constants) {
    if (budget_.spend()) all.push_back(intern(model_.objects[object].name, std::nullopt));
  }
  for (const auto& range : model_.sorts[sort].ranges) {
    for (const auto i : base::IntegerRange(range.lower, range.upper)) {
      if (!budget_.spend()) break;
      all.push_back(integer(i));
    }
  }
  for (const auto& symbol : model_.symbols) {
    if (symbol.result == sort && symbol.kind != SymbolKind::kFunction) list_instances(symbol, all);
  }
  for (const auto value : all) {
    if (members_[sort.index()].insert(value).second) domains_[sort.index()].push_back(value);
  }
}

/// `Name(a,b)` for every combination of arguments.
void ReferenceTerms::list_instances(const Symbol& symbol, std::vector<Value>& out) {
  std::vector<std::vector<Value>> prefixes = {{}};
  for (const auto sort : symbol.arguments) {
    list_domain(sort);
    std::vector<std::vector<Value>> longer;
    for (const auto& prefix : prefixes) {
      for (const auto value : domain(sort)) {
        if (!budget_.spend()) return;
        longer.push_back(prefix);
        longer.back().push_back(value);
      }
    }
    prefixes = std::move(longer);
  }
  for (const auto& arguments : prefixes) {
    out.push_back(intern(applied(symbol, arguments), std::nullopt));
  }
}

bool ReferenceTerms::member(SortId sort, Value value) const {
  if (domain(sort).empty() && model_.sorts[sort].integer) return number(value).has_value();
  return members_[sort.index()].contains(value);
}

std::string ReferenceTerms::applied(const Symbol& symbol,
                                    const std::vector<Value>& arguments) const {
  std::string out = symbol.name + "(";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (i > 0) out += ',';
    out += text(arguments[i]);
  }
  return out + ")";
}

std::optional<std::vector<ReferenceTerms::Value>> ReferenceTerms::arguments(
    const Symbol& symbol, const std::vector<TermId>& terms, const Environment& environment) {
  std::vector<Value> values;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const auto value = term(terms[i], environment);
    if (!value || !member(symbol.arguments[i], *value)) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

std::optional<ReferenceTerms::Value> ReferenceTerms::term(TermId id,
                                                          const Environment& environment) {
  const auto& node = model_.terms[id];
  switch (node.kind) {
    case TermKind::kVariable:
      return environment[node.variable.index()];
    case TermKind::kObject:
      return intern(model_.objects[node.object].name, std::nullopt);
    case TermKind::kInteger:
      return integer(node.integer);
    case TermKind::kArithmetic: {
      const auto left = term(node.arguments[0], environment);
      const auto right = term(node.arguments[1], environment);
      if (!left || !right) return std::nullopt;
      return arithmetic(node.op, *left, *right);
    }
    case TermKind::kApply: {
      const auto& symbol = model_.symbols[node.symbol];
      const auto values = arguments(symbol, node.arguments, environment);
      if (!values) return std::nullopt;
      const auto value = intern(applied(symbol, *values), std::nullopt);
      if (symbol.kind != SymbolKind::kFunction) return value;
      const auto found = function_values_.find(value);
      if (found == function_values_.end()) return std::nullopt;
      return found->second;
    }
  }
  return std::nullopt;
}

std::optional<ReferenceTerms::Value> ReferenceTerms::arithmetic(ArithmeticOp op, Value left,
                                                                Value right) {
  const auto a = number(left);
  const auto b = number(right);
  if (!a || !b) return std::nullopt;
  std::int64_t result = 0;
  bool overflow = false;
  switch (op) {
    case ArithmeticOp::kAdd:
      overflow = __builtin_add_overflow(*a, *b, &result);
      break;
    case ArithmeticOp::kSubtract:
      overflow = __builtin_sub_overflow(*a, *b, &result);
      break;
    case ArithmeticOp::kMultiply:
      overflow = __builtin_mul_overflow(*a, *b, &result);
      break;
    case ArithmeticOp::kDivide:
    case ArithmeticOp::kModulo: {
      // Quotients round towards zero. By -1 the smallest integer has none.
      const bool divide = op == ArithmeticOp::kDivide;
      if (*b == 0) return std::nullopt;
      if (*b == -1) {
        overflow = divide && __builtin_sub_overflow(std::int64_t{0}, *a, &result);
      } else {
        result = divide ? *a / *b : *a % *b;
      }
      break;
    }
  }
  if (overflow) return std::nullopt;
  return integer(result);
}

std::size_t ReferenceTerms::depth(const TypedModel& model, std::size_t limit) {
  // An argument is added to the store before the term around it.
  std::vector<std::size_t> depths(model.terms.size(), 1);
  std::size_t deepest = 0;
  for (std::size_t i = 0; i < depths.size() && deepest <= limit; ++i) {
    for (const auto argument : model.terms[model.terms.id_at(i)].arguments) {
      depths[i] = std::max(depths[i], depths[argument.index()] + 1);
    }
    deepest = std::max(deepest, depths[i]);
  }
  return std::min(deepest, limit + 1);
}

FormulaTrees::Node FormulaTrees::atom(std::uint32_t number) {
  nodes_.push_back({FormulaKind::kAtom, number, 0, false});
  return static_cast<Node>(nodes_.size() - 1);
}

FormulaTrees::Node FormulaTrees::effect(std::uint32_t number) {
  nodes_.push_back({FormulaKind::kAtom, number, 0, true});
  return static_cast<Node>(nodes_.size() - 1);
}

FormulaTrees::Node FormulaTrees::add(FormulaKind kind, const std::vector<Node>& parts) {
  nodes_.push_back({kind, static_cast<std::uint32_t>(parts_.size()),
                    static_cast<std::uint32_t>(parts.size()), false});
  parts_.insert(parts_.end(), parts.begin(), parts.end());
  return static_cast<Node>(nodes_.size() - 1);
}

FormulaTrees::Node FormulaTrees::junction(bool conjunction, const std::vector<Node>& parts) {
  std::vector<Node> open;
  for (const auto part : parts) {
    if (part == constant(!conjunction)) return part;
    if (part != constant(conjunction)) open.push_back(part);
  }
  if (open.empty()) return constant(conjunction);
  if (open.size() == 1) return open.front();
  return add(conjunction ? FormulaKind::kAnd : FormulaKind::kOr, open);
}

FormulaTrees::Node FormulaTrees::connect(FormulaKind kind, const std::vector<Node>& parts) {
  const auto negation = [this](Node node) {
    if (node == kTruth || node == kFalsity) return constant(node == kFalsity);
    return add(FormulaKind::kNot, {node});
  };
  switch (kind) {
    case FormulaKind::kNot:
      return negation(parts[0]);
    case FormulaKind::kAnd:
    case FormulaKind::kOr:
      return junction(kind == FormulaKind::kAnd, parts);
    case FormulaKind::kImplies:
      return junction(false, {negation(parts[0]), parts[1]});
    case FormulaKind::kIff:
      for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
        if (parts[i] == kTruth) return parts[1 - i];
        if (parts[i] == kFalsity) return negation(parts[1 - i]);
      }
      return add(kind, parts);
    case FormulaKind::kTrue:
    case FormulaKind::kFalse:
    case FormulaKind::kAtom:
    case FormulaKind::kCompare:
    case FormulaKind::kForall:
    case FormulaKind::kExists:
    case FormulaKind::kAggregate:
    case FormulaKind::kTemporal:
      break;
  }
  PARALLAX_REQUIRE(false, "a connective");
  return kFalsity;
}

FormulaTrees::Node FormulaTrees::compared(Sum sum, const std::vector<Node>& parts) {
  if (std::all_of(parts.begin(), parts.end(), [](Node part) { return part <= kTruth; })) {
    std::int64_t total = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) total += parts[i] == kTruth ? sum.weights[i] : 0;
    return constant(compares(total, sum.compare, sum.number));
  }
  const auto node = add(FormulaKind::kAggregate, parts);
  nodes_[node].sum = static_cast<std::uint32_t>(sums_.size());
  sums_.push_back(std::move(sum));
  return node;
}

void FormulaTrees::rewind(std::size_t size) {
  while (nodes_.size() > size) {
    if (nodes_.back().kind == FormulaKind::kAggregate) sums_.pop_back();
    if (nodes_.back().kind != FormulaKind::kAtom) parts_.resize(nodes_.back().first);
    nodes_.pop_back();
  }
}

std::vector<FormulaTrees::Node> FormulaTrees::conjuncts(Node root) const {
  std::vector<Node> out, visit = {root};
  while (!visit.empty()) {
    const auto node = visit.back();
    visit.pop_back();
    const auto& entry = nodes_[node];
    if (entry.kind != FormulaKind::kAnd) {
      out.push_back(node);
      continue;
    }
    for (std::uint32_t i = entry.count; i-- > 0;) visit.push_back(parts_[entry.first + i]);
  }
  return out;
}

std::vector<std::uint32_t> FormulaTrees::atoms_of(Node root) const {
  std::vector<std::uint32_t> atoms;
  std::vector<Node> visit = {root};
  while (!visit.empty()) {
    const auto& entry = nodes_[visit.back()];
    visit.pop_back();
    if (entry.kind == FormulaKind::kAtom) {
      if (!entry.is_effect) atoms.push_back(entry.first);
      continue;
    }
    for (std::uint32_t i = 0; i < entry.count; ++i) visit.push_back(parts_[entry.first + i]);
  }
  return ascending(std::move(atoms));
}

std::vector<std::uint32_t> FormulaTrees::effects_of(Node root, bool negative) const {
  std::vector<std::uint32_t> effects;
  std::vector<std::pair<Node, bool>> visit = {{root, negative}};
  while (!visit.empty()) {
    const auto [node, turned] = visit.back();
    visit.pop_back();
    const auto& entry = nodes_[node];
    if (entry.kind == FormulaKind::kAtom) {
      if (entry.is_effect && !turned) effects.push_back(entry.first);
      continue;
    }
    for (std::uint32_t i = 0; i < entry.count; ++i) {
      const auto part = parts_[entry.first + i];
      visit.emplace_back(part, entry.kind == FormulaKind::kNot ? !turned : turned);
      if (entry.kind == FormulaKind::kIff) visit.emplace_back(part, !turned);
    }
  }
  return ascending(std::move(effects));
}

bool FormulaTrees::sided_value(Node node, const Sides& sides) const {
  const auto& entry = nodes_[node];
  const auto part = [&](std::uint32_t i) { return sided_value(parts_[entry.first + i], sides); };
  /// Not the part, with what counts for the whole turned round.
  const auto no_part = [&](std::uint32_t i) {
    return !sided_value(parts_[entry.first + i], sides.turned());
  };
  switch (entry.kind) {
    case FormulaKind::kTrue:
      return true;
    case FormulaKind::kFalse:
      return false;
    case FormulaKind::kAtom:
      return (entry.is_effect ? *sides.effects.positive : *sides.positive)[entry.first] != 0;
    case FormulaKind::kNot:
      return no_part(0);
    case FormulaKind::kIff:
      return (part(0) || no_part(1)) && (part(1) || no_part(0));
    case FormulaKind::kAnd:
      for (std::uint32_t i = 0; i < entry.count; ++i) {
        if (!part(i)) return false;
      }
      return true;
    case FormulaKind::kOr:
      for (std::uint32_t i = 0; i < entry.count; ++i) {
        if (part(i)) return true;
      }
      return false;
    case FormulaKind::kAggregate:
      return sided_value(sums_[entry.sum], entry, sides);
    case FormulaKind::kImplies:
    case FormulaKind::kCompare:
    case FormulaKind::kForall:
    case FormulaKind::kExists:
    case FormulaKind::kTemporal:
      break;
  }
  PARALLAX_REQUIRE(false, "a tree has atoms and connectives");
  return false;
}

/// Parts count for a bound from below, and against one from above; with weights below 0 the other
/// way round.
bool FormulaTrees::sided_value(const Sum& sum, const Entry& entry, const Sides& sides) const {
  std::int64_t low = 0, high = 0;  // the totals that count for the bounds from below and above
  for (std::uint32_t i = 0; i < entry.count; ++i) {
    const auto weight = sum.weights[i];
    const bool plain = sided_value(parts_[entry.first + i], sides);
    const bool turned = sided_value(parts_[entry.first + i], sides.turned());
    low += (weight > 0 ? plain : turned) ? weight : 0;
    high += (weight > 0 ? turned : plain) ? weight : 0;
  }
  switch (sum.compare) {
    case CompareOp::kEqual:
      return low >= sum.number && high <= sum.number;
    case CompareOp::kNotEqual:
      return low > sum.number || high < sum.number;
    case CompareOp::kGreater:
    case CompareOp::kGreaterEqual:
      return compares(low, sum.compare, sum.number);
    case CompareOp::kLess:
    case CompareOp::kLessEqual:
      return compares(high, sum.compare, sum.number);
  }
  return false;
}

ExpandedModel::ExpandedModel(const TypedModel& model, ReferenceBudget& budget) {
  ModelExpander(model, budget, *this).run();
}

/// From every effect that needs another to be absent: is there a way back?
bool ExpandedModel::has_circular_effect() const {
  std::vector<std::vector<std::uint32_t>> needed(effects_.size()), absent(effects_.size());
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    const auto& effect = effects_[i];
    for (const auto& row : rows(effect.fluent, effect.time)) {
      if (row.kind != effect.kind || row.event != effect.event) continue;
      for (const bool negative : {false, true}) {
        const auto found = trees_.effects_of(row.condition.node, negative);
        needed[i].insert(needed[i].end(), found.begin(), found.end());
        if (negative) absent[i].insert(absent[i].end(), found.begin(), found.end());
      }
    }
  }
  for (std::size_t start = 0; start < effects_.size(); ++start) {
    std::vector<bool> reached(effects_.size(), false);
    auto todo = absent[start];
    while (!todo.empty()) {
      const auto next = todo.back();
      todo.pop_back();
      if (next == start) return true;
      if (reached[next]) continue;
      reached[next] = true;
      todo.insert(todo.end(), needed[next].begin(), needed[next].end());
    }
  }
  return false;
}

std::optional<std::uint32_t> ExpandedModel::fluent(const std::string& text) const {
  return look_up(fluent_numbers_, text);
}

std::optional<std::uint32_t> ExpandedModel::event(const std::string& text) const {
  return look_up(event_numbers_, text);
}

std::optional<std::uint32_t> ExpandedModel::predicate(const std::string& text) const {
  return look_up(predicate_numbers_, text);
}

std::uint32_t ExpandedModel::released(std::uint32_t fluent, std::int64_t t) const {
  return place(t, fluents_.size() + fluent);
}

std::uint32_t ExpandedModel::happens(std::uint32_t event, std::int64_t t) const {
  return place(t, 2 * fluents_.size() + event);
}

std::optional<std::int64_t> ExpandedModel::timepoint(std::uint32_t atom) const {
  if (atom >= timed_atoms()) return std::nullopt;
  return static_cast<std::int64_t>(atom / (2 * fluents_.size() + events_.size()));
}

std::int64_t ExpandedModel::needed(std::uint32_t atom) const {
  const auto t = timepoint(atom);
  if (!t) return 0;
  return atom >= place(*t, 2 * fluents_.size()) ? *t + 1 : *t;
}

std::string ExpandedModel::atom_text(std::uint32_t atom) const {
  const auto t = timepoint(atom);
  if (!t) return predicates_[atom - timed_atoms()];
  const auto offset = atom - place(*t, 0);
  const auto count = fluents_.size();
  const auto end = "," + std::to_string(*t) + ")";
  if (offset < count) return "HoldsAt(" + fluents_[offset] + end;
  if (offset < 2 * count) return "ReleasedAt(" + fluents_[offset - count] + end;
  return "Happens(" + events_[offset - 2 * count] + end;
}

}  // namespace parallax::compiler
