#include "compiler/repair/edit_relevance.h"

#include <algorithm>

#include "compiler/base/ground_name.h"
#include "compiler/repair/number_term.h"

namespace parallax::compiler {
namespace {

using Values = std::map<std::string, std::string>;

/// Signature of a condition, without its arguments: "Holding", "!Holding".
std::string signature(const Ast& ast, NodeId node) {
  std::string sign;
  while (true) {
    const auto& here = ast[node];
    if (here.kind == NodeKind::kUnary && here.op == Operator::kNot) {
      sign = sign.empty() ? "!" : "";
      node = ast.child(here, 0);
    } else if (here.kind == NodeKind::kExists) {
      node = ast.child(here, here.child_count - 1);
    } else if (here.kind == NodeKind::kApply && ast.name(here) == "HoldsAt" &&
               here.child_count == 2) {
      node = ast.child(here, 0);
    } else {
      break;
    }
  }
  return sign + std::string(ast.name(ast[node]));
}

/// Could the literal be `value` in this state? What was not seen could be anything.
bool could_be(const ConditionLiteral& literal, bool value, const Values& values,
              const std::map<std::string, bool>& state) {
  if (literal.kind == ConditionLiteral::Kind::kPredicate) return true;
  if (literal.kind == ConditionLiteral::Kind::kEqual) {
    return compares(literal, values).value_or(value) == value;
  }
  const auto pattern = atom_pattern(literal, values);
  bool some_true = false, some_false = false, seen = false;
  for (const auto& [atom, holds] : state) {
    if (!matches(atom, pattern)) continue;
    seen = true;
    (holds ? some_true : some_false) = true;
  }
  if (!seen) return true;
  const bool wants_true = value != literal.negated;
  // "There is one" is false only where none is; a variable that is open may be any of them.
  const bool exists = literal.count(LiteralArgument::Kind::kSome) > 0;
  if (wants_true) return some_true;
  return exists ? !some_true : some_false;
}

/// The values of the event's arguments in the step; none where it is another event.
std::optional<Values> bind(const std::vector<std::string>& arguments, const std::string& symbol,
                           const std::string& event, const std::vector<std::string>& variables) {
  if (base::symbol_of(event) != symbol) return std::nullopt;
  const auto ground = arguments_of(event);
  if (ground.size() != arguments.size()) return std::nullopt;
  Values values;
  for (std::size_t i = 0; i < ground.size(); ++i) {
    const bool is_variable =
        std::find(variables.begin(), variables.end(), arguments[i]) != variables.end();
    if (!is_variable && arguments[i] != ground[i]) return std::nullopt;
    const auto [at, added] = values.emplace(arguments[i], ground[i]);
    if (!added && at->second != ground[i]) return std::nullopt;
  }
  return values;
}

}  // namespace

bool EditRelevance::in_some_step(const ConditionLiteral& literal, bool value,
                                 const std::vector<std::string>& arguments,
                                 const std::string& symbol,
                                 const std::vector<std::string>& variables) const {
  if (scope_.more_events.contains(symbol)) return true;
  return std::any_of(scope_.steps.begin(), scope_.steps.end(), [&](const auto& step) {
    const auto values = bind(arguments, symbol, step.event, variables);
    return values && could_be(literal, value, *values, step.before);
  });
}

bool EditRelevance::around_some_step(const ConditionLiteral& literal, bool value,
                                     bool after) const {
  return std::any_of(scope_.steps.begin(), scope_.steps.end(), [&](const auto& step) {
    return could_be(literal, value, {}, after ? step.after : step.before);
  });
}

bool EditRelevance::in_some_success(const ConditionLiteral& literal,
                                    const std::vector<std::string>& arguments,
                                    const std::string& symbol,
                                    const std::vector<std::string>& variables) const {
  return std::any_of(scope_.successes.begin(), scope_.successes.end(), [&](const auto& success) {
    const auto values = bind(arguments, symbol, success.event, variables);
    return values && could_be(literal, true, *values, success.before);
  });
}

bool EditRelevance::covers(const std::string& kind, const std::string& event,
                           const std::string& fluent, const std::vector<std::string>& of_event,
                           const std::vector<std::string>& choice,
                           const std::vector<std::string>& variables) const {
  if (scope_.more_events.contains(event) || scope_.more_fluents.contains(fluent)) return true;
  ConditionLiteral literal;
  literal.symbol = fluent;
  for (const auto& text : choice) {
    const bool is_variable = std::find(variables.begin(), variables.end(), text) != variables.end();
    literal.arguments.push_back(
        {is_variable ? LiteralArgument::Kind::kVariable : LiteralArgument::Kind::kConstant, text});
  }
  return std::any_of(scope_.steps.begin(), scope_.steps.end(), [&](const auto& step) {
    const auto values = bind(of_event, event, step.event, of_event);
    if (!values) return false;
    const auto pattern = atom_pattern(literal, *values);
    return std::any_of(step.differing.begin(), step.differing.end(), [&](const auto& seen) {
      const bool fits = kind == "Releases" || seen.second == (kind == "Initiates");
      return fits && matches(seen.first, pattern);
    });
  });
}

int EditRelevance::oddity(const ConditionLiteral& literal, const std::string& event) const {
  int out = static_cast<int>(2 * literal.count(LiteralArgument::Kind::kConstant) +
                             literal.count(LiteralArgument::Kind::kTerm) +
                             literal.count(LiteralArgument::Kind::kSome));
  // Two variables of one sort are as a rule to be told apart.
  const bool tells_apart = literal.kind == ConditionLiteral::Kind::kEqual && literal.negated;
  if (tells_apart && literal.count(LiteralArgument::Kind::kVariable) == 2) --out;
  // A condition usually mentions an argument of the event.
  if (!literal.arguments.empty() && literal.count(LiteralArgument::Kind::kVariable) == 0) ++out;
  const auto wanted = (literal.negated ? "!" : "") + literal.symbol;
  for (const auto& form : forms_) {
    if (form.event_symbol != event) continue;
    for (const auto conjunct : form.conjuncts) {
      if (signature(model_.ast(form.place), conjunct) == wanted) return out - 3;
    }
  }
  return out;
}

void EditRelevance::add_conditions(const TypedModel& typed, std::size_t of,
                                   const std::vector<SortedVariable>& variables, std::size_t arity,
                                   std::size_t most, const std::vector<ConditionLiteral>& given,
                                   std::vector<Edit>& edits) const {
  std::vector<std::string> names;
  for (const auto& variable : variables) names.push_back(variable.name);
  const std::vector<std::string> of_event(names.begin(),
                                          names.begin() + static_cast<std::ptrdiff_t>(arity));
  const auto event = edits[of].event;
  for (const auto& literal : condition_literals(typed, variables, most)) {
    if (literal.count(LiteralArgument::Kind::kConstant) > 0) continue;
    if (std::find(given.begin(), given.end(), literal) != given.end()) continue;
    if (!in_some_step(literal, true, of_event, event, of_event)) continue;
    Edit condition;
    condition.kind = Edit::Kind::kAddCondition;
    condition.of = of;
    condition.literal = literal;
    condition.event = event;
    condition.variables = names;
    condition.oddity = oddity(literal, event);
    edits.push_back(std::move(condition));
  }
}

}  // namespace parallax::compiler
