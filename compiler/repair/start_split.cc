#include "compiler/repair/start_split.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "compiler/base/ground_name.h"
#include "compiler/repair/condition_literal.h"
#include "compiler/repair/edit_grammar.h"
#include "compiler/repair/edit_text.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

/// Names of the model that stand for constants, and the other way round.
using Names = std::map<std::string, std::string>;

std::string holds_at(const std::string& fluent, const std::string& time) {
  return "HoldsAt(" + fluent + "," + time + ")";
}

/// A ground atom with other names for some of its arguments.
std::string lifted(const std::string& ground, const Names& terms) {
  std::string list;
  for (const auto& argument : arguments_of(ground)) {
    const auto found = terms.find(argument);
    list += (list.empty() ? "" : ",") + (found == terms.end() ? argument : found->second);
  }
  return base::symbol_of(ground) + "(" + list + ")";
}

bool has_word(const std::string& text, const std::string& word) {
  const auto is_part = [&](std::size_t at) {
    return at < text.size() &&
           (std::isalnum(static_cast<unsigned char>(text[at])) != 0 || text[at] == '_');
  };
  for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
    if ((at == 0 || !is_part(at - 1)) && !is_part(at + word.size())) return true;
  }
  return false;
}

/// The conjuncts of a condition, as the formatter puts those that are too long for a line.
std::string one_a_line(const std::string& condition) {
  std::string out;
  int depth = 0;
  for (std::size_t i = 0; i < condition.size(); ++i) {
    const char c = condition[i];
    if (c == '(') ++depth;
    if (c == ')') --depth;
    out += c;
    if (c != '&' || depth > 0) continue;
    out += "\n ";
  }
  return out;
}

/// `[v] condition -> effect.` with those of the variables that occur.
std::string axiom_text(const std::vector<std::string>& variables, const std::string& time,
                       const std::string& condition, const std::string& effect) {
  std::string list;
  for (const auto& variable : variables) {
    if (variable != time && has_word(condition + " " + effect, variable)) list += variable + ",";
  }
  const auto quantifier = "[" + list + time + "]";
  const auto line = quantifier + " " + condition + " -> " + effect + ".";
  if (line.size() <= kLineWidth) return line;
  const auto lines = condition.size() + 5 > kLineWidth ? one_a_line(condition) : condition;
  return quantifier + "\n  " + lines + " ->\n    " + effect + ".";
}

class PartWriter {
 public:
  PartWriter(const ModelAst& model, const TypedModel& typed, const base::SourceFiles& files,
             const std::vector<AxiomForm>& forms, const std::vector<StartFluent>& part,
             const PartStep& step)
      : model_(model), typed_(typed), files_(files), forms_(forms), part_(part), step_(step) {}

  PartEffects write() {
    find_refuted();
    narrow();
    add_missing();
    return std::move(out_);
  }

 private:
  /// An axiom whose effect did not come.
  struct Refuted {
    std::size_t axiom = 0;
    Names terms;         // constants of the event, by the axiom's variables
    std::size_t in = 0;  // number of runs
  };

  const Ast& ast(std::size_t axiom) const { return model_.ast(forms_[axiom].place); }

  /// Values of the axiom's variables if it is about this very event.
  std::optional<Names> values(std::size_t axiom) const {
    const auto& form = forms_[axiom];
    if (form.kind != AxiomForm::Kind::kEffects) return std::nullopt;
    if (form.event_symbol != base::symbol_of(step_.event)) return std::nullopt;
    const auto& event = ast(axiom)[form.event];
    const auto arguments = arguments_of(step_.event);
    if (event.child_count != arguments.size()) return std::nullopt;
    Names out;
    for (std::uint32_t i = 0; i < event.child_count; ++i) {
      const auto name = print_formula(ast(axiom), ast(axiom).child(event, i));
      const auto& variables = form.variables;
      if (std::find(variables.begin(), variables.end(), name) == variables.end()) {
        if (name != arguments[i]) return std::nullopt;
        continue;
      }
      if (!fits(name, arguments[i])) return std::nullopt;
      const auto [at, fresh] = out.emplace(name, arguments[i]);
      if (!fresh && at->second != arguments[i]) return std::nullopt;
    }
    return out;
  }

  bool fits(const std::string& variable, const std::string& constant) const {
    const auto sort = sort_of_variable(typed_, variable);
    if (!sort) return false;
    const auto all = constants_of(typed_, *sort);
    return std::find(all.begin(), all.end(), constant) != all.end();
  }

  /// Does the axiom deny this observation?
  bool denies(std::size_t axiom, const Names& values, const std::string& fluent,
              bool observed) const {
    const auto& tree = ast(axiom);
    for (const auto effect : forms_[axiom].effects) {
      const auto kind = tree.name(tree[effect]);
      if (kind != (observed ? "Terminates" : "Initiates")) continue;
      const auto& node = tree[effect_parts(tree, effect)->fluent];
      std::string pattern = std::string(tree.name(node)) + "(";
      for (std::uint32_t i = 0; i < node.child_count; ++i) {
        const auto name = print_formula(tree, tree.child(node, i));
        const auto found = values.find(name);
        const auto& variables = forms_[axiom].variables;
        const bool open = std::find(variables.begin(), variables.end(), name) != variables.end();
        pattern += (i == 0 ? "" : ",") + (found != values.end() ? found->second
                                          : open                ? "*"
                                                                : name);
      }
      if (matches(fluent, pattern + ")")) return true;
    }
    return false;
  }

  void find_refuted() {
    for (std::size_t i = 0; i < forms_.size(); ++i) {
      const auto known = values(i);
      if (!known) continue;
      Refuted refuted{i, {}, 0};
      for (const auto& [variable, constant] : *known) refuted.terms.emplace(constant, variable);
      for (const auto& run : step_.differing) {
        bool any = false;
        for (const auto& [fluent, observed] : run) {
          if (!denies(i, *known, fluent, observed)) continue;
          explained_.insert({fluent, observed});
          any = true;
        }
        refuted.in += any ? 1 : 0;
      }
      if (refuted.in > 0) refuted_.push_back(std::move(refuted));
    }
  }

  std::string inside(const Names& terms, const std::string& time) const {
    std::string out;
    for (const auto& fluent : part_) {
      out += (out.empty() ? "" : " & ") + holds_at(lifted(fluent.ground(), terms), time);
    }
    return out;
  }

  std::string outside(const Names& terms, const std::string& time) const {
    const auto text = inside(terms, time);
    return part_.size() == 1 ? "!" + text : "!(" + text + ")";
  }

  void narrow() {
    std::vector<Edit> edits;
    std::vector<std::size_t> chosen;
    for (const auto& refuted : refuted_) {
      const auto& form = forms_[refuted.axiom];
      Edit edit;
      edit.kind = Edit::Kind::kNarrow;
      edit.axioms = {refuted.axiom};
      edit.text = outside(refuted.terms, form.time);
      chosen.push_back(edits.size());
      edits.push_back(std::move(edit));
      if (refuted.in < step_.differing.size()) continue;
      out_.not_there.push_back(print_formula(ast(refuted.axiom), form.head));
    }
    if (!edits.empty()) out_.changes = EditText(model_, files_, forms_, edits).changes(chosen);
    for (const auto& refuted : refuted_) {
      if (refuted.in < step_.differing.size()) leave_open(refuted);
    }
  }

  /// Condition of the axiom, to be continued by another one; empty: it has none.
  std::string condition_of(std::size_t axiom) const {
    const auto& form = forms_[axiom];
    if (!form.condition) return {};
    const auto text = print_formula(ast(axiom), *form.condition);
    const auto& node = ast(axiom)[*form.condition];
    const bool is_loose =
        node.kind == NodeKind::kForall || node.kind == NodeKind::kExists ||
        (node.kind == NodeKind::kBinary &&
         (node.op == Operator::kOr || node.op == Operator::kImplies || node.op == Operator::kIff));
    return (is_loose ? "(" + text + ")" : text) + " & ";
  }

  void leave_open(const Refuted& refuted) {
    const auto& form = forms_[refuted.axiom];
    const auto& tree = ast(refuted.axiom);
    for (const auto effect : form.effects) {
      auto text = print_formula(tree, effect);
      text = "Releases" + text.substr(text.find('('));
      add_behind(refuted.axiom,
                 axiom_text(form.variables, form.time,
                            condition_of(refuted.axiom) + inside(refuted.terms, form.time), text));
      out_.open.push_back(text);
    }
  }

  void add_behind(std::size_t axiom, const std::string& text) {
    out_.changes.push_back({ast(axiom).file(), forms_[axiom].end, forms_[axiom].end, "\n" + text});
  }

  /// Adds effects that the model lacks there: differences that no axiom denied.
  void add_missing() {
    std::map<std::pair<std::string, bool>, std::size_t> missing;
    for (const auto& run : step_.differing) {
      for (const auto& [fluent, observed] : run) {
        if (!explained_.contains({fluent, observed})) ++missing[{fluent, observed}];
      }
    }
    if (missing.empty()) return;
    std::vector<std::string> ended;  // conditions of what comes instead
    Names terms;
    std::vector<std::string> variables;
    name_arguments(step_.event, terms, variables);
    for (const auto& [what, runs] : missing) {
      if (what.second) continue;
      name_arguments(what.first, terms, variables);
      ended.push_back(what.first);
    }
    for (const auto& [what, runs] : missing) {
      const bool always = runs == step_.differing.size();
      const auto& [fluent, observed] = what;
      const std::string kind = !always ? "Releases" : observed ? "Initiates" : "Terminates";
      const auto* like = observed ? narrowed_like(fluent) : nullptr;
      if (like != nullptr) {
        const auto& form = forms_[like->axiom];
        const auto event = print_formula(ast(like->axiom), form.event);
        const auto effect =
            fmt::format("{}({},{},{})", kind, event, lifted(fluent, like->terms), form.time);
        add_behind(like->axiom,
                   axiom_text(form.variables, form.time,
                              condition_of(like->axiom) + inside(like->terms, form.time), effect));
        out_.added.push_back(effect);
        continue;
      }
      auto condition = inside(terms, "time");
      for (const auto& other : ended) {
        if (other != fluent) condition += " & " + holds_at(lifted(other, terms), "time");
      }
      const auto effect =
          fmt::format("{}({},{},time)", kind, lifted(step_.event, terms), lifted(fluent, terms));
      add_at_end(axiom_text(variables, "time", condition, effect));
      out_.added.push_back(effect);
    }
  }

  /// Variables for the constants of an atom that have none yet, called by their sorts.
  void name_arguments(const std::string& ground, Names& terms,
                      std::vector<std::string>& variables) const {
    const auto symbol = typed_.find_symbol(base::symbol_of(ground));
    if (!symbol) return;
    const auto& sorts = typed_.symbols[*symbol].arguments;
    const auto arguments = arguments_of(ground);
    for (std::size_t i = 0; i < arguments.size() && i < sorts.size(); ++i) {
      if (terms.contains(arguments[i])) continue;
      const auto& sort = typed_.sorts[sorts[i]].name;
      auto name = sort;
      for (int n = 1; std::find(variables.begin(), variables.end(), name) != variables.end(); ++n) {
        name = sort + std::to_string(n);
      }
      variables.push_back(name);
      terms.emplace(arguments[i], name);
    }
  }

  /// The refuted axiom whose conditions apply to an effect that came instead: one that initiates
  /// the same symbol, else the first.
  const Refuted* narrowed_like(const std::string& fluent) const {
    for (const auto& refuted : refuted_) {
      const auto& tree = ast(refuted.axiom);
      for (const auto effect : forms_[refuted.axiom].effects) {
        const auto parts = effect_parts(tree, effect);
        if (tree.name(tree[effect]) != "Initiates") continue;
        if (tree.name(tree[parts->fluent]) == base::symbol_of(fluent)) return &refuted;
      }
    }
    return refuted_.empty() ? nullptr : &refuted_.front();
  }

  /// Adds the text after what is said of the event, else at the end of the last file.
  void add_at_end(const std::string& text) {
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < forms_.size(); ++i) {
      if (forms_[i].event_symbol == base::symbol_of(step_.event)) last = i;
    }
    if (last) return add_behind(*last, text);
    for (auto place = model_.order.rbegin(); place != model_.order.rend(); ++place) {
      if (model_.files[place->file].built_in) continue;
      const auto& tree = model_.ast(*place);
      const auto end =
          end_of_formula(files_[tree.file()].text(), model_.statement(*place).source.end);
      out_.changes.push_back({tree.file(), end, end, "\n" + text});
      return;
    }
  }

  const ModelAst& model_;
  const TypedModel& typed_;
  const base::SourceFiles& files_;
  const std::vector<AxiomForm>& forms_;
  const std::vector<StartFluent>& part_;
  const PartStep& step_;
  std::vector<Refuted> refuted_;
  std::set<std::pair<std::string, bool>> explained_;
  PartEffects out_;
};

}  // namespace

std::string unused_symbol(const TypedModel& typed, const std::string& wanted) {
  auto name = wanted;
  for (int n = 2; typed.find_symbol(name).has_value(); ++n) name = wanted + std::to_string(n);
  return name;
}

TextChange declare(const StartFluent& fluent, const ModelAst& model, const TypedModel& typed,
                   const base::SourceFiles& files) {
  const ModelAst::Place* last = nullptr;
  for (const auto& place : model.order) {
    const auto& statement = model.statement(place);
    if (statement.kind != StatementKind::kConstructor || model.files[place.file].built_in) continue;
    const auto symbol = typed.find_symbol(model.ast(place).text(statement.name));
    if (symbol && typed.symbols[*symbol].kind == SymbolKind::kFluent) last = &place;
  }
  if (last == nullptr) return {};
  auto text = fmt::format("\n\n; {}\nfluent {}({})", fluent.means, fluent.name, fluent.sort);
  const auto sort = typed.find_sort(fluent.sort);
  if (sort && constants_of(typed, *sort).size() > 1) {
    text += fmt::format("\n[{0}] {0}!={1} -> !HoldsAt({2}({0}),0).", fluent.sort, fluent.constant,
                        fluent.name);
  }
  const auto file = model.ast(*last).file();
  const auto end = model.statement(*last).source.end;
  const auto rest = files[file].text().substr(end);
  const bool stands_alone = rest.empty() || rest.starts_with("\n\n") || rest == "\n";
  return {file, end, end, text + (stands_alone ? "" : "\n")};
}

PartEffects effects_in_part(const ModelAst& model, const TypedModel& typed,
                            const base::SourceFiles& files, const std::vector<AxiomForm>& forms,
                            const std::vector<StartFluent>& part, const PartStep& step) {
  return PartWriter(model, typed, files, forms, part, step).write();
}

}  // namespace parallax::compiler
