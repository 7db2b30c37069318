#include "compiler/repair/guarded_model.h"

#include <algorithm>
#include <map>
#include <optional>

#include "compiler/repair/edit_text.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

std::string on(std::size_t edit) { return edit_predicate(edit) + "()"; }

std::string list_of(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ",") + name;
  return out;
}

std::string joined(const std::vector<std::string>& parts, const std::string& effect) {
  std::string out;
  for (const auto& part : parts) out += (out.empty() ? "" : " & ") + part;
  return out.empty() ? effect : out + " -> " + effect;
}

class GuardedForm {
 public:
  GuardedForm(const ModelAst& model, const TypedModel& typed, const std::vector<AxiomForm>& forms,
              const std::vector<Edit>& edits, std::size_t axiom)
      : model_(model),
        typed_(typed),
        forms_(forms),
        form_(forms[axiom]),
        edits_(edits),
        axiom_(axiom) {
    for (std::size_t i = 0; i < edits.size(); ++i) {
      const auto& axioms = edits[i].axioms;
      if (std::find(axioms.begin(), axioms.end(), axiom) != axioms.end()) touching_.push_back(i);
    }
  }

  bool is_touched() const { return !touching_.empty(); }

  std::string text() const {
    const auto& ast = model_.ast(form_.place);
    const auto quantifier = form_.variables.empty() ? "" : "[" + list_of(form_.variables) + "] ";
    auto conditions = guarded_conditions();
    for (const auto i : touching_) {
      const bool goes = edits_[i].kind == Edit::Kind::kDropAxiom ||
                        edits_[i].kind == Edit::Kind::kDelay ||
                        edits_[i].kind == Edit::Kind::kRewrite;
      if (goes) conditions.push_back("!" + on(i));
    }
    const bool of_effects =
        form_.kind == AxiomForm::Kind::kEffects || form_.kind == AxiomForm::Kind::kRamification;
    if (!of_effects) {
      std::string kept;
      auto own = conditions;
      for (const auto i : touching_) {
        const auto other = instead_of(form_.head, i);
        if (other.empty()) continue;
        own.push_back("!" + on(i));
        auto instead = conditions;
        instead.push_back(on(i));
        kept += quantifier + joined(instead, other) + ".\n";
      }
      kept += quantifier + joined(own, "(" + print_formula(ast, form_.head) + ")") + ".\n";
      for (const auto i : touching_) {
        if (edits_[i].kind != Edit::Kind::kRewrite) continue;
        kept += quantifier + on(i) + " -> (" + edits_[i].text + ").\n";
      }
      return kept;
    }
    std::string out;
    const bool shares = form_.kind == AxiomForm::Kind::kEffects && conditions.size() > 1;
    if (shares && replaces_effects()) conditions = {share(conditions, out)};
    for (const auto effect : form_.effects) {
      auto kept = conditions;
      for (const auto i : touching_) {
        const auto other = instead_of(effect, i);
        if (other.empty()) continue;
        kept.push_back("!" + on(i));
        auto instead = conditions;
        instead.push_back(on(i));
        out += quantifier + joined(instead, other) + ".\n";
      }
      out += quantifier + joined(kept, print_formula(ast, effect)) + ".\n";
    }
    return out;
  }

 private:
  bool replaces_effects() const {
    return std::any_of(touching_.begin(), touching_.end(), [&](std::size_t i) {
      return std::any_of(form_.effects.begin(), form_.effects.end(),
                         [&](NodeId effect) { return !instead_of(effect, i).empty(); });
    });
  }

  /// A predicate for all conditions together: written out for each replacement they would be most
  /// of the text. Where the event does not happen nothing follows from it, so that a solver need
  /// not look at it there.
  std::string share(const std::vector<std::string>& conditions, std::string& out) const {
    const auto& ast = model_.ast(form_.place);
    const auto name = "RepairIf" + std::to_string(axiom_);
    std::vector<std::string> sorts;
    for (const auto& variable : form_.variables) {
      sorts.push_back(variable.substr(0, variable.find_last_not_of("0123456789") + 1));
    }
    const auto atom = name + "(" + list_of(form_.variables) + ")";
    const auto quantifier = "[" + list_of(form_.variables) + "] ";
    auto happening = conditions;
    // An edit may say the effect of another event.
    const bool own = std::none_of(touching_.begin(), touching_.end(),
                                  [&](std::size_t i) { return edits_[i].moves_effect; });
    if (own) {
      happening.insert(happening.begin(),
                       "Happens(" + print_formula(ast, form_.event) + "," + form_.time + ")");
    }
    out += "predicate " + name + "(" + list_of(sorts) + ")\n";
    out += quantifier + joined(happening, atom) + ".\n";
    for (const auto& condition : conditions) {
      out += quantifier + atom + " -> " + condition + ".\n";
    }
    return atom;
  }

  /// Text that the edit puts in the place of an effect; empty: the effect stays as it is.
  std::string instead_of(NodeId effect, std::size_t edit) const {
    const auto& ast = model_.ast(form_.place);
    if (edits_[edit].kind == Edit::Kind::kReplace && edits_[edit].node == effect) {
      return edits_[edit].text;
    }
    for (const auto& [axiom, node] : edits_[edit].nodes) {
      if (axiom != axiom_ || node != effect) continue;
      return "Releases" + print_formula(ast, effect).substr(ast.name(ast[effect]).size());
    }
    return {};
  }

  std::vector<std::string> guarded_conditions() const {
    const auto& ast = model_.ast(form_.place);
    std::vector<std::string> out;
    for (const auto conjunct : form_.conjuncts) {
      auto text = "(" + print_formula(ast, conjunct) + ")";
      std::string off;
      for (const auto i : touching_) {
        if (edits_[i].node != conjunct) continue;
        if (edits_[i].kind == Edit::Kind::kDropCondition) off += " | " + on(i);
        if (edits_[i].kind == Edit::Kind::kReplace) {
          off += " | " + on(i);
          const auto& literal = edits_[i].literal;
          out.push_back("(!" + on(i) + " | (" +
                        (literal ? everywhere({*literal}) : edits_[i].text) + "))");
        }
      }
      const auto literal = off.empty() ? std::nullopt : literal_of(conjunct);
      if (literal) text = everywhere({*literal});
      out.push_back(off.empty() ? text : "(" + text + off + ")");
    }
    for (const auto i : touching_) {
      const auto kind = edits_[i].kind;
      if (kind != Edit::Kind::kNarrow && kind != Edit::Kind::kNarrowEvent) continue;
      const auto literals = literals_in(model_, forms_, edits_[i], axiom_);
      out.push_back("(!" + on(i) + " | " +
                    (literals.empty() ? edits_[i].text : everywhere(literals)) + ")");
    }
    return out;
  }

  /// None: it is no literal over variables.
  std::optional<ConditionLiteral> literal_of(NodeId conjunct) const {
    const auto& ast = model_.ast(form_.place);
    ConditionLiteral out;
    auto node = conjunct;
    if (ast[node].kind == NodeKind::kUnary && ast[node].op == Operator::kNot) {
      out.negated = true;
      node = ast.child(ast[node], 0);
    }
    if (ast[node].kind != NodeKind::kApply) return std::nullopt;
    out.kind = ConditionLiteral::Kind::kPredicate;
    if (ast.name(ast[node]) == "HoldsAt") {
      out.kind = ConditionLiteral::Kind::kFluent;
      node = ast.child(ast[node], 0);
      if (ast[node].kind != NodeKind::kApply) return std::nullopt;
    }
    out.symbol = ast.name(ast[node]);
    const auto symbol = typed_.find_symbol(out.symbol);
    if (!symbol || typed_.symbols[*symbol].arguments.size() != ast[node].child_count) {
      return std::nullopt;
    }
    for (std::uint32_t i = 0; i < ast[node].child_count; ++i) {
      const auto argument = ast.child(ast[node], i);
      const bool term = ast[argument].kind == NodeKind::kBinary;
      out.arguments.push_back(
          {term ? LiteralArgument::Kind::kTerm : LiteralArgument::Kind::kVariable,
           print_formula(ast, argument)});
    }
    return out;
  }

  /// One of them holds, and each of them is about something: as it is where it is written.
  std::string everywhere(const std::vector<ConditionLiteral>& literals) const {
    std::string any, all;
    for (const auto& literal : literals) {
      any += (any.empty() ? "" : " | ") +
             print_everywhere(literal, typed_, form_.time, form_.variables);
      const auto typing = typing_of(literal, typed_, form_.variables);
      if (!typing.empty()) all += typing + " & ";
    }
    return literals.size() == 1 ? any : "(" + all + "(" + any + "))";
  }

  const ModelAst& model_;
  const TypedModel& typed_;
  const std::vector<AxiomForm>& forms_;
  const AxiomForm& form_;
  const std::vector<Edit>& edits_;
  std::size_t axiom_;
  std::vector<std::size_t> touching_;
};

/// An event with new triggers alone does not happen without them: what an axiom can demand is free
/// to happen.
std::string only_if_triggered(const std::vector<Edit>& edits) {
  std::map<std::string, std::string> by_event;  // "[a,time] Happens(E(a),time) -> ..."
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const auto& edit = edits[i];
    if (edit.kind != Edit::Kind::kAddTrigger && !edit.moves_trigger) continue;
    auto& text = by_event[edit.event];
    if (!text.empty()) {
      text += " | " + on(i);
      continue;
    }
    auto variables = edit.variables;
    variables.emplace_back("time");
    text = "[" + list_of(variables) + "] Happens(" + edit.event + "(" + list_of(edit.variables) +
           "),time) -> " + on(i);
  }
  std::string out;
  for (const auto& [event, text] : by_event) out += text + ".\n";
  return out;
}

}  // namespace

std::string edit_predicate(std::size_t edit) { return "RepairEdit" + std::to_string(edit); }

std::string guarded_text(const ModelAst& model, const TypedModel& typed,
                         const base::SourceFiles& files, const std::vector<AxiomForm>& forms,
                         const std::vector<Edit>& edits) {
  std::vector<TextChange> changes;
  for (std::size_t i = 0; i < forms.size(); ++i) {
    const GuardedForm guarded(model, typed, forms, edits, i);
    if (!guarded.is_touched()) continue;
    changes.push_back(
        {model.ast(forms[i].place).file(), forms[i].begin, forms[i].end, guarded.text()});
  }
  auto out = flat_text(model, files, changes);
  for (std::size_t i = 0; i < edits.size(); ++i) {
    out += "predicate " + edit_predicate(i) + "()\n";
  }
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const auto& edit = edits[i];
    for (const auto& late : edit.sentences) {
      std::vector<std::string> when = {on(i)};
      if (!late.condition.empty()) when.push_back(late.condition);
      out += "[" + list_of(late.variables) + "] " + joined(when, late.effect) + ".\n";
    }
    const bool requires_it = edit.kind == Edit::Kind::kRequire;
    const bool adds = edit.kind == Edit::Kind::kAddEffect || edit.kind == Edit::Kind::kAddTrigger;
    if (!requires_it && !adds) continue;
    const std::vector<std::string> of_event(
        edit.variables.begin(),
        edit.variables.begin() + static_cast<std::ptrdiff_t>(edit.event_arity));
    auto variables = edit.variables;
    variables.emplace_back("time");
    std::vector<std::string> conditions = {on(i)};
    for (const auto& literal : edit.given) {
      conditions.push_back(print(literal, "time", edit.variables));
    }
    for (std::size_t j = i + 1; j < edits.size() && !requires_it; ++j) {
      if (edits[j].kind != Edit::Kind::kAddCondition || edits[j].of != i) break;
      conditions.push_back("(!" + on(j) + " | " +
                           print_everywhere(*edits[j].literal, typed, "time", edits[j].variables) +
                           ")");
    }
    auto effect = edit.text;
    if (requires_it) {
      conditions.push_back("Happens(" + edit.event + "(" + list_of(of_event) + "),time)");
      effect = print(*edit.literal, "time", edit.variables);
    }
    out += "[" + list_of(variables) + "] " + joined(conditions, effect) + ".\n";
  }
  return out + only_if_triggered(edits);
}

}  // namespace parallax::compiler
