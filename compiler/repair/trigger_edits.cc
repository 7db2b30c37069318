// Triggers that a model lacks: an event of which the model says what it does, and that nothing
// brings about, may happen by itself.
//
// Proposed are `[arguments,time] L -> Happens(E(arguments),time)` for the literals L that name
// every argument of E and could have held in front of a step at which a fluent of E's effects
// differed, and the trigger by all that the preconditions of E ask for. A second condition of such
// a trigger is an edit of its own. Or a trigger names the wrong event. Cost: literals of the
// arguments, squared for short lists.

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "compiler/repair/edit_subject.h"
#include "compiler/repair/number_term.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostSecond = 20;  // literals of a symbol as a second condition

class TriggerEdits {
 public:
  TriggerEdits(const EditSubject& subject, std::vector<Edit>& out) : subject_(subject), out_(out) {}

  void add(const std::string& event, const std::vector<SortId>& sorts) {
    if (!has_effect_that_differs(event)) return;
    const auto names = variables_for(subject_.typed, sorts);
    std::vector<SortedVariable> variables;
    for (std::size_t i = 0; i < names.size(); ++i) variables.push_back({names[i], sorts[i]});
    const auto asked = all_preconditions(event, names);
    if (asked.size() > 1 && names_all(asked, names)) push(event, names, asked, -2);
    for (const auto& literal : condition_literals(subject_.typed, variables, kMostLiterals)) {
      if (literal.kind != ConditionLiteral::Kind::kFluent || !names_all({literal}, names) ||
          literal.count(LiteralArgument::Kind::kConstant) > 0) {
        continue;
      }
      if (!subject_.relevance.around_some_step(literal, true, false)) continue;
      const bool is_asked = std::find(asked.begin(), asked.end(), literal) != asked.end();
      const auto place = out_.size();
      push(event, names, {literal},
           is_asked ? -1
                    : std::max(0, subject_.relevance.oddity(literal, event)) +
                          (literal.negated ? 4 : 3));
      for (const auto& second : condition_literals(subject_.typed, variables, kMostSecond)) {
        add_second(place, literal, second, names);
      }
    }
  }

 private:
  void push(const std::string& event, const std::vector<std::string>& names,
            std::vector<ConditionLiteral> given, int oddity) {
    Edit edit;
    edit.kind = Edit::Kind::kAddTrigger;
    edit.event = event;
    edit.variables = names;
    edit.event_arity = names.size();
    edit.given = std::move(given);
    for (const auto& name : names) edit.text += (edit.text.empty() ? "" : ",") + name;
    edit.text = "Happens(" + event + "(" + edit.text + "),time)";
    edit.oddity = oddity;
    out_.push_back(std::move(edit));
  }

  /// The preconditions of the event that are single fluents, in its arguments.
  std::vector<ConditionLiteral> all_preconditions(const std::string& event,
                                                  const std::vector<std::string>& names) const {
    std::vector<ConditionLiteral> out;
    for (const auto& form : subject_.forms) {
      const bool plain = form.event_symbol == event && form.conjuncts.size() == 1 &&
                         form.kind == AxiomForm::Kind::kPrecondition;
      auto literal = plain ? precondition(form, names) : std::nullopt;
      if (literal) out.push_back(*std::move(literal));
    }
    return out;
  }

  std::optional<ConditionLiteral> precondition(const AxiomForm& form,
                                               const std::vector<std::string>& names) const {
    const auto& tree = subject_.model.ast(form.place);
    ConditionLiteral out;
    auto at = form.head;
    if (tree[at].kind == NodeKind::kUnary && tree[at].op == Operator::kNot) {
      out.negated = true;
      at = tree.child(tree[at], 0);
    }
    if (tree[at].kind != NodeKind::kApply || tree.name(tree[at]) != "HoldsAt") return std::nullopt;
    const auto& fluent = tree[tree.child(tree[at], 0)];
    const auto& event = tree[form.event];
    if (fluent.kind != NodeKind::kApply || event.child_count != names.size()) return std::nullopt;
    out.symbol = tree.name(fluent);
    for (std::uint32_t i = 0; i < fluent.child_count; ++i) {
      const auto text = print_formula(tree, tree.child(fluent, i));
      LiteralArgument argument{LiteralArgument::Kind::kConstant, text};
      const auto& variables = form.variables;
      if (std::find(variables.begin(), variables.end(), text) != variables.end()) {
        argument.kind = LiteralArgument::Kind::kVariable;
        argument.name.clear();
        for (std::uint32_t j = 0; j < event.child_count; ++j) {
          if (print_formula(tree, tree.child(event, j)) == text) argument.name = names[j];
        }
        if (argument.name.empty()) return std::nullopt;
      }
      out.arguments.push_back(std::move(argument));
    }
    return out;
  }

  void add_second(std::size_t of, const ConditionLiteral& first, const ConditionLiteral& second,
                  const std::vector<std::string>& names) {
    if (second.kind != ConditionLiteral::Kind::kFluent || second.symbol == first.symbol ||
        !subject_.relevance.around_some_step(second, true, false)) {
      return;
    }
    Edit condition;
    condition.kind = Edit::Kind::kAddCondition;
    condition.of = of;
    condition.literal = second;
    condition.event = out_[of].event;
    condition.variables = names;
    condition.oddity = std::max(0, subject_.relevance.oddity(second, condition.event));
    out_.push_back(std::move(condition));
  }

  bool has_effect_that_differs(const std::string& event) const {
    return std::any_of(subject_.forms.begin(), subject_.forms.end(), [&](const AxiomForm& form) {
      if (form.event_symbol != event || form.kind != AxiomForm::Kind::kEffects) return false;
      const auto& tree = subject_.model.ast(form.place);
      return std::any_of(form.effects.begin(), form.effects.end(), [&](NodeId effect) {
        const auto& fluent = tree[effect_parts(tree, effect)->fluent];
        return fluent.kind != NodeKind::kApply ||
               subject_.fluents.contains(std::string(tree.name(fluent)));
      });
    });
  }

  /// A trigger that leaves an argument open would demand the event of all objects at once.
  static bool names_all(const std::vector<ConditionLiteral>& literals,
                        const std::vector<std::string>& names) {
    return std::all_of(names.begin(), names.end(), [&](const auto& name) {
      const LiteralArgument wanted{LiteralArgument::Kind::kVariable, name};
      return std::any_of(literals.begin(), literals.end(), [&](const auto& literal) {
        const auto& all = literal.arguments;
        return std::find(all.begin(), all.end(), wanted) != all.end();
      });
    });
  }

  const EditSubject& subject_;
  std::vector<Edit>& out_;
};

/// Each way to choose variables of the form for arguments of these sorts: "a,b".
std::vector<std::string> arguments_from(const TypedModel& typed, const std::vector<SortId>& sorts,
                                        const AxiomForm& form) {
  std::vector<std::string> out = {""};
  for (const auto sort : sorts) {
    std::vector<std::string> longer;
    for (const auto& begun : out) {
      for (const auto& variable : form.variables) {
        const auto own = sort_of_variable(typed, variable);
        if (variable == form.time || !own || !typed.sorts_overlap(*own, sort)) continue;
        longer.push_back(begun + (begun.empty() ? "" : ",") + variable);
      }
    }
    out = std::move(longer);
    if (out.size() > kMostLiterals) return {};
  }
  return out;
}

}  // namespace

void add_triggers(const EditSubject& subject, std::vector<Edit>& edits) {
  TriggerEdits maker(subject, edits);
  for (const auto& event : subject.scope.idle) {
    const auto symbol = subject.typed.find_symbol(event);
    if (!symbol || subject.typed.symbols[*symbol].kind != SymbolKind::kEvent) continue;
    maker.add(event, subject.typed.symbols[*symbol].arguments);
  }
}

void add_other_demands(const EditSubject& subject, std::size_t trigger, std::vector<Edit>& edits) {
  const auto& form = subject.forms[trigger];
  for (const auto& symbol : subject.typed.symbols) {
    const bool idle = subject.scope.idle.contains(symbol.name);
    if (symbol.kind != SymbolKind::kEvent || symbol.name == form.event_symbol ||
        !(idle || subject.scope.demanded.contains(symbol.name))) {
      continue;
    }
    for (const auto& arguments : arguments_from(subject.typed, symbol.arguments, form)) {
      Edit edit;
      edit.kind = Edit::Kind::kReplace;
      edit.axioms = {trigger};
      edit.node = form.head;
      edit.text = "Happens(" + symbol.name + "(" + arguments + ")," + form.time + ")";
      edit.event = symbol.name;
      edit.variables = variables_for(subject.typed, symbol.arguments);
      edit.moves_trigger = idle;
      edit.oddity = idle ? 0 : 3;
      edits.push_back(std::move(edit));
    }
  }
}

bool is_undone(const EditSubject& subject, const AxiomForm& trigger,
               const ConditionLiteral& condition) {
  const auto wanted = print(condition, trigger.time, trigger.variables);
  const auto& tree = subject.model.ast(trigger.place);
  return std::any_of(subject.forms.begin(), subject.forms.end(), [&](const AxiomForm& form) {
    if (form.kind != AxiomForm::Kind::kEffects || form.event_symbol != trigger.event_symbol) {
      return false;
    }
    const auto& own = subject.model.ast(form.place);
    std::map<std::string, std::string> names;
    const auto count = std::min(own[form.event].child_count, tree[trigger.event].child_count);
    for (std::uint32_t k = 0; k < count; ++k) {
      names[print_formula(own, own.child(own[form.event], k))] =
          print_formula(tree, tree.child(tree[trigger.event], k));
    }
    return std::any_of(form.effects.begin(), form.effects.end(), [&](NodeId effect) {
      const std::string_view kind = own.name(own[effect]);
      if (kind == "Releases") return false;
      const auto fluent = with_names(print_formula(own, effect_parts(own, effect)->fluent), names);
      return wanted ==
             (kind == "Initiates" ? "!HoldsAt(" : "HoldsAt(") + fluent + "," + trigger.time + ")";
    });
  });
}

}  // namespace parallax::compiler
