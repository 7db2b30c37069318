#include <algorithm>
#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/repair/edit_subject.h"
#include "compiler/repair/idle_condition.h"
#include "compiler/repair/number_term.h"
#include "compiler/repair/other_term.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostConfused = 24;  // literals of a symbol in the place of a condition
constexpr int kDropSuperfluous = 1;  // oddity: comes before another sign, which comes behind it

/// Edits of an existing axiom that may be wrong.
class AxiomEdits {
 public:
  AxiomEdits(const EditSubject& subject, std::vector<Edit>& out) : subject_(subject), out_(out) {}

  void edit(std::size_t i) {
    if (subject_.forms[i].kind == AxiomForm::Kind::kEffects) {
      edit_effects(i);
    } else if (subject_.forms[i].kind == AxiomForm::Kind::kLateEffects) {
      drop(i, 3);
    } else {
      drop(i, 3);
      edit_conditions(i);
      if (subject_.forms[i].kind != AxiomForm::Kind::kTrigger) return;
      narrow(i);
      add_other_demands(subject_, i, out_);
    }
  }

  /// A consequence of an effect of whatever event: relevant if one of its fluents differed.
  void edit_ramification(std::size_t i) {
    const auto& form = subject_.forms[i];
    bool relevant = false;
    for (const auto effect : form.effects) {
      const bool own = differs(form, effect);
      relevant = relevant || own;
      replace_effect(i, effect, own);
    }
    if (!relevant) return;
    drop(i, kDropSuperfluous);
    edit_conditions(i);
    if (!subject_.scope.wide) narrow(i);
  }

  /// The effects of another event that fit what differed become those of an event in the scope.
  void move_effects(std::size_t i) {
    const auto& form = subject_.forms[i];
    if (form.kind != AxiomForm::Kind::kEffects || form.effects.size() != 1) return;
    const auto& tree = ast(form);
    const auto effect = form.effects.front();
    const auto parts = *effect_parts(tree, effect);
    const auto& fluent = tree[parts.fluent];
    if (fluent.kind != NodeKind::kApply) return;
    const std::string name(tree.name(fluent)), kind(tree.name(tree[effect]));
    if (!subject_.fluents.contains(name)) return;
    const auto variables = variables_of(form, subject_.typed);
    for (const auto& event : subject_.events) {
      const auto symbol = subject_.typed.find_symbol(event);
      if (event == form.event_symbol || !symbol ||
          subject_.typed.symbols[*symbol].kind != SymbolKind::kEvent) {
        continue;
      }
      // Far from the steps these would be most of all edits, and chance: there the runs have to
      // show that the other event does it, and have the one that is said to.
      const bool wide = subject_.scope.wide;
      const auto changed = subject_.scope.changed.find(event);
      const bool shown = changed != subject_.scope.changed.end() &&
                         changed->second.contains({name, kind == "Initiates"});
      if (wide && (!shown || subject_.scope.idle.contains(form.event_symbol) || refused())) {
        continue;
      }
      const auto& sorts = subject_.typed.symbols[*symbol].arguments;
      for (const auto& [term, oddity] :
           wide ? terms(event, sorts, variables, false) : terms(event, sorts, variables)) {
        const auto count = out_.size();
        replace(i, effect,
                kind + "(" + term + "," + print_formula(tree, parts.fluent) + "," + form.time + ")",
                (oddity == 0 && is_lonely(i) ? 0 : 2) + (wide ? 1 : 0) + oddity);
        if (out_.size() == count) continue;
        out_.back().event = event;
        out_.back().moves_effect = true;
      }
    }
  }

 private:
  const Ast& ast(const AxiomForm& form) const { return subject_.model.ast(form.place); }

  /// Did the world refuse an event? Then its fluents did not change by what another event does.
  bool refused() const {
    return std::any_of(subject_.scope.steps.begin(), subject_.scope.steps.end(),
                       [](const auto& step) { return step.refused; });
  }

  /// Is the axiom all that the model says of an event that nothing brings about?
  bool is_lonely(std::size_t i) const {
    const auto& event = subject_.forms[i].event_symbol;
    return subject_.scope.idle.contains(event) &&
           std::count_if(subject_.forms.begin(), subject_.forms.end(),
                         [&](const auto& form) { return form.event_symbol == event; }) == 1;
  }

  std::vector<std::string> event_arguments(const AxiomForm& form) const {
    std::vector<std::string> out;
    const auto& node = ast(form)[form.event];
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      out.push_back(print_formula(ast(form), ast(form).child(node, i)));
    }
    return out;
  }

  void drop(std::size_t i, int oddity) {
    Edit edit;
    edit.kind = Edit::Kind::kDropAxiom;
    edit.axioms = {i};
    edit.event = subject_.forms[i].event_symbol;
    edit.oddity = oddity;
    out_.push_back(std::move(edit));
  }

  void edit_effects(std::size_t i) {
    const auto& form = subject_.forms[i];
    bool relevant = false, superfluous = true;
    for (const auto effect : form.effects) {
      const bool own = differs(form, effect);
      relevant = relevant || own;
      superfluous = superfluous && !came_reversed(form, effect);
      replace_effect(i, effect, own);
    }
    if (!relevant) return;
    drop(i, superfluous ? kDropSuperfluous : 3);
    edit_conditions(i);
    narrow(i);
  }

  /// Is the effect about a fluent that differed? A variable stands for all of them.
  bool differs(const AxiomForm& form, NodeId effect) const {
    const auto& fluent = ast(form)[effect_parts(ast(form), effect)->fluent];
    return fluent.kind != NodeKind::kApply ||
           subject_.fluents.contains(std::string(ast(form).name(fluent)));
  }

  /// Did the fluent change against the effect's sign with the event in some run? If it never did,
  /// the effect is more likely superfluous than reversed.
  bool came_reversed(const AxiomForm& form, NodeId effect) const {
    const auto& tree = ast(form);
    const auto& fluent = tree[effect_parts(tree, effect)->fluent];
    if (fluent.kind != NodeKind::kApply) return true;
    const std::string name(tree.name(fluent));
    const bool reversed = tree.name(tree[effect]) == "Terminates";
    const auto changed = subject_.scope.changed.find(form.event_symbol);
    if (changed != subject_.scope.changed.end() && changed->second.contains({name, reversed})) {
      return true;
    }
    // Demanded events are in no recording: the steps where runs and model part tell.
    if (!subject_.scope.demanded.contains(form.event_symbol)) return false;
    return std::any_of(
        subject_.scope.steps.begin(), subject_.scope.steps.end(), [&](const auto& step) {
          return std::any_of(step.differing.begin(), step.differing.end(), [&](const auto& seen) {
            const auto before = step.before.find(seen.first);
            return base::symbol_of(seen.first) == name && seen.second == reversed &&
                   before != step.before.end() && before->second != seen.second;
          });
        });
  }

  /// Adds conditions under which the axiom would not have applied in some step.
  void narrow(std::size_t i) {
    const auto& form = subject_.forms[i];
    const auto variables = variables_of(form, subject_.typed);
    const auto arguments = event_arguments(form);
    for (const auto& literal : condition_literals(subject_.typed, variables, kMostLiterals)) {
      const bool of_any = form.kind == AxiomForm::Kind::kRamification;
      const bool could_fail =
          of_any ? subject_.relevance.around_some_step(literal, false, false)
                 : subject_.relevance.in_some_step(literal, false, arguments, form.event_symbol,
                                                   form.variables);
      if (!could_fail || (form.kind == AxiomForm::Kind::kEffects &&
                          is_idle_condition(subject_.model, subject_.forms, form,
                                            print(literal, form.time, form.variables)))) {
        continue;
      }
      Edit edit;
      edit.kind = Edit::Kind::kNarrow;
      edit.axioms = {i};
      edit.literal = literal;
      edit.event = form.event_symbol;
      edit.oddity = 2 + subject_.relevance.oddity(literal, form.event_symbol);
      if (form.kind == AxiomForm::Kind::kTrigger && is_undone(subject_, form, literal))
        --edit.oddity;
      out_.push_back(std::move(edit));
    }
  }

  void edit_conditions(std::size_t i) {
    const auto& form = subject_.forms[i];
    for (const auto conjunct : form.conjuncts) {
      const auto& node = ast(form)[conjunct];
      const bool is_event =
          node.kind == NodeKind::kApply && ast(form).name(node) == std::string_view("Happens");
      if (is_event) continue;
      if (form.kind == AxiomForm::Kind::kRamification && effect_parts(ast(form), conjunct)) {
        other_reasons(i, conjunct);
        continue;
      }
      Edit edit;
      edit.kind = Edit::Kind::kDropCondition;
      edit.axioms = {i};
      edit.node = conjunct;
      edit.event = form.event_symbol;
      edit.oddity = 1;
      out_.push_back(edit);
      const auto text = print_formula(ast(form), conjunct);
      const bool negated = node.kind == NodeKind::kUnary && node.op == Operator::kNot;
      if (negated) {
        replace(i, conjunct, print_formula(ast(form), ast(form).child(node, 0)), 2);
      } else if (node.kind == NodeKind::kApply) {
        replace(i, conjunct, "!" + text, 2);
      }
      const auto variables = variables_of(form, subject_.typed);
      for (const auto& [other, oddity] :
           other_comparisons(ast(form), conjunct, subject_.typed, variables)) {
        replace(i, conjunct, other, oddity);
      }
      confuse(i, conjunct, variables);
      auto inner = negated ? ast(form).child(node, 0) : conjunct;
      if (ast(form)[inner].kind == NodeKind::kApply &&
          ast(form).name(ast(form)[inner]) == "HoldsAt") {
        for (const auto& other :
             other_terms(subject_, form, ast(form).child(ast(form)[inner], 0))) {
          ConditionLiteral literal{ConditionLiteral::Kind::kFluent, negated, other.symbol, {}};
          for (const auto& name : other.arguments) {
            const bool term = name.find_first_of("+-") != std::string::npos;
            literal.arguments.push_back(
                {term ? LiteralArgument::Kind::kTerm : LiteralArgument::Kind::kVariable, name});
          }
          const auto instead =
              (negated ? "!HoldsAt(" : "HoldsAt(") + other.text() + "," + form.time + ")";
          replace(i, conjunct, instead, other.oddity, std::move(literal));
        }
      }
    }
  }

  /// The effect from which another one follows has the other sign, or another argument.
  void other_reasons(std::size_t i, NodeId reason) {
    const auto& form = subject_.forms[i];
    const auto& tree = ast(form);
    const auto parts = *effect_parts(tree, reason);
    const std::string kind(tree.name(tree[reason]));
    const auto atom = [&](const std::string& name, const std::string& fluent) {
      return name + "(" + print_formula(tree, parts.event) + "," + fluent + "," + form.time + ")";
    };
    if (kind != "Releases") {
      replace(
          i, reason,
          atom(kind == "Initiates" ? "Terminates" : "Initiates", print_formula(tree, parts.fluent)),
          2);
    }
    for (const auto& other : other_terms(subject_, form, parts.fluent)) {
      replace(i, reason, atom(kind, other.text()), other.oddity + 1);
    }
  }

  /// Another literal takes the condition's place.
  void confuse(std::size_t i, NodeId conjunct, const std::vector<SortedVariable>& variables) {
    const auto& form = subject_.forms[i];
    const auto& node = ast(form)[conjunct];
    if (node.kind != NodeKind::kApply && node.kind != NodeKind::kUnary) return;
    if (!subject_.scope.more_fluents.empty()) return;  // these would be most of all edits
    const auto old = print_formula(ast(form), conjunct);
    for (const auto& literal : condition_literals(subject_.typed, variables, kMostConfused)) {
      if (literal.kind != ConditionLiteral::Kind::kFluent ||
          literal.count(LiteralArgument::Kind::kConstant) > 0) {
        continue;
      }
      const auto text = print(literal, form.time, form.variables);
      if (text == old || "!" + text == old || text == "!" + old) continue;
      const bool same = old.find("(" + literal.symbol + "(") != std::string::npos;
      if (same || is_idle_condition(subject_.model, subject_.forms, form, text)) continue;
      const int known = std::min(0, subject_.relevance.oddity(literal, form.event_symbol));
      replace(i, conjunct, text, 5 + known + (literal.negated ? 1 : 0), literal);
    }
  }

  void replace(std::size_t i, NodeId node, std::string text, int oddity,
               std::optional<ConditionLiteral> literal = std::nullopt) {
    if (text == print_formula(ast(subject_.forms[i]), node)) return;
    Edit edit;
    edit.kind = Edit::Kind::kReplace;
    edit.axioms = {i};
    edit.node = node;
    edit.text = std::move(text);
    edit.literal = std::move(literal);
    edit.event = subject_.forms[i].event_symbol;
    edit.oddity = oddity;
    out_.push_back(std::move(edit));
  }

  void replace_effect(std::size_t i, NodeId effect, bool differs) {
    const auto& form = subject_.forms[i];
    const auto& tree = ast(form);
    const auto parts = *effect_parts(tree, effect);
    const std::string kind(tree.name(tree[effect]));
    const auto event = print_formula(tree, parts.event), fluent = print_formula(tree, parts.fluent);
    const auto atom = [&](const std::string& name, const std::string& e, const std::string& f) {
      return name + "(" + e + "," + f + "," + form.time + ")";
    };
    if (differs && kind != "Releases") {
      replace(i, effect, atom(kind == "Initiates" ? "Terminates" : "Initiates", event, fluent),
              came_reversed(form, effect) ? 1 : 1 + kDropSuperfluous);
    }
    if (differs && tree[parts.fluent].kind == NodeKind::kApply) {
      for (const auto& other : other_terms(subject_, form, parts.fluent)) {
        replace(i, effect, atom(kind, event, other.text()), other.oddity);
      }
      for (const auto& [e, f] : exchanged(ast(form), parts, subject_.typed)) {
        of_other_arguments(i, effect, atom(kind, e, f), 2);
      }
      for (const auto& other : other_terms(subject_, form, parts.event)) {
        of_other_arguments(i, effect, atom(kind, other.text(), fluent), other.oddity + 1);
      }
    }
    // No recording tells what a demanded event did: an effect that did not differ is rather right.
    const int instead = !differs && subject_.scope.demanded.contains(form.event_symbol) ? 3 : 2;
    for (const auto& name : differs ? fluents_for(form.event_symbol, kind) : subject_.fluents) {
      const auto symbol = subject_.typed.find_symbol(name);
      if (!symbol || subject_.typed.symbols[*symbol].kind != SymbolKind::kFluent) continue;
      if (subject_.typed.symbols[*symbol].noninertial) continue;
      if (tree[parts.fluent].kind == NodeKind::kApply && tree.name(tree[parts.fluent]) == name) {
        continue;
      }
      const auto variables = variables_of(form, subject_.typed);
      for (const auto& [term, oddity] :
           terms(name, subject_.typed.symbols[*symbol].arguments, variables)) {
        replace(i, effect, atom(kind, event, term), instead + oddity);
      }
    }
  }

  /// The effect of the event with other arguments.
  void of_other_arguments(std::size_t i, NodeId effect, std::string text, int oddity) {
    const auto count = out_.size();
    replace(i, effect, std::move(text), oddity);
    if (out_.size() > count) out_.back().moves_effect = true;
  }

  /// Fluents that a wrong effect may be about instead: those that differed, and hidden ones for
  /// which the event has no axiom of that kind. Hidden are fluents that some axiom releases, so
  /// that the model follows them anyway, and fluents that the event changed in some run all the
  /// same.
  std::set<std::string> fluents_for(const std::string& event, const std::string& kind) const {
    auto out = subject_.fluents;
    if (kind == "Releases") return out;
    std::set<std::string> own, hidden;
    for (const auto& form : subject_.forms) {
      if (form.kind != AxiomForm::Kind::kEffects) continue;
      for (const auto effect : form.effects) {
        const auto& tree = ast(form);
        const auto& fluent = tree[effect_parts(tree, effect)->fluent];
        if (fluent.kind != NodeKind::kApply) continue;
        const std::string name(tree.name(fluent));
        if (tree.name(tree[effect]) == "Releases") hidden.insert(name);
        if (form.event_symbol == event && tree.name(tree[effect]) == kind) own.insert(name);
      }
    }
    const auto changed = subject_.scope.changed.find(event);
    if (changed != subject_.scope.changed.end()) {
      for (const auto& [name, holds] : changed->second) {
        const auto symbol = subject_.typed.find_symbol(name);
        const bool inertial = symbol && !subject_.typed.symbols[*symbol].noninertial;
        if (inertial && holds == (kind == "Initiates")) hidden.insert(name);
      }
    }
    for (const auto& name : hidden) {
      if (!own.contains(name)) out.insert(name);
    }
    return out;
  }

  /// Terms of a symbol with these variables and with constants; without constants where that would
  /// be too many.
  std::vector<std::pair<std::string, int>> terms(
      const std::string& symbol, const std::vector<SortId>& sorts,
      const std::vector<SortedVariable>& variables) const {
    auto out = terms(symbol, sorts, variables, true);
    return out.empty() ? terms(symbol, sorts, variables, false) : out;
  }
  std::vector<std::pair<std::string, int>> terms(const std::string& symbol,
                                                 const std::vector<SortId>& sorts,
                                                 const std::vector<SortedVariable>& variables,
                                                 bool constants) const {
    std::vector<std::pair<std::string, int>> out = {{"", 0}};
    for (const auto sort : sorts) {
      std::vector<std::pair<std::string, int>> next;
      for (const auto& [begun, oddity] : out) {
        const auto comma = begun.empty() ? "" : begun + ",";
        for (const auto& variable : variables) {
          if (subject_.typed.sorts_overlap(variable.sort, sort)) {
            next.emplace_back(comma + variable.name, oddity);
          }
        }
        if (!constants) continue;
        for (const auto& name : constants_of(subject_.typed, sort)) {
          next.emplace_back(comma + name, oddity + 2);
        }
      }
      out = std::move(next);
      if (out.size() > kMostLiterals) return {};
    }
    for (auto& [text, oddity] : out) text = symbol + "(" + text + ")";
    return out;
  }

  const EditSubject& subject_;
  std::vector<Edit>& out_;
};

}  // namespace

void add_axiom_edits(const EditSubject& subject, std::vector<Edit>& edits) {
  AxiomEdits maker(subject, edits);
  for (std::size_t i = 0; i < subject.forms.size(); ++i) {
    if (subject.forms[i].kind == AxiomForm::Kind::kRamification) maker.edit_ramification(i);
    if (subject.events.contains(subject.forms[i].event_symbol)) maker.edit(i);
    maker.move_effects(i);
  }
}

}  // namespace parallax::compiler
