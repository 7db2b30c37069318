#include "compiler/repair/edit_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

/// The blanks that the line of `at` begins with.
std::string indentation(std::string_view text, std::uint32_t at) {
  auto begin = at;
  while (begin > 0 && text[begin - 1] != '\n') --begin;
  auto end = begin;
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t')) ++end;
  return std::string(text.substr(begin, end - begin));
}

std::size_t line_length(std::string_view text, std::uint32_t at) {
  auto begin = at, end = at;
  while (begin > 0 && text[begin - 1] != '\n') --begin;
  while (end < text.size() && text[end] != '\n') ++end;
  return end - begin;
}

/// Behind `condition ->` begins a new line, as the formatter does it.
std::string wrapped_axiom(const std::string& quantifier, const std::string& condition,
                          const std::string& effect) {
  auto line = quantifier + (quantifier.empty() ? "" : " ");
  if (!condition.empty()) line += condition + " -> ";
  if (line.size() + effect.size() < kLineWidth || condition.empty()) return line + effect + ".";
  return quantifier + "\n  " + condition + " ->\n    " + effect + ".";
}

/// One axiom for each of several effects, as other readers of the language require.
std::string axiom_for_each(const std::string& quantifier, const std::string& condition,
                           const std::string& effects) {
  constexpr std::string_view kAnd = " & ";
  std::string out;
  for (std::size_t begin = 0; begin < effects.size();) {
    const auto end = std::min(effects.find(kAnd, begin), effects.size());
    out += (out.empty() ? "" : "\n") +
           wrapped_axiom(quantifier, condition, effects.substr(begin, end - begin));
    begin = end + kAnd.size();
  }
  return out;
}

std::string list(const std::vector<std::string>& names) {
  std::string out;
  for (const auto& name : names) out += (out.empty() ? "" : ",") + name;
  return out;
}

/// Moves text that is inserted into a deleted part to the place of that part.
std::vector<TextChange> without_nesting(std::vector<TextChange> changes) {
  std::vector<bool> inside(changes.size(), false);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const auto& added = changes[i];
    for (auto& around : changes) {
      if (added.begin != added.end || around.file != added.file || !around.text.empty()) continue;
      if (added.begin <= around.begin || added.begin >= around.end) continue;
      // A new axiom begins with a line's end, and what goes takes its own with it.
      around.text = added.text.substr(added.text.find_first_not_of('\n')) + "\n";
      inside[i] = true;
    }
  }
  std::vector<TextChange> out;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (!inside[i]) out.push_back(std::move(changes[i]));
  }
  return out;
}

/// Cuts a formula that is named beside its place.
std::string cut_formula(std::string formula) {
  constexpr std::size_t kMost = 90;
  if (formula.size() <= kMost) return formula;
  return formula.substr(0, kMost) + "...";
}

/// The event of a new axiom.
std::string of_event(const Edit& edit) {
  const auto end = edit.variables.begin() + static_cast<std::ptrdiff_t>(edit.event_arity);
  return edit.event + "(" + list({edit.variables.begin(), end}) + ")";
}

}  // namespace

std::vector<ConditionLiteral> literals_in(const ModelAst& model,
                                          const std::vector<AxiomForm>& forms, const Edit& edit,
                                          std::size_t axiom) {
  if (!edit.literal) return {};
  if (edit.kind != Edit::Kind::kNarrowEvent) return {*edit.literal};
  const auto& form = forms[axiom];
  const auto& ast = model.ast(form.place);
  std::map<std::string, std::string> names;
  const auto& event = ast[form.event];
  for (std::size_t i = 0; i < edit.variables.size() && i < event.child_count; ++i) {
    names[edit.variables[i]] = print_formula(ast, ast.child(event, static_cast<std::uint32_t>(i)));
  }
  std::vector<ConditionLiteral> out = {renamed(*edit.literal, names)};
  if (edit.or_else) out.push_back(renamed(*edit.or_else, names));
  return out;
}

std::string literal_in(const ModelAst& model, const std::vector<AxiomForm>& forms, const Edit& edit,
                       std::size_t axiom) {
  const auto& form = forms[axiom];
  const auto literals = literals_in(model, forms, edit, axiom);
  if (literals.empty()) return edit.text;
  auto out = print(literals.front(), form.time, form.variables);
  if (literals.size() == 1) return out;
  return "(" + out + " | " + print(literals.back(), form.time, form.variables) + ")";
}

std::string EditText::place(std::size_t axiom) const {
  return files_.place({ast(axiom).file(), forms_[axiom].begin, forms_[axiom].end});
}

TextChange EditText::add_condition(std::size_t axiom, const std::string& condition) const {
  const auto& form = forms_[axiom];
  const auto& tree = ast(axiom);
  const auto text = files_[tree.file()].text();
  const auto root = form.condition.value_or(form.head);
  const auto extent = with_parentheses(text, tree[root], form.begin, form.end);
  if (!form.condition) return {tree.file(), extent.begin, extent.begin, condition + " -> "};
  const auto& node = tree[*form.condition];
  const bool bound =
      node.kind != NodeKind::kBinary || node.op == Operator::kAnd || extent.begin != node.begin;
  const bool is_quantified = (node.kind == NodeKind::kExists || node.kind == NodeKind::kForall) &&
                             extent.begin == node.begin;
  if (!bound || is_quantified) {
    const auto old = std::string(text.substr(extent.begin, extent.end - extent.begin));
    return {tree.file(), extent.begin, extent.end, "(" + old + ") & " + condition};
  }
  const bool on_lines =
      text.substr(extent.begin, extent.end - extent.begin).find('\n') != std::string_view::npos;
  const bool too_long = line_length(text, extent.end) + condition.size() + 3 > kLineWidth;
  auto between = std::string(" & ");
  if (on_lines) between = " &\n" + indentation(text, extent.end);
  if (!on_lines && too_long) {
    const auto indent = indentation(text, extent.end);
    between = " &\n" + (indent.empty() ? "  " : indent);
  }
  return {tree.file(), extent.end, extent.end, between + condition};
}

TextChange EditText::drop_condition(std::size_t axiom, NodeId node) const {
  const auto& form = forms_[axiom];
  const auto& tree = ast(axiom);
  const auto text = files_[tree.file()].text();
  const auto extent = [&](NodeId id) {
    return with_parentheses(text, tree[id], form.begin, form.end);
  };
  const auto at = std::find(form.conjuncts.begin(), form.conjuncts.end(), node);
  const auto own = extent(node);
  if (form.conjuncts.size() == 1) {
    return {tree.file(), own.begin, extent(form.head).begin, ""};
  }
  if (at + 1 != form.conjuncts.end()) {
    return {tree.file(), own.begin, extent(*(at + 1)).begin, ""};
  }
  return {tree.file(), extent(*(at - 1)).end, own.end, ""};
}

TextChange EditText::drop_axiom(std::size_t axiom) const {
  const auto& form = forms_[axiom];
  const auto text = files_[ast(axiom).file()].text();
  auto begin = form.begin, end = form.end;
  while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t' || text[end] == '\r')) ++end;
  const bool whole_lines =
      (begin == 0 || text[begin - 1] == '\n') && (end == text.size() || text[end] == '\n');
  if (!whole_lines) return {ast(axiom).file(), form.begin, form.end, ""};
  if (end < text.size()) ++end;
  return {ast(axiom).file(), begin, end, ""};
}

TextChange EditText::add_axiom(const std::string& event, std::string text) const {
  const AxiomForm* behind = nullptr;
  for (const auto& form : forms_) {
    if (form.event_symbol == event) behind = &form;
  }
  if (behind != nullptr) {
    return {model_.ast(behind->place).file(), behind->end, behind->end, "\n" + text};
  }
  // Nothing is said of the event: at the end of the file that declares it.
  for (const auto& place : model_.order) {
    const auto& statement = model_.statement(place);
    const auto& tree = model_.ast(place);
    if (statement.kind != StatementKind::kConstructor || tree.text(statement.name) != event) {
      continue;
    }
    const auto* last = last_statement(place);
    const auto whole = files_[model_.ast(*last).file()].text();
    const auto& end = model_.statement(*last);
    const auto at = end.kind == StatementKind::kFormula ? end_of_formula(whole, end.source.end)
                                                        : end.source.end;
    return {model_.ast(*last).file(), at, at, "\n\n" + text};
  }
  return {};
}

/// The last statement of the file of `place`; if that file is shared, the last formula about
/// events, or else any statement, in one that is not.
const ModelAst::Place* EditText::last_statement(const ModelAst::Place& place) const {
  const auto is_shared = [&](const ModelAst::Place& at) {
    return shared_.contains(model_.ast(at).file().index());
  };
  const ModelAst::Place* own = &place;
  const ModelAst::Place* other_file = nullptr;
  for (const auto& other : model_.order) {
    if (other.file == place.file) own = &other;
    if (!model_.files[other.file].built_in && !is_shared(other)) other_file = &other;
  }
  if (!is_shared(place)) return own;
  for (const auto& form : forms_) {
    if (!form.event_symbol.empty() && !is_shared(form.place)) other_file = &form.place;
  }
  return other_file != nullptr ? other_file : own;
}

std::string EditText::new_axiom(const Edit& effect, const std::vector<std::size_t>& chosen,
                                std::size_t number, bool wrapped) const {
  std::string condition;
  for (const auto& literal : effect.given) {
    condition += (condition.empty() ? "" : " & ") + print(literal, "time", effect.variables);
  }
  for (const auto i : chosen) {
    if (edits_[i].kind != Edit::Kind::kAddCondition || edits_[i].of != number) continue;
    condition +=
        (condition.empty() ? "" : " & ") + print(*edits_[i].literal, "time", edits_[i].variables);
  }
  auto variables = effect.variables;
  variables.emplace_back("time");
  const auto quantifier = "[" + list(variables) + "]";
  if (wrapped) return axiom_for_each(quantifier, condition, effect.text);
  return (condition.empty() ? "" : condition + " -> ") + effect.text;
}

std::vector<TextChange> EditText::changes(const std::vector<std::size_t>& chosen) const {
  std::vector<TextChange> out;
  for (const auto i : chosen) {
    const auto& edit = edits_[i];
    switch (edit.kind) {
      case Edit::Kind::kNarrow:
      case Edit::Kind::kNarrowEvent:
        for (const auto axiom : edit.axioms) {
          out.push_back(add_condition(axiom, literal_in(model_, forms_, edit, axiom)));
        }
        break;
      case Edit::Kind::kRequire: {
        auto variables = edit.variables;
        variables.emplace_back("time");
        const auto event = edit.event + "(" + list(edit.variables) + ")";
        out.push_back(add_axiom(
            edit.event, wrapped_axiom("[" + list(variables) + "]", "Happens(" + event + ",time)",
                                      print(*edit.literal, "time", edit.variables))));
        break;
      }
      case Edit::Kind::kDropCondition:
        out.push_back(drop_condition(edit.axioms.front(), edit.node));
        break;
      case Edit::Kind::kDropAxiom:
        out.push_back(drop_axiom(edit.axioms.front()));
        break;
      case Edit::Kind::kReplace: {
        const auto& tree = ast(edit.axioms.front());
        out.push_back({tree.file(), tree[edit.node].begin, tree[edit.node].end, edit.text});
        break;
      }
      case Edit::Kind::kAddEffect:
      case Edit::Kind::kAddTrigger:
        out.push_back(add_axiom(edit.event, new_axiom(edit, chosen, i, true)));
        break;
      case Edit::Kind::kDelay: {
        const auto& form = forms_[edit.axioms.front()];
        std::string text;
        for (const auto& late : edit.sentences) {
          text += (text.empty() ? "" : "\n") +
                  wrapped_axiom("[" + list(late.variables) + "]", late.condition, late.effect);
        }
        out.push_back({ast(edit.axioms.front()).file(), form.begin, form.end, std::move(text)});
        break;
      }
      case Edit::Kind::kRewrite:
      case Edit::Kind::kAddFact:
        out.push_back(edit.change);
        break;
      case Edit::Kind::kOpenEvent:
        for (const auto& [axiom, node] : edit.nodes) {
          const auto& tree = ast(axiom);
          out.push_back({tree.file(), tree[node].begin, tree[node].begin + tree[node].name_length,
                         "Releases"});
        }
        break;
      case Edit::Kind::kAddCondition:
        break;  // told with its effect
    }
  }
  return without_nesting(std::move(out));
}

std::string EditText::words(const std::vector<std::size_t>& chosen) const {
  std::vector<std::string> out;
  for (const auto i : chosen) {
    const auto& edit = edits_[i];
    const auto event = edit.event + "(" + list(edit.variables) + ")";
    const auto axiom = [&] {
      const auto& tree = ast(edit.axioms.front());
      const auto& form = forms_[edit.axioms.front()];
      const bool of_states =
          form.kind == AxiomForm::Kind::kState || form.kind == AxiomForm::Kind::kStart;
      return fmt::format("`{}` ({})",
                         cut_formula(print_formula(tree, of_states ? form.body : form.head)),
                         place(edit.axioms.front()));
    };
    const auto node = [&] { return print_formula(ast(edit.axioms.front()), edit.node); };
    switch (edit.kind) {
      case Edit::Kind::kNarrow:
        out.push_back(fmt::format("{} only if `{}`", axiom(),
                                  literal_in(model_, forms_, edit, edit.axioms.front())));
        break;
      case Edit::Kind::kNarrowEvent: {
        auto condition = print(*edit.literal, "time", edit.variables);
        if (edit.or_else) condition += " | " + print(*edit.or_else, "time", edit.variables);
        const auto all = std::count_if(forms_.begin(), forms_.end(), [&](const AxiomForm& form) {
          return form.kind == AxiomForm::Kind::kEffects && form.event_symbol == edit.event;
        });
        const auto some = std::ssize(edit.axioms);
        out.push_back(some == 1 ? fmt::format("{} only if `{}`", axiom(), condition)
                      : some < all
                          ? fmt::format("`{}` does what {} of its {} axioms say only if `{}`",
                                        event, some, all, condition)
                          : fmt::format("`{}` does what its {} axioms say only if `{}`", event,
                                        some, condition));
        break;
      }
      case Edit::Kind::kRequire:
        out.push_back(fmt::format("`{}` can happen only if `{}`", event,
                                  print(*edit.literal, "time", edit.variables)));
        break;
      case Edit::Kind::kDropCondition:
        out.push_back(fmt::format("{} also without the condition `{}`", axiom(), node()));
        break;
      case Edit::Kind::kDropAxiom:
        out.push_back(fmt::format("{} is dropped", axiom()));
        break;
      case Edit::Kind::kReplace:
        out.push_back(fmt::format("in the axiom at {}, `{}` becomes `{}`",
                                  place(edit.axioms.front()), node(), edit.text));
        break;
      case Edit::Kind::kAddEffect:
        out.push_back(
            edit.words.empty()
                ? fmt::format("an effect is missing: `{}`", new_axiom(edit, chosen, i, false))
                : fmt::format("`{}` {}, effects that are missing: `{}`", of_event(edit), edit.words,
                              new_axiom(edit, chosen, i, false)));
        break;
      case Edit::Kind::kAddTrigger:
        out.push_back(fmt::format("a trigger is missing: `{}`", new_axiom(edit, chosen, i, false)));
        break;
      case Edit::Kind::kRewrite:
        out.push_back(fmt::format("{} {}", axiom(), edit.words));
        break;
      case Edit::Kind::kAddFact:
        out.push_back(fmt::format(
            "{}: `{}`", edit.words.empty() ? "a fact of the start is missing" : edit.words,
            edit.text));
        break;
      case Edit::Kind::kDelay: {
        const auto& first = edit.sentences.front();
        if (!edit.words.empty()) {
          out.push_back(fmt::format("{} {}: `{}{}{}`", axiom(), edit.words,
                                    cut_formula(first.condition),
                                    first.condition.empty() ? "" : " -> ", first.effect));
          break;
        }
        out.push_back(fmt::format(
            "{} comes later, with what happens then: `{} -> {}`{}", axiom(),
            cut_formula(first.condition), first.effect,
            edit.sentences.size() > 1
                ? fmt::format(", and likewise for {} more events", edit.sentences.size() - 1)
                : ""));
        break;
      }
      case Edit::Kind::kOpenEvent:
        out.push_back(fmt::format("what `{}` does is open: `Releases` in {} of its axioms", event,
                                  edit.axioms.size()));
        break;
      case Edit::Kind::kAddCondition:
        break;
    }
  }
  return fmt::format("{}", fmt::join(out, "; and "));
}

}  // namespace parallax::compiler
