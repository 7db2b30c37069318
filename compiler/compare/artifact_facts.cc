#include "compiler/compare/artifact_facts.h"

#include <optional>

#include "compiler/compare/canonical_formula.h"
#include "compiler/syntax/parser.h"

namespace parallax::compiler {
namespace {

/// The text of an origin, canonical if it is a formula with at most a label before it.
std::string canonical(const std::string& text) {
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

std::string clause_count(std::size_t count) {
  return " (" + std::to_string(count) + (count == 1 ? " clause)" : " clauses)");
}

}  // namespace

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
  std::vector<std::size_t> clauses(model.origins.size(), 0);
  for (const auto origin : model.clause_origins) ++clauses[origin];
  for (std::size_t i = 0; i < model.origins.size(); ++i) {
    const auto& origin = model.origins[i];
    if (clauses[i] == 0) continue;
    const auto key = origin.what + ": " + canonical(origin.text);
    facts.push_back({FactKind::kAxiom,
                     key,
                     key + clause_count(clauses[i]),
                     origin.what + ": " + origin.text + clause_count(clauses[i]),
                     {origin.place.file, origin.place.begin.line}});
  }
  return facts;
}

}  // namespace parallax::compiler
