#include "compiler/compare/model_facts.h"

#include <algorithm>
#include <optional>
#include <set>

#include "compiler/base/words.h"
#include "compiler/compare/canonical_formula.h"
#include "compiler/compare/plan_calls.h"
#include "compiler/syntax/parser.h"
#include "compiler/syntax/printer.h"

namespace parallax::compiler {
namespace {

constexpr std::size_t kMaxFormulaShown = 2000;  // bytes of a formula that are shown

class FactMaker {
 public:
  FactMaker(const Ast& ast, const base::SourceFiles& files, std::vector<Fact>& out)
      : ast_(ast), files_(files), out_(out) {}

  void add(const Statement& statement) {
    switch (statement.kind) {
      case StatementKind::kOption:
        return declare(statement.source, "option " + word(statement.name),
                       " " + word(statement.value));
      case StatementKind::kRange:
        return declare(statement.source, "range " + word(statement.sort),
                       " " + std::to_string(ast_.bounds(statement).lower) + " " +
                           std::to_string(ast_.bounds(statement).upper));
      case StatementKind::kSort:
        return each(statement, "sort ");
      case StatementKind::kReifiedSort:
        return each(statement, "reified sort ");
      case StatementKind::kConstants:
        return each(statement, word(statement.sort) + (statement.additional ? "! " : " "));
      case StatementKind::kConstructor:
        return constructor(statement);
      case StatementKind::kXor:
        return together(statement, "xor ");
      case StatementKind::kMutex:
        return together(statement, "mutex ");
      case StatementKind::kNoninertial:
        return each(statement, "noninertial ");
      case StatementKind::kManualRelease:
        return each(statement, "manualrelease ");
      case StatementKind::kIgnore:
        return each(statement, "ignore ");
      case StatementKind::kCompletion:
      case StatementKind::kLoad:
      case StatementKind::kMinimize:
        return declare(statement.source, print_statement(ast_, statement), "");
      case StatementKind::kFormula:
        return formula(statement);
    }
  }

 private:
  std::string word(const Word& word) const { return std::string(ast_.text(word)); }
  FactPlace place(const Word& source) const {
    const auto& file = files_[ast_.file()];
    return {file.name(), file.position(source.begin).line};
  }

  void declare(const Word& source, const std::string& key, const std::string& rest) {
    out_.push_back({FactKind::kDeclaration, key, key + rest, key + rest, place(source)});
  }
  /// One fact for each name of the list.
  void each(const Statement& statement, const std::string& keyword) {
    for (std::uint32_t i = 0; i < statement.item_count; ++i) {
      const auto& item = ast_.items(statement)[i];
      declare(item.name, keyword + word(item.name),
              item.parent.empty() ? "" : ": " + word(item.parent));
    }
  }
  /// One fact for the whole list, in which order says nothing.
  void together(const Statement& statement, const std::string& keyword) {
    std::set<std::string> names;
    for (std::uint32_t i = 0; i < statement.item_count; ++i) {
      names.insert(word(ast_.items(statement)[i].name));
    }
    std::string list;
    for (const auto& name : names) list += (list.empty() ? "" : ", ") + name;
    declare(statement.source, keyword + list, "");
  }
  void constructor(const Statement& statement) {
    std::string rest = "(";
    for (std::uint32_t i = 0; i < statement.item_count; ++i) {
      rest += (i == 0 ? "" : ",") + word(ast_.items(statement)[i].name);
    }
    rest += statement.value.empty() ? ")" : "): " + word(statement.value);
    declare(statement.source, word(statement.sort) + " " + word(statement.name), rest);
  }
  void formula(const Statement& statement) {
    const auto label = statement.label.empty() ? "" : word(statement.label) + ": ";
    auto shown = label + print_formula(ast_, statement.formula) + ".";
    if (shown.size() > kMaxFormulaShown) shown = shown.substr(0, kMaxFormulaShown) + "...";
    auto text = canonical_formula(ast_, statement.formula);
    // A line that starts with a small letter would be a declaration.
    if (label.empty() && text[0] >= 'a' && text[0] <= 'z') text = "(" + text + ")";
    out_.push_back(
        {FactKind::kAxiom, "", label + text + ".", std::move(shown), place(statement.source)});
  }

  const Ast& ast_;
  const base::SourceFiles& files_;
  std::vector<Fact>& out_;
};

/// The text of an origin, canonical if it is a formula with at most a label before it.
std::string canonical_origin(const std::string& text) {
  const auto attempt = [](const std::string& formula) -> std::optional<std::string> {
    base::SourceFiles files;
    base::DiagnosticSink sink;
    const auto parsed = parse_formula(files.add("axiom", formula), files, sink);
    if (!parsed) return std::nullopt;
    return canonical_formula(parsed->ast, parsed->root);
  };
  if (const auto plain = attempt(text)) return *plain;
  const auto colon = text.find(':');
  if (colon == std::string::npos) return text;
  const auto labelled = attempt(text.substr(colon + 1));
  return labelled ? text.substr(0, colon) + ": " + *labelled : text;
}

void declare(std::vector<Fact>& out, const std::string& key, const std::string& rest) {
  out.push_back({FactKind::kDeclaration, key, key + rest, key + rest, {}});
}

void declare_names(std::vector<Fact>& out, const std::string& kind,
                   const std::vector<GroundName>& names) {
  for (const auto& ground : names) {
    declare(out, kind + ground.name, ground.slot ? "" : " (never)");
  }
}

std::string clause_count(std::size_t count) { return " (" + base::counted(count, "clause") + ")"; }

}  // namespace

std::vector<Fact> text_facts(const Ast& ast, const base::SourceFiles& files) {
  std::vector<Fact> facts;
  FactMaker maker(ast, files, facts);
  for (const auto& statement : ast.statements()) maker.add(statement);
  return facts;
}

std::vector<Fact> model_facts(const ModelAst& model, const base::SourceFiles& files) {
  std::vector<Fact> facts;
  for (const auto& file : model.files) {
    if (!file.built_in) continue;
    const auto text = "load " + files[file.ast.file()].name();
    facts.push_back({FactKind::kDeclaration, text, text, text, {files[file.ast.file()].name(), 0}});
  }
  for (const auto& place : model.order) {
    if (model.files[place.file].built_in) continue;
    FactMaker(model.ast(place), files, facts).add(model.statement(place));
  }
  return facts;
}

std::string canonical_text(const std::vector<Fact>& facts) {
  std::string out;
  for (const auto kind : {FactKind::kDeclaration, FactKind::kAxiom}) {
    std::set<std::string_view> lines;
    for (const auto& fact : facts) {
      if (fact.kind == kind) lines.insert(fact.text);
    }
    for (const auto line : lines) (out += line) += '\n';
  }
  return out;
}

std::vector<Fact> artifact_facts(const CompiledModel& model) {
  std::vector<Fact> facts;
  for (const auto& [name, value] : model.options) declare(facts, "option " + name, " " + value);
  declare(facts, "horizon", " " + std::to_string(model.horizon));
  declare_names(facts, "fluent ", model.fluents);
  declare_names(facts, "event ", model.events);
  for (const auto& atom : model.fixed) {
    if (atom.kind != AtomKind::kPredicate) continue;
    declare(facts, "predicate " + atom.name, atom.time ? " at " + std::to_string(*atom.time) : "");
  }
  const auto calls = plan_calls(model);
  for (const auto& call : calls) {
    const auto key = "call " + call.event;
    const bool is_known =
        std::any_of(facts.begin(), facts.end(), [&](const Fact& fact) { return fact.key == key; });
    if (is_known) continue;
    std::string values;
    for (const auto& [name, value] : call_values(calls, call.event)) {
      values += (values.empty() ? " " : "; ") + name + ' ' + value;
    }
    if (!values.empty()) declare(facts, key, values);
  }
  std::vector<std::size_t> clauses(model.origins.size(), 0);
  for (const auto origin : model.clause_origins) ++clauses[origin];
  for (std::size_t i = 0; i < model.origins.size(); ++i) {
    const auto& origin = model.origins[i];
    if (clauses[i] == 0) continue;
    const auto kind = std::string(to_string(origin.kind)) + ": ";
    const auto key = kind + canonical_origin(origin.text);
    facts.push_back({FactKind::kAxiom,
                     key,
                     key + clause_count(clauses[i]),
                     kind + origin.text + clause_count(clauses[i]),
                     {origin.place.file, origin.place.begin.line}});
  }
  return facts;
}

}  // namespace parallax::compiler
