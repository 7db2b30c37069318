// Edits of formulas about states: constraints, definitions of fluents that follow from others, and
// what holds at timepoint 0.
//
// Such a formula is dropped, or a part of its text gives way to another one: a literal is negated,
// goes, or has another argument or fluent; an equivalence keeps one direction; a condition is
// added. Each edit carries the whole new formula for the guarded model and the small change for the
// patch. A formula is edited if it mentions a fluent that differed. Cost: literals of the formula
// times variables and constants.

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "compiler/repair/edit_subject.h"
#include "compiler/repair/number_term.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMostAdded = 40;  // literals of a symbol as a further condition
constexpr int kDropConstraint = 1;
constexpr int kOtherSign = 3;       // `|` for `&`
constexpr int kDropDefinition = 6;  // a definition is rather wrong than superfluous

class StateFormulaEdits {
 public:
  StateFormulaEdits(const EditSubject& subject, std::size_t axiom, std::vector<Edit>& out)
      : subject_(subject),
        axiom_(axiom),
        form_(subject.forms[axiom]),
        ast_(subject.model.ast(form_.place)),
        text_(ast_.text({0, form_.end})),
        body_(extent(form_.body)),
        out_(out) {}

  void edit() {
    if (!mentions_a_difference()) return;
    const auto& root = ast_[form_.body];
    const bool definition = root.kind == NodeKind::kBinary && root.op == Operator::kIff;
    Edit edit = begun();
    edit.kind = Edit::Kind::kDropAxiom;
    edit.oddity = definition ? kDropDefinition : kDropConstraint;
    edit.frees = definition;
    out_.push_back(std::move(edit));
    if (definition) {
      keep_one_direction(root);
      find_defined(root);
    }
    if (subject_.scope.wide) return;
    if (form_.condition) drop_condition();
    auto variables = sorted(form_.variables);
    edit_parts(form_.body, variables);
    add_conditions(root, variables);
  }

 private:
  /// The fluent that a definition is about: its other side says when it holds. A sentence in which
  /// it stands on both sides, or that is about another fluent, would say nothing of it.
  void find_defined(const Node& root) {
    const auto defined_by = definiens(root);
    if (!defined_by) return;
    for (const std::uint32_t i : {0U, 1U}) {
      const auto& side = ast_[ast_.child(root, i)];
      if (ast_.child(root, i) == *defined_by || side.child_count == 0) continue;
      defined_ = ast_.name(ast_[ast_.child(side, 0)]);
    }
  }

  TextExtent extent(NodeId node) const {
    return with_parentheses(text_, ast_[node], form_.begin, form_.end);
  }
  std::string text_of(TextExtent at) const {
    return std::string(text_.substr(at.begin, at.end - at.begin));
  }

  std::vector<SortedVariable> sorted(const std::vector<std::string>& names) const {
    std::vector<SortedVariable> out;
    for (const auto& name : names) {
      const auto sort = sort_of_variable(subject_.typed, name);
      if (sort && name != form_.time) out.push_back({name, *sort});
    }
    return out;
  }

  bool mentions_a_difference() const {
    std::vector<NodeId> open = {form_.body};
    while (!open.empty()) {
      const auto& node = ast_[open.back()];
      open.pop_back();
      if (node.kind == NodeKind::kApply &&
          subject_.fluents.contains(std::string(ast_.name(node)))) {
        return true;
      }
      for (std::uint32_t i = 0; i < node.child_count; ++i) open.push_back(ast_.child(node, i));
    }
    return false;
  }

  Edit begun() const {
    Edit edit;
    edit.axioms = {axiom_};
    return edit;
  }

  /// A part of the text gives way to another one.
  void rewrite(TextExtent part, const std::string& instead, int oddity, std::string words) {
    if (instead == text_of(part)) return;
    Edit edit = begun();
    edit.kind = Edit::Kind::kRewrite;
    edit.change = {ast_.file(), part.begin, part.end, instead};
    edit.text = text_of({body_.begin, part.begin}) + instead + text_of({part.end, body_.end});
    edit.oddity = oddity;
    edit.words = std::move(words);
    out_.push_back(std::move(edit));
  }
  void replace(TextExtent part, const std::string& instead, int oddity) {
    rewrite(part, instead, oddity,
            "with `" + instead + "` in the place of `" + text_of(part) + "`");
  }

  /// `A -> B` becomes B.
  void drop_condition() {
    const TextExtent gone{extent(*form_.condition).begin, extent(form_.head).begin};
    rewrite(gone, "", 3, "also without the condition `" + text_of(extent(*form_.condition)) + "`");
  }

  void keep_one_direction(const Node& root) {
    const auto left = beside_arrow(ast_.child(root, 0)), right = beside_arrow(ast_.child(root, 1));
    rewrite(body_, left + " -> " + right, 4, "only from left to right");
    rewrite(body_, right + " -> " + left, 4, "only from right to left");
    out_[out_.size() - 1].frees = out_[out_.size() - 2].frees = true;
  }

  /// A side of `<->`, in parentheses if it needs them beside `->`.
  std::string beside_arrow(NodeId node) const {
    const auto& root = ast_[node];
    const auto at = extent(node);
    const bool open = at.begin == root.begin && root.kind == NodeKind::kBinary &&
                      (root.op == Operator::kImplies || root.op == Operator::kIff);
    return open || root.kind == NodeKind::kExists || root.kind == NodeKind::kForall
               ? "(" + text_of(at) + ")"
               : text_of(at);
  }

  void edit_parts(NodeId at, std::vector<SortedVariable>& variables) {
    const auto& node = ast_[at];
    if (node.kind == NodeKind::kForall || node.kind == NodeKind::kExists) {
      auto inner = variables;
      for (std::uint32_t i = 0; i + 1 < node.child_count; ++i) {
        const auto own = sorted({std::string(ast_.name(ast_[ast_.child(node, i)]))});
        inner.insert(inner.end(), own.begin(), own.end());
      }
      edit_parts(ast_.child(node, node.child_count - 1), inner);
      return;
    }
    const bool negated = node.kind == NodeKind::kUnary && node.op == Operator::kNot;
    if (negated && ast_[ast_.child(node, 0)].kind == NodeKind::kApply) {
      edit_literal(at, ast_.child(node, 0), variables);
      return;
    }
    if (node.kind == NodeKind::kApply) {
      edit_literal(at, at, variables);
      return;
    }
    if (node.kind == NodeKind::kBinary && is_comparison(node.op)) {
      for (const auto& [text, oddity] : other_comparisons(ast_, at, subject_.typed, variables)) {
        replace({node.begin, node.end}, text, oddity + 1);
      }
      name_others(node);
      return;
    }
    if (node.kind == NodeKind::kBinary && (node.op == Operator::kAnd || node.op == Operator::kOr)) {
      drop_parts(node);
      exchange_signs(node);
    }
    for (std::uint32_t i = 0; i < node.child_count; ++i) edit_parts(ast_.child(node, i), variables);
  }

  /// Other constants in `x=c`.
  void name_others(const Node& comparison) {
    if (comparison.child_count != 2) return;
    for (const std::uint32_t i : {0U, 1U}) {
      const auto& constant = ast_[ast_.child(comparison, i)];
      const auto& variable = ast_[ast_.child(comparison, 1 - i)];
      if (constant.kind != NodeKind::kName || variable.kind != NodeKind::kName) continue;
      const auto sort = sort_of_variable(subject_.typed, ast_.name(variable));
      const auto names = sort ? constants_of(subject_.typed, *sort) : std::vector<std::string>();
      const bool known = std::find(names.begin(), names.end(), ast_.name(constant)) != names.end();
      if (!known || names.size() > kMostAdded) continue;
      for (const auto& name : names) replace({constant.begin, constant.end}, name, 2);
    }
  }

  /// Each part of a conjunction or disjunction goes with the sign beside it.
  void drop_parts(const Node& node) {
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      const auto own = extent(ast_.child(node, i));
      const auto gone = i + 1 < node.child_count
                            ? TextExtent{own.begin, extent(ast_.child(node, i + 1)).begin}
                            : TextExtent{extent(ast_.child(node, i - 1)).end, own.end};
      rewrite(gone, "", 2, "without `" + text_of(own) + "`");
    }
  }

  /// `A & B` becomes `A | B`, and the reverse: one sign of a formula, or all of several. A part
  /// that has the other sign is as it was, with or without parentheses.
  void exchange_signs(const Node& node) {
    const std::string other = node.op == Operator::kAnd ? "|" : "&";
    const std::string place = " in the place of `" + std::string(spelling(node.op)) + "`";
    const bool several = node.child_count > 2;
    const auto begin = extent(ast_.child(node, 0)).begin;
    auto at = begin;
    std::string all;
    for (std::uint32_t i = 0; i + 1 < node.child_count; ++i) {
      const auto left = extent(ast_.child(node, i));
      const auto sign = sign_behind(left.end, spelling(node.op).front());
      rewrite({sign, sign + 1}, other, kOtherSign + (several ? 1 : 0),
              "with `" + other + "`" + place + " behind `" + text_of(left) + "`");
      all += text_of({at, sign}) + other;
      at = sign + 1;
    }
    const auto end = extent(ast_.child(node, node.child_count - 1)).end;
    if (several) {
      rewrite({begin, end}, all + text_of({at, end}), kOtherSign, "with `" + other + "`" + place);
    }
  }

  /// The place of the sign. A comment in front of it may have the same character.
  std::uint32_t sign_behind(std::uint32_t at, char sign) const {
    for (bool comment = false; comment || text_[at] != sign; ++at) {
      comment = (comment || text_[at] == ';') && text_[at] != '\n';
    }
    return at;
  }

  /// `whole` is the atom, or its negation.
  void edit_literal(NodeId whole, NodeId atom, const std::vector<SortedVariable>& variables) {
    const TextExtent all{ast_[whole].begin, ast_[whole].end};
    const TextExtent inner{ast_[atom].begin, ast_[atom].end};
    replace(all, whole == atom ? "!" + text_of(inner) : text_of(inner), 3);
    auto term = ast_[atom];
    if (ast_.name(term) == "HoldsAt") term = ast_[ast_.child(term, 0)];
    const auto symbol = subject_.typed.find_symbol(ast_.name(term));
    if (term.kind != NodeKind::kApply || !symbol) return;
    const auto& sorts = subject_.typed.symbols[*symbol].arguments;
    if (sorts.size() != term.child_count) return;
    for (std::uint32_t i = 0; i < term.child_count; ++i) {
      const auto& argument = ast_[ast_.child(term, i)];
      const auto instead = [&](const std::string& text, int oddity) {
        rewrite({argument.begin, argument.end}, text, oddity,
                "with `" + text + "` in the place of `" + text_of({argument.begin, argument.end}) +
                    "` in `" + text_of(inner) + "`");
      };
      for (const auto& variable : variables) {
        if (subject_.typed.sorts_overlap(variable.sort, sorts[i])) instead(variable.name, 2);
      }
      const auto constants = constants_of(subject_.typed, sorts[i]);
      if (constants.size() > kMostAdded || ast_.name(term) == defined_) continue;
      for (const auto& name : constants) instead(name, 4);
    }
    for (const auto& other : subject_.typed.symbols) {
      if (other.kind != subject_.typed.symbols[*symbol].kind || other.arguments != sorts) continue;
      if (other.kind != SymbolKind::kFluent || other.name == ast_.name(term)) continue;
      if (ast_.name(term) == defined_ || other.name == defined_) continue;
      replace({term.begin, term.begin + term.name_length}, other.name, 3);
    }
  }

  /// `A -> B` under one more condition; `F <-> B` with a further part of B; any other formula only
  /// where something holds.
  void add_conditions(const Node& root, const std::vector<SortedVariable>& variables) {
    if (const auto defined = definiens(root)) add_inner_conditions(*defined, variables);
    for (const auto& literal : condition_literals(subject_.typed, variables, kMostAdded)) {
      if (!subject_.relevance.around_some_step(literal, false, true)) continue;
      if (literal.symbol == defined_ && !defined_.empty()) continue;
      const auto text = print(literal, form_.time, form_.variables);
      const int oddity = 4 + subject_.relevance.oddity(literal, "");
      const auto words = "only if `" + text + "`";
      if (root.kind == NodeKind::kBinary && root.op == Operator::kIff) {
        const auto defined = definiens(root);
        if (!defined) continue;
        const auto old = bound(*defined);
        rewrite(extent(*defined), old + " & " + text, oddity, words);
        rewrite(extent(*defined), old + " | " + text, oddity + 1, "also if `" + text + "`");
        replace(extent(*defined), text, oddity + 1);
      } else if (form_.condition) {
        rewrite(extent(*form_.condition), bound(*form_.condition) + " & " + text, oddity, words);
      } else {
        rewrite(body_, text + " -> " + bound(form_.body), oddity, words);
      }
    }
  }

  /// `F <-> {x} B` with a further part of B that mentions x.
  void add_inner_conditions(NodeId defined, const std::vector<SortedVariable>& variables) {
    const auto& node = ast_[defined];
    if (node.kind != NodeKind::kExists) return;
    std::vector<std::string> inner_names;
    for (std::uint32_t i = 0; i + 1 < node.child_count; ++i) {
      inner_names.emplace_back(ast_.name(ast_[ast_.child(node, i)]));
    }
    auto all = variables;
    const auto inner = sorted(inner_names);
    all.insert(all.end(), inner.begin(), inner.end());
    auto taken = form_.variables;
    taken.insert(taken.end(), inner_names.begin(), inner_names.end());
    const auto body = ast_.child(node, node.child_count - 1);
    for (const auto& literal : condition_literals(subject_.typed, all, kMostAdded)) {
      const bool of_inner = std::any_of(
          literal.arguments.begin(), literal.arguments.end(), [&](const auto& argument) {
            return argument.kind == LiteralArgument::Kind::kVariable &&
                   std::find(inner_names.begin(), inner_names.end(), argument.name) !=
                       inner_names.end();
          });
      if (!of_inner || (literal.symbol == defined_ && !defined_.empty())) continue;
      const auto text = print(literal, form_.time, taken);
      const auto old = bound(body);
      if (old.find(text) != std::string::npos) continue;
      rewrite(extent(body), old + " & " + text, 4 + subject_.relevance.oddity(literal, ""),
              "only if `" + text + "`");
    }
  }

  /// The side of a definition that is not the defined fluent.
  std::optional<NodeId> definiens(const Node& root) const {
    if (root.kind != NodeKind::kBinary || root.op != Operator::kIff) return std::nullopt;
    for (const std::uint32_t i : {0U, 1U}) {
      const auto one = ast_.child(root, i), other = ast_.child(root, 1 - i);
      if (ast_[one].kind == NodeKind::kApply) return other;
    }
    return std::nullopt;
  }

  /// The text of a formula that binds as strongly as a literal.
  std::string bound(NodeId node) const {
    const auto at = extent(node);
    const bool whole = at.begin != ast_[node].begin || ast_[node].kind == NodeKind::kApply ||
                       ast_[node].kind == NodeKind::kUnary ||
                       (ast_[node].kind == NodeKind::kBinary &&
                        (is_comparison(ast_[node].op) || ast_[node].op == Operator::kAnd));
    return whole ? text_of(at) : "(" + text_of(at) + ")";
  }

  const EditSubject& subject_;
  const std::size_t axiom_;
  const AxiomForm& form_;
  const Ast& ast_;
  const std::string_view text_;  // of the file, up to the formula's end
  const TextExtent body_;
  std::string defined_;  // its symbol; empty: the formula is no definition
  std::vector<Edit>& out_;
};

}  // namespace

void add_state_edits(const EditSubject& subject, std::vector<Edit>& edits) {
  for (std::size_t i = 0; i < subject.forms.size(); ++i) {
    if (subject.forms[i].kind != AxiomForm::Kind::kState) continue;
    StateFormulaEdits(subject, i, edits).edit();
  }
}

void add_start_edits(const EditSubject& subject, std::vector<Edit>& edits) {
  for (std::size_t i = 0; i < subject.forms.size(); ++i) {
    if (subject.forms[i].kind != AxiomForm::Kind::kStart) continue;
    StateFormulaEdits(subject, i, edits).edit();
  }
}

}  // namespace parallax::compiler
