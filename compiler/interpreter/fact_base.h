#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/builtins/plan_value.h"
#include "compiler/interpreter/prolog_terms.h"
#include "compiler/lisp/lisp_reader.h"

namespace parallax::compiler {

/// (<- head goal...) as a template: instances share nothing but the values in it.
struct FactClause {
  DatumId source;
  struct Node {
    enum class Kind : std::uint8_t { kAtom, kPair, kVariable };
    Kind kind = Kind::kAtom;
    std::uint32_t first = 0;  // the value, the head's node, the variable's number
    std::uint32_t second = 0;
  };
  std::vector<Node> nodes;  // parts before wholes
  std::uint32_t variables = 0;
  std::uint32_t head = 0;  // index of its node
  std::vector<std::uint32_t> body;
};

struct ClauseInstance {
  PrologTermId head;
  std::vector<PrologTermId> body;
};
ClauseInstance instance_of(const FactClause& clause, TermStore& terms);

/// The clauses of a plan's `def-fact-group`s, in their written order, by the name of the predicate
/// that they prove. Packages matter only for the functions of the plan that a clause names.
struct FactBase {
  std::map<std::string, std::vector<FactClause>, std::less<>> clauses;
  bool has(std::string_view name) const { return clauses.find(name) != clauses.end(); }
  /// Has it a clause for so many arguments?
  bool has(std::string_view name, std::size_t arguments) const;
};

inline constexpr std::string_view kGroundingRule = "action-grounding";

/// Is it (def-fact-group name (predicate...) clause...)?
bool is_fact_group(const LispData& data, DatumId form);

/// Reads all fact groups; CPL070 for an entry that is no clause.
FactBase read_fact_groups(const LispText& text, ValueStore& values, base::DiagnosticSink& sink);

}  // namespace parallax::compiler
