// Small wrong edits of a model, one axiom at a time, to see whether a check notices them.
//
// Operators follow the mistakes that people make in axioms: an axiom, a precondition, a release
// or a condition forgotten, a condition or a fact negated, a condition added, two arguments of a
// sort swapped, Initiates and Terminates exchanged, an effect on another fluent (mutation
// analysis, DeMillo, Lipton and Sayward 1978). Every operator is applied at every place where it
// fits. An edit that changes no text is left out, as is a condition that is known to be idle; a
// fluent is used only where the axiom's file knows it. Mutations come in the order of the text.
//
// Cost: linear in the conditions and effects, times the pairs of an axiom's variables or the
// fluents of the model.

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>
#include <utility>

#include "compiler/repair/edit_text.h"
#include "compiler/repair/idle_condition.h"
#include "compiler/repair/mutation.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

/// The text with two names exchanged wherever they stand as words.
std::string with_exchanged(const std::string& text, const std::string& a, const std::string& b) {
  const auto in_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  std::string out;
  for (std::size_t at = 0; at < text.size();) {
    auto end = at;
    while (end < text.size() && in_name(text[end])) ++end;
    if (end == at) {
      out += text[at++];
      continue;
    }
    const auto word = text.substr(at, end - at);
    out += word == a ? b : word == b ? a : word;
    at = end;
  }
  return out;
}

bool is_apply(const Ast& ast, NodeId node, std::string_view name) {
  return ast[node].kind == NodeKind::kApply && ast.name(ast[node]) == name;
}

bool is_not(const Ast& ast, NodeId node) {
  return ast[node].kind == NodeKind::kUnary && ast[node].op == Operator::kNot;
}

/// Effects and preconditions.
bool is_of_event(const AxiomForm& form) {
  return form.kind == AxiomForm::Kind::kEffects || form.kind == AxiomForm::Kind::kPrecondition;
}

class ModelMutator {
 public:
  ModelMutator(const ModelAst& model, const TypedModel& typed, const base::SourceFiles& files)
      : model_(model), typed_(typed), files_(files), forms_(all_forms(model, files)) {}

  std::vector<Mutation> make() {
    place_fluents();
    for (std::size_t i = 0; i < forms_.size(); ++i) {
      switch (forms_[i].kind) {
        case AxiomForm::Kind::kEffects:
          mutate_effects(i);
          break;
        case AxiomForm::Kind::kPrecondition:
          drop(i, "precondition forgotten");
          mutate_conditions(i);
          break;
        case AxiomForm::Kind::kTrigger:
        case AxiomForm::Kind::kLateEffects:
        case AxiomForm::Kind::kRamification:
        case AxiomForm::Kind::kState:
        case AxiomForm::Kind::kStart:
        case AxiomForm::Kind::kOther:
          mutate_other(i);
          break;
      }
    }
    const EditText text(model_, files_, forms_, edits_);
    std::vector<Mutation> out;
    for (std::size_t i = 0; i < edits_.size(); ++i) {
      out.push_back({std::move(kinds_[i]), text.words({i}), places_[i], text.changes({i}),
                     is_of_event(forms_[edits_[i].axioms.front()]) && !negated_[i]});
    }
    std::stable_sort(out.begin(), out.end(), [](const Mutation& a, const Mutation& b) {
      return std::pair(a.at.file, a.at.begin) < std::pair(b.at.file, b.at.begin);
    });
    return out;
  }

 private:
  const Ast& ast(std::size_t i) const { return model_.ast(forms_[i].place); }

  /// Position at which each statement acts: a file that others load need not know their later
  /// declarations.
  void place_fluents() {
    std::map<base::FileId, std::size_t> last;
    for (std::size_t k = 0; k < model_.order.size(); ++k) {
      last[model_.ast(model_.order[k]).file()] = k;
    }
    for (const auto& form : forms_) last_.push_back(last.at(model_.ast(form.place).file()));
    for (const auto& symbol : typed_.symbols) {
      if (symbol.kind != SymbolKind::kFluent) continue;
      for (std::size_t k = 0; k < model_.order.size(); ++k) {
        const auto& source = model_.statement(model_.order[k]).source;
        const auto& declared = symbol.declared;
        if (model_.ast(model_.order[k]).file() != declared.file || declared.begin < source.begin ||
            declared.begin >= source.end) {
          continue;
        }
        declared_.emplace(symbol.name, k);
      }
    }
  }
  bool knows(std::size_t i, const std::string& fluent) const {
    const auto at = declared_.find(fluent);
    return at != declared_.end() && at->second <= last_[i];
  }

  void add(Edit edit, std::string kind, base::SourceRange at, bool negated = false) {
    edit.event = forms_[edit.axioms.front()].event_symbol;
    edits_.push_back(std::move(edit));
    kinds_.push_back(std::move(kind));
    places_.push_back(at);
    negated_.push_back(negated);
  }

  base::SourceRange whole(std::size_t i) const {
    return {ast(i).file(), forms_[i].begin, forms_[i].end};
  }

  void drop(std::size_t i, std::string kind) {
    Edit edit;
    edit.kind = Edit::Kind::kDropAxiom;
    edit.axioms = {i};
    add(std::move(edit), std::move(kind), whole(i));
  }

  void replace(std::size_t i, NodeId node, std::string text, std::string kind,
               bool negated = false) {
    if (text == print_formula(ast(i), node)) return;
    Edit edit;
    edit.kind = Edit::Kind::kReplace;
    edit.axioms = {i};
    edit.node = node;
    edit.text = std::move(text);
    add(std::move(edit), std::move(kind), ast(i).source(ast(i)[node]), negated);
  }

  /// Its opposite. Nothing for what would need parentheses.
  void negate(std::size_t i, NodeId node, std::string kind) {
    const auto& tree = ast(i);
    if (is_not(tree, node)) {
      const auto inner = tree.child(tree[node], 0);
      if (tree[inner].kind == NodeKind::kApply) {
        replace(i, node, print_formula(tree, inner), std::move(kind), true);
      }
    } else if (tree[node].kind == NodeKind::kApply) {
      replace(i, node, "!" + print_formula(tree, node), std::move(kind), true);
    } else if (tree[node].kind == NodeKind::kBinary &&
               (tree[node].op == Operator::kEqual || tree[node].op == Operator::kNotEqual)) {
      const auto side = [&](std::uint32_t k) {
        return print_formula(tree, tree.child(tree[node], k));
      };
      replace(i, node, side(0) + (tree[node].op == Operator::kEqual ? "!=" : "=") + side(1),
              std::move(kind), true);
    }
  }

  void mutate_other(std::size_t i) {
    drop(i, "axiom dropped");
    const auto& form = forms_[i];
    if (form.condition) {
      mutate_conditions(i);
    } else {
      negate(i, form.head, "fact negated");
    }
  }

  void mutate_conditions(std::size_t i) {
    const auto& form = forms_[i];
    const auto& tree = ast(i);
    for (const auto conjunct : form.conjuncts) {
      // Without its event it were another kind of axiom.
      if (form.kind == AxiomForm::Kind::kPrecondition && is_apply(tree, conjunct, "Happens")) {
        continue;
      }
      Edit edit;
      edit.kind = Edit::Kind::kDropCondition;
      edit.axioms = {i};
      edit.node = conjunct;
      add(std::move(edit), "condition dropped", tree.source(tree[conjunct]));
      negate(i, conjunct, "condition negated");
      const auto inner = is_not(tree, conjunct) ? tree.child(tree[conjunct], 0) : conjunct;
      if (is_of_event(form) && is_apply(tree, inner, "HoldsAt")) {
        exchange_variables(i, conjunct);
      }
    }
  }

  void exchange_variables(std::size_t i, NodeId node) {
    const auto& names = forms_[i].variables;
    const auto text = print_formula(ast(i), node);
    for (std::size_t a = 0; a < names.size(); ++a) {
      for (std::size_t b = a + 1; b < names.size(); ++b) {
        const auto first = sort_of_variable(typed_, names[a]);
        if (names[a] == forms_[i].time || names[b] == forms_[i].time || !first ||
            first != sort_of_variable(typed_, names[b])) {
          continue;
        }
        replace(i, node, with_exchanged(text, names[a], names[b]), "argument swapped");
      }
    }
  }

  void mutate_effects(std::size_t i) {
    const auto& form = forms_[i];
    const auto& tree = ast(i);
    const bool releases = std::any_of(form.effects.begin(), form.effects.end(), [&](NodeId node) {
      return is_apply(tree, node, "Releases");
    });
    drop(i, releases ? "release forgotten" : "axiom dropped");
    mutate_conditions(i);
    for (const auto effect : form.effects) mutate_effect(i, effect);
    for (const auto& [fluent, term] : terms(i)) {
      ConditionLiteral literal;
      literal.symbol = fluent;
      literal.arguments = term;
      if (is_idle_condition(model_, forms_, form, print(literal, form.time, form.variables))) {
        continue;
      }
      Edit edit;
      edit.kind = Edit::Kind::kNarrow;
      edit.axioms = {i};
      edit.literal = std::move(literal);
      add(std::move(edit), "condition added", whole(i));
    }
  }

  void mutate_effect(std::size_t i, NodeId effect) {
    const auto& form = forms_[i];
    const auto& tree = ast(i);
    const auto parts = *effect_parts(tree, effect);
    const std::string kind(tree.name(tree[effect]));
    const auto event = print_formula(tree, parts.event), fluent = print_formula(tree, parts.fluent);
    const auto atom = [&](const std::string& name, const std::string& f) {
      return name + "(" + event + "," + f + "," + form.time + ")";
    };
    if (kind == "Initiates") replace(i, effect, atom("Terminates", fluent), "sign flipped");
    if (kind == "Terminates") replace(i, effect, atom("Initiates", fluent), "sign flipped");
    exchange_variables(i, effect);
    for (const auto& [name, term] : terms(i)) {
      if (tree[parts.fluent].kind == NodeKind::kApply && tree.name(tree[parts.fluent]) == name) {
        continue;
      }
      std::string text = name + "(";
      for (std::size_t k = 0; k < term.size(); ++k) text += (k == 0 ? "" : ",") + term[k].name;
      replace(i, effect, atom(kind, text + ")"), "effect on the wrong fluent");
    }
  }

  /// For each fluent that effects can change, a term over the first variables of its sorts; none
  /// where the axiom has no such variable.
  std::vector<std::pair<std::string, std::vector<LiteralArgument>>> terms(std::size_t i) const {
    std::vector<std::pair<std::string, std::vector<LiteralArgument>>> out;
    for (const auto& symbol : typed_.symbols) {
      if (symbol.kind != SymbolKind::kFluent || symbol.noninertial) continue;
      if (!knows(i, symbol.name)) continue;
      std::vector<LiteralArgument> term;
      for (const auto sort : symbol.arguments) {
        const auto name = std::find_if(
            forms_[i].variables.begin(), forms_[i].variables.end(), [&](const auto& variable) {
              return variable != forms_[i].time && sort_of_variable(typed_, variable) == sort;
            });
        if (name == forms_[i].variables.end()) break;
        term.push_back({LiteralArgument::Kind::kVariable, *name});
      }
      if (term.size() == symbol.arguments.size()) out.emplace_back(symbol.name, std::move(term));
    }
    return out;
  }

  const ModelAst& model_;
  const TypedModel& typed_;
  const base::SourceFiles& files_;
  std::vector<AxiomForm> forms_;
  std::vector<std::size_t> last_;                // by form: the last statement of its file
  std::map<std::string, std::size_t> declared_;  // fluents, by statement
  std::vector<Edit> edits_;
  std::vector<std::string> kinds_;         // by edit
  std::vector<base::SourceRange> places_;  // by edit
  std::vector<bool> negated_;              // by edit
};

}  // namespace

std::vector<Mutation> model_mutations(const ModelAst& model, const TypedModel& typed,
                                      const base::SourceFiles& files) {
  return ModelMutator(model, typed, files).make();
}

}  // namespace parallax::compiler
