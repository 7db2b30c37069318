#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/base/id.h"
#include "compiler/base/result.h"
#include "compiler/syntax/ast.h"
#include "compiler/syntax/parser.h"

namespace parallax::compiler {

struct ModelValueTag {
  static constexpr bool kOrdered = true;  // order of the locations that bind them first
};
using ModelValueId = base::Id<ModelValueTag>;

/// Meaning of a leaf of a formula. It is fixed when the formula is made, so that a name substituted
/// later cannot be captured by a variable of the same name.
enum class LeafKind : std::uint8_t {
  kName,       // a name of the model: a constant, a number, `time`
  kVariable,   // a quantifier's variable; `number`: index into `variables`
  kParameter,  // a parameter of the binding table; `number`: index into `parameters`
  kRegister,   // a value that the model determines; `number`: index of its ModelValueId
};

struct FormulaNode {
  NodeKind kind = NodeKind::kName;
  Operator op = Operator::kAnd;     // kUnary, kBinary
  LeafKind leaf = LeafKind::kName;  // kName
  std::uint32_t number = 0;
  std::uint32_t begin = 0;  // byte range in the text
  std::uint32_t end = 0;
  std::uint32_t name_length = 0;        // as in Node
  std::vector<std::uint32_t> children;  // of a quantifier: the variables, then the body
  friend auto operator<=>(const FormulaNode&, const FormulaNode&) = default;
};

/// `?p`, or `region(?p)` with its function. A bare `region` has no variable until its entry says
/// which one is meant.
struct FormulaParameter {
  std::string variable;
  std::string function;
  friend auto operator<=>(const FormulaParameter&, const FormulaParameter&) = default;
};

/// A formula or a term of the model as a plan says it: the parsed tree, and the text that its nodes
/// are pieces of, as its author laid it out.
struct FormulaTree {
  std::string text;
  std::vector<FormulaNode> nodes;  // children before parents, leaves as in the text, the root last
  std::vector<std::string> variables;  // names of the quantified variables
  std::vector<FormulaParameter> parameters;

  std::string_view name(const FormulaNode& node) const {
    return std::string_view(text).substr(node.begin, node.name_length);
  }
  friend auto operator<=>(const FormulaTree&, const FormulaTree&) = default;
};

/// Parses a formula (or a term) of the binding table. `text` is the file's text with comments
/// blanked, `range` where the formula stands in it. E10xx; E4001 for a mapping function of anything
/// but a parameter, and for a quantified parameter.
base::Result<FormulaTree> read_formula_tree(const base::SourceRange& range, std::string_view text,
                                            base::DiagnosticSink& sink);

/// A constant or an integer.
FormulaTree constant_term(std::string_view name);
FormulaTree register_term(std::string_view name, ModelValueId id);
/// `name(argument,...)`
FormulaTree application(std::string_view name, std::span<const FormulaTree> arguments);
FormulaTree equal_terms(const FormulaTree& left, const FormulaTree& right);
/// `(a) | (b)`; at least one.
FormulaTree disjunction(std::span<const FormulaTree> formulas);
/// `{i,j} (body)` over names that the body has as leaves.
FormulaTree exists(std::span<const std::string> names, const FormulaTree& body);

/// The formula with some leaves replaced; none: the leaf stays. A replacement is a term without
/// variables and parameters.
using LeafValue = std::function<std::optional<FormulaTree>(const FormulaNode&)>;
FormulaTree with_leaves(const FormulaTree& tree, const LeafValue& value);

/// The same tree over a text without blanks.
FormulaTree without_blanks(const FormulaTree& tree);

/// The registers that it reads.
std::set<ModelValueId> registers_in(const FormulaTree& tree);

/// For the checker: `file` holds the tree's text.
ParsedFormula to_ast(const FormulaTree& tree, base::FileId file, const base::SourceFiles& files);

}  // namespace parallax::compiler
