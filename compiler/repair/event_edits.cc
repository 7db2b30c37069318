#include <algorithm>
#include <iterator>
#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_subject.h"

namespace parallax::compiler {
namespace {

constexpr int kOpenWithoutNeed = 20;     // oddity, beyond that of any condition
constexpr std::size_t kMostPaired = 24;  // literals of which every two are an alternative

/// Edits that add something missing about an event: a condition of everything it does, a
/// precondition, effects.
class EventEdits {
 public:
  EventEdits(const EditSubject& subject, std::vector<Edit>& out) : subject_(subject), out_(out) {}

  void edit_event(const std::string& event, const std::vector<SortId>& sorts) {
    const auto names = variables_for(subject_.typed, sorts);
    std::vector<SortedVariable> variables;
    for (std::size_t i = 0; i < names.size(); ++i) variables.push_back({names[i], sorts[i]});
    const auto axioms = effects_of(event);
    std::vector<std::size_t> differing;
    std::copy_if(axioms.begin(), axioms.end(), std::back_inserter(differing),
                 [&](const auto i) { return is_about_fluents(i); });
    bool refused = false, not_possible = false;
    for (const auto& step : subject_.scope.steps) {
      if (base::symbol_of(step.event) != event) continue;
      refused = refused || step.refused;
      not_possible = not_possible || step.not_possible;
    }
    // An event that was tried and refused may fail; failing is no outcome of an impossible event.
    if (subject_.scope.open_outcomes || (subject_.scope.open_refused && refused && !not_possible))
      open_event(event, names, axioms);
    for (const auto& literal : condition_literals(subject_.typed, variables, kMostLiterals)) {
      if (!subject_.relevance.in_some_step(literal, false, names, event, names)) continue;
      Edit edit;
      edit.literal = literal;
      edit.event = event;
      edit.variables = names;
      edit.event_arity = names.size();
      const int oddity = subject_.relevance.oddity(literal, event);
      if (axioms.size() > 1) {
        edit.kind = Edit::Kind::kNarrowEvent;
        edit.axioms = axioms;
        edit.oddity = (refused ? 1 : 3) + oddity;
        out_.push_back(edit);
      }
      // The condition may be one of these effects and not of others, which came as the model says.
      // If the event failed in every run, any condition would explain the failures.
      const bool is_part = differing.size() > 1 && differing.size() < axioms.size();
      if (is_part && subject_.relevance.in_some_success(literal, names, event, names)) {
        edit.kind = Edit::Kind::kNarrowEvent;
        edit.axioms = differing;
        edit.oddity = (refused ? 2 : 4) + oddity;
        out_.push_back(edit);
      }
      if (refused) {
        edit.kind = Edit::Kind::kRequire;
        edit.axioms = {};
        edit.oddity = (not_possible ? 0 : 3) + oddity;
        out_.push_back(edit);
      }
    }
  }

  void add_alternatives(const std::string& event, const std::vector<SortId>& sorts) {
    const auto names = variables_for(subject_.typed, sorts);
    std::vector<SortedVariable> variables;
    for (std::size_t i = 0; i < names.size(); ++i) variables.push_back({names[i], sorts[i]});
    std::vector<std::pair<int, ConditionLiteral>> literals;
    for (auto& literal : condition_literals(subject_.typed, variables, kMostLiterals)) {
      // Where it went wrong neither of the two held.
      if (!subject_.relevance.in_some_step(literal, false, names, event, names)) continue;
      if (!always_says_something(literal, variables)) continue;
      const bool of_constants = literal.count(LiteralArgument::Kind::kConstant) > 0;
      const int oddity = of_constants ? std::max(2, subject_.relevance.oddity(literal, event) + 1)
                                      : subject_.relevance.oddity(literal, event);
      literals.emplace_back(oddity, std::move(literal));
    }
    std::stable_sort(literals.begin(), literals.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    if (literals.size() > kMostPaired) literals.resize(kMostPaired);
    const auto axioms = effects_of(event);
    std::vector<std::vector<std::size_t>> groups;
    if (!axioms.empty()) groups.push_back(axioms);
    for (const auto i : axioms) {
      if (axioms.size() > 1 && is_about_fluents(i)) groups.push_back({i});
    }
    for (std::size_t a = 0; a < literals.size(); ++a) {
      for (std::size_t b = a + 1; b < literals.size(); ++b) {
        for (const auto& group : groups) {
          Edit edit;
          edit.kind = Edit::Kind::kNarrowEvent;
          edit.axioms = group;
          edit.literal = literals[a].second;
          edit.or_else = literals[b].second;
          edit.event = event;
          edit.variables = names;
          edit.event_arity = names.size();
          edit.oddity = 3 + literals[a].first + literals[b].first + (group == axioms ? 0 : 1);
          out_.push_back(std::move(edit));
        }
      }
    }
  }

  void add_effects(const std::string& event, const std::vector<SortId>& sorts) {
    for (const auto& name : subject_.fluents) {
      const auto symbol = subject_.typed.find_symbol(name);
      if (!symbol || subject_.typed.symbols[*symbol].kind != SymbolKind::kFluent) continue;
      if (subject_.typed.symbols[*symbol].noninertial) continue;
      auto all = sorts;
      const auto& places = subject_.typed.symbols[*symbol].arguments;
      all.insert(all.end(), places.begin(), places.end());
      const auto names = variables_for(subject_.typed, all);
      std::vector<std::string> kinds = {"Initiates", "Terminates"};
      if (subject_.scope.open_outcomes) kinds.emplace_back("Releases");
      for (const auto& kind : kinds) {
        add_effects_of(kind, event, sorts.size(), name, all, names);
      }
    }
  }

 private:
  const Ast& ast(const AxiomForm& form) const { return subject_.model.ast(form.place); }

  /// Has it a value for whatever the variables stand for? A sentence says nothing where they are
  /// outside of a place's sort, not even the other half of the condition.
  bool always_says_something(const ConditionLiteral& literal,
                             const std::vector<SortedVariable>& variables) const {
    if (literal.kind == ConditionLiteral::Kind::kEqual) return true;
    const auto& places =
        subject_.typed.symbols[*subject_.typed.find_symbol(literal.symbol)].arguments;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto& argument = literal.arguments[i];
      if (argument.kind != LiteralArgument::Kind::kVariable) continue;
      const auto variable = std::find_if(variables.begin(), variables.end(), [&](const auto& each) {
        return each.name == argument.name;
      });
      if (!subject_.typed.is_subsort(variable->sort, places[i])) return false;
    }
    return true;
  }

  std::vector<std::size_t> effects_of(const std::string& event) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < subject_.forms.size(); ++i) {
      if (subject_.forms[i].event_symbol == event &&
          subject_.forms[i].kind == AxiomForm::Kind::kEffects) {
        out.push_back(i);
      }
    }
    return out;
  }

  /// Is the axiom about a fluent that differed?
  bool is_about_fluents(std::size_t axiom) const {
    const auto& tree = ast(subject_.forms[axiom]);
    return std::any_of(subject_.forms[axiom].effects.begin(), subject_.forms[axiom].effects.end(),
                       [&](const auto effect) {
                         const auto& fluent = tree[effect_parts(tree, effect)->fluent];
                         return fluent.kind != NodeKind::kApply ||
                                subject_.fluents.contains(std::string(tree.name(fluent)));
                       });
  }

  /// Leaves open what the event does to the fluents that differed.
  void open_event(const std::string& event, const std::vector<std::string>& names,
                  const std::vector<std::size_t>& axioms) {
    Edit edit;
    edit.kind = Edit::Kind::kOpenEvent;
    edit.event = event;
    edit.variables = names;
    edit.event_arity = names.size();
    // An open outcome explains anything: without need for it, it comes last.
    edit.oddity = subject_.scope.open_outcomes ? 1 : kOpenWithoutNeed;
    for (const auto i : axioms) {
      for (const auto effect : subject_.forms[i].effects) {
        const auto& tree = ast(subject_.forms[i]);
        const auto& fluent = tree[effect_parts(tree, effect)->fluent];
        if (fluent.kind != NodeKind::kApply || tree.name(tree[effect]) == "Releases") continue;
        if (!subject_.fluents.contains(std::string(tree.name(fluent)))) continue;
        edit.nodes.emplace_back(i, effect);
        if (edit.axioms.empty() || edit.axioms.back() != i) edit.axioms.push_back(i);
      }
    }
    if (!edit.nodes.empty()) out_.push_back(std::move(edit));
  }

  /// Each place of the fluent is a variable of the event, one of its own, or a constant.
  void add_effects_of(const std::string& kind, const std::string& event, std::size_t arity,
                      const std::string& fluent, const std::vector<SortId>& sorts,
                      const std::vector<std::string>& names) {
    std::vector<SortedVariable> own;
    for (std::size_t i = 0; i < arity; ++i) own.push_back({names[i], sorts[i]});
    auto choices = arguments_for(own, arity, sorts, names, true);
    if (choices.empty()) choices = arguments_for(own, arity, sorts, names, false);
    for (const auto& choice : choices) add_effect(kind, event, arity, fluent, sorts, names, choice);
  }

  /// Empty: there are too many.
  std::vector<std::vector<std::string>> arguments_for(const std::vector<SortedVariable>& own,
                                                      std::size_t arity,
                                                      const std::vector<SortId>& sorts,
                                                      const std::vector<std::string>& names,
                                                      bool constants) const {
    std::vector<std::vector<std::string>> choices = {{}};
    for (std::size_t i = arity; i < sorts.size(); ++i) {
      std::vector<std::vector<std::string>> next;
      for (const auto& begun : choices) {
        const auto add = [&](const std::string& text) {
          next.push_back(begun);
          next.back().push_back(text);
        };
        for (const auto& variable : own) {
          if (subject_.typed.sorts_overlap(variable.sort, sorts[i])) add(variable.name);
        }
        add(names[i]);
        if (!constants) continue;
        for (const auto& name : constants_of(subject_.typed, sorts[i])) add(name);
      }
      choices = std::move(next);
      if (choices.size() > 4 * kMostLiterals) return {};
    }
    return choices;
  }

  void add_effect(const std::string& kind, const std::string& event, std::size_t arity,
                  const std::string& fluent, const std::vector<SortId>& sorts,
                  const std::vector<std::string>& names, const std::vector<std::string>& choice) {
    const std::vector<std::string> of_event(names.begin(),
                                            names.begin() + static_cast<std::ptrdiff_t>(arity));
    Edit edit;
    edit.kind = Edit::Kind::kAddEffect;
    edit.event = event;
    edit.variables = of_event;
    edit.event_arity = arity;
    edit.oddity = kind == "Releases" ? 4 : 2;
    // Beside events that the model demands, or could, one that does nothing in it is an odd cause.
    const auto& demanded = subject_.scope.demanded;
    if (!(demanded.empty() && subject_.scope.idle.empty()) && !demanded.contains(event) &&
        effects_of(event).empty()) {
      edit.oddity += 2;
    }
    std::vector<SortedVariable> variables;
    for (std::size_t i = 0; i < arity; ++i) variables.push_back({names[i], sorts[i]});
    bool constants = false;
    int own = 0;
    for (std::size_t i = 0; i < choice.size(); ++i) {
      if (choice[i] == names[arity + i]) {  // one of its own
        edit.variables.push_back(choice[i]);
        variables.push_back({choice[i], sorts[arity + i]});
        edit.oddity += 1;
        ++own;
      } else if (std::find(of_event.begin(), of_event.end(), choice[i]) == of_event.end()) {
        edit.oddity += 3;
        constants = true;
      }
    }
    edit.names_constants = constants;
    if (!subject_.relevance.covers(kind, event, fluent, of_event, choice, edit.variables)) return;
    const auto list = [](const std::vector<std::string>& of) {
      std::string text;
      for (const auto& each : of) text += (text.empty() ? "" : ",") + each;
      return text;
    };
    edit.text =
        kind + "(" + event + "(" + list(of_event) + ")," + fluent + "(" + list(choice) + "),time)";
    const auto place = out_.size();
    out_.push_back(edit);
    // Conditions of effects that are special already, or in a wide scope, would be most of all
    // edits.
    if (constants || own > 1 || !subject_.scope.more_fluents.empty()) return;
    subject_.relevance.add_conditions(subject_.typed, place, variables, arity,
                                      1 + kMostLiterals / 8, {}, out_);
  }

  const EditSubject& subject_;
  std::vector<Edit>& out_;
};

template <typename Visit>
void for_each_event(const EditSubject& subject, const Visit& visit) {
  for (const auto& event : subject.events) {
    const auto symbol = subject.typed.find_symbol(event);
    if (!symbol || subject.typed.symbols[*symbol].kind != SymbolKind::kEvent) continue;
    visit(event, subject.typed.symbols[*symbol].arguments);
  }
}

}  // namespace

void add_event_edits(const EditSubject& subject, std::vector<Edit>& edits) {
  EventEdits maker(subject, edits);
  for_each_event(subject, [&](const auto& event, const auto& sorts) {
    maker.edit_event(event, sorts);
    maker.add_effects(event, sorts);
  });
}

void add_alternatives(const EditSubject& subject, std::vector<Edit>& edits) {
  EventEdits maker(subject, edits);
  for_each_event(
      subject, [&](const auto& event, const auto& sorts) { maker.add_alternatives(event, sorts); });
}

}  // namespace parallax::compiler
