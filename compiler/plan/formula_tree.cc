#include "compiler/plan/formula_tree.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "compiler/base/ascii.h"
#include "compiler/base/codes/plans.h"
#include "compiler/plan/binding_text.h"

namespace parallax::compiler {
namespace {

std::uint32_t length(std::string_view text) { return static_cast<std::uint32_t>(text.size()); }

FormulaTree leaf(std::string_view name, NodeKind kind, LeafKind stands_for, std::uint32_t number) {
  FormulaTree tree;
  tree.text = name;
  FormulaNode node;
  node.kind = kind;
  node.leaf = stands_for;
  node.number = number;
  node.end = length(name);
  node.name_length = length(name);
  tree.nodes.push_back(std::move(node));
  return tree;
}

/// Adds text and nodes of `part` to `out`; its root's place.
std::uint32_t append(FormulaTree& out, const FormulaTree& part) {
  const auto offset = length(out.text);
  const auto before = static_cast<std::uint32_t>(out.nodes.size());
  const auto variables = static_cast<std::uint32_t>(out.variables.size());
  const auto parameters = static_cast<std::uint32_t>(out.parameters.size());
  out.text += part.text;
  for (auto node : part.nodes) {
    node.begin += offset;
    node.end += offset;
    for (auto& child : node.children) child += before;
    if (node.leaf == LeafKind::kVariable) node.number += variables;
    if (node.leaf == LeafKind::kParameter) node.number += parameters;
    out.nodes.push_back(std::move(node));
  }
  out.variables.insert(out.variables.end(), part.variables.begin(), part.variables.end());
  out.parameters.insert(out.parameters.end(), part.parameters.begin(), part.parameters.end());
  return static_cast<std::uint32_t>(out.nodes.size()) - 1;
}

/// A node over the whole text so far.
void add_root(FormulaTree& tree, NodeKind kind, Operator op, std::vector<std::uint32_t> children) {
  FormulaNode node;
  node.kind = kind;
  node.op = op;
  node.end = length(tree.text);
  node.children = std::move(children);
  tree.nodes.push_back(std::move(node));
}

bool is_mapping_function(std::string_view name) {
  return name == "region" || name == "place" || name == "gaze";
}

/// How many of the first children are variables that the node binds.
std::size_t bound_count(const FormulaNode& node) {
  if (node.kind == NodeKind::kSum) return node.children.size() - 2;
  return is_quantifier(node.kind) || node.kind == NodeKind::kCount ? node.children.size() - 1 : 0;
}

class TreeReader {
 public:
  TreeReader(const ParsedFormula& parsed, const base::SourceRange& range, std::string_view text,
             base::DiagnosticSink& sink)
      : ast_(parsed.ast), root_(parsed.root), range_(range), sink_(sink) {
    out_.text = text.substr(range.begin, range.end - range.begin);
  }

  base::Result<FormulaTree> read() && {
    // The parser adds the nodes of its one formula children first.
    for (std::uint32_t i = 0; i <= root_.index(); ++i) {
      if (!add(ast_[NodeId(i)])) return sink_.already_reported();
    }
    if (!bind_variables()) return sink_.already_reported();
    for (auto& node : out_.nodes) {
      if (node.kind == NodeKind::kName && node.leaf == LeafKind::kName &&
          is_mapping_function(out_.name(node))) {
        make_parameter(node, {{}, std::string(out_.name(node))});
      }
    }
    return std::move(out_);
  }

 private:
  base::Reported refuse(const FormulaNode& node, const char* wanted, const std::string& found) {
    const auto begin = range_.begin + node.begin;
    return sink_.error(codes::kBindingSyntax,
                       base::SourceRange{range_.file, begin, begin + node.name_length}, wanted,
                       found);
  }

  void make_parameter(FormulaNode& node, FormulaParameter parameter) {
    node.leaf = LeafKind::kParameter;
    node.number = static_cast<std::uint32_t>(out_.parameters.size());
    out_.parameters.push_back(std::move(parameter));
  }

  bool add(const Node& from) {
    FormulaNode node;
    node.kind = from.kind;
    node.op = from.op;
    node.begin = from.begin - range_.begin;
    node.end = from.end - range_.begin;
    node.name_length = from.name_length;
    for (std::uint32_t i = 0; i < from.child_count; ++i) {
      node.children.push_back(places_[ast_.child(from, i).index()]);
    }
    const auto name = ast_.name(from);
    if (node.kind == NodeKind::kName && name.starts_with('?')) {
      make_parameter(node, {std::string(name), {}});
    }
    if (node.kind == NodeKind::kApply && is_mapping_function(name)) return add_mapped(node);
    keep(std::move(node));
    return true;
  }

  void keep(FormulaNode node) {
    places_.push_back(static_cast<std::uint32_t>(out_.nodes.size()));
    out_.nodes.push_back(std::move(node));
  }

  /// `region(?p)` is one leaf.
  bool add_mapped(FormulaNode& node) {
    const bool one = node.children.size() == 1 && node.children[0] + 1 == out_.nodes.size() &&
                     out_.nodes.back().leaf == LeafKind::kParameter &&
                     out_.parameters[out_.nodes.back().number].function.empty();
    if (!one) {
      refuse(node, "one variable as the argument of a mapping function", "something else");
      return false;
    }
    const auto number = out_.nodes.back().number;
    out_.parameters[number].function = out_.name(node);
    out_.nodes.pop_back();
    node.kind = NodeKind::kName;
    node.leaf = LeafKind::kParameter;
    node.number = number;
    node.name_length = node.end - node.begin;
    node.children.clear();
    keep(std::move(node));
    return true;
  }

  /// Every use of a quantified variable learns which one it is. The nodes below a quantifier stand
  /// right before it, so that one pass over them opens and closes the scopes.
  bool bind_variables() {
    std::vector<std::uint32_t> first(out_.nodes.size());  // node below each that comes first
    std::vector<std::vector<std::uint32_t>> opening(out_.nodes.size());
    for (std::uint32_t i = 0; i < out_.nodes.size(); ++i) {
      const auto& node = out_.nodes[i];
      first[i] = node.children.empty() ? i : first[node.children.front()];
      if (bound_count(node) > 0) opening[first[i]].push_back(i);
    }
    Scope scope;
    for (std::uint32_t i = 0; i < out_.nodes.size(); ++i) {
      // The outermost one has the highest number.
      for (auto at = opening[i].rbegin(); at != opening[i].rend(); ++at) {
        if (!open(out_.nodes[*at], scope)) return false;
      }
      auto& node = out_.nodes[i];
      close(node, scope);
      if (node.kind != NodeKind::kName || node.leaf != LeafKind::kName) continue;
      const auto bound = scope.find(out_.name(node));
      if (bound == scope.end() || bound->second.empty()) continue;
      node.leaf = LeafKind::kVariable;
      node.number = bound->second.back();
    }
    return true;
  }

  using Scope = std::map<std::string, std::vector<std::uint32_t>, std::less<>>;
  bool open(const FormulaNode& quantifier, Scope& scope) {
    for (std::size_t i = 0; i < bound_count(quantifier); ++i) {
      const auto& variable = out_.nodes[quantifier.children[i]];
      const std::string name(out_.name(variable));
      if (variable.leaf == LeafKind::kParameter) {
        refuse(variable, "the name of a quantified variable", fmt::format("`{}`", name));
        return false;
      }
      scope[name].push_back(static_cast<std::uint32_t>(out_.variables.size()));
      out_.variables.push_back(name);
    }
    return true;
  }
  void close(const FormulaNode& quantifier, Scope& scope) {
    for (std::size_t i = 0; i < bound_count(quantifier); ++i) {
      scope[std::string(out_.name(out_.nodes[quantifier.children[i]]))].pop_back();
    }
  }

  const Ast& ast_;
  NodeId root_;
  base::SourceRange range_;
  base::DiagnosticSink& sink_;
  FormulaTree out_;
  std::vector<std::uint32_t> places_;  // by node of the Ast
};

}  // namespace

FormulaTree constant_term(std::string_view name) {
  const bool negative = name.starts_with('-');
  const auto plain = name.substr(negative ? 1 : 0);
  const bool number = !plain.empty() && plain.front() >= '0' && plain.front() <= '9';
  if (!negative || !number) {
    return leaf(name, number ? NodeKind::kNumber : NodeKind::kName, LeafKind::kName, 0);
  }
  FormulaTree tree;
  tree.text = "-";
  const auto digits = append(tree, leaf(plain, NodeKind::kNumber, LeafKind::kName, 0));
  add_root(tree, NodeKind::kUnary, Operator::kNegate, {digits});
  return tree;
}

FormulaTree register_term(std::string_view name, ModelValueId id) {
  return leaf(name, NodeKind::kName, LeafKind::kRegister, id.index());
}

FormulaTree application(std::string_view name, std::span<const FormulaTree> arguments) {
  FormulaTree tree;
  tree.text = std::string(name) + "(";
  std::vector<std::uint32_t> children;
  for (const auto& argument : arguments) {
    if (!children.empty()) tree.text += ',';
    children.push_back(append(tree, argument));
  }
  tree.text += ')';
  add_root(tree, NodeKind::kApply, Operator::kAnd, std::move(children));
  tree.nodes.back().name_length = length(name);
  return tree;
}

FormulaTree equal_terms(const FormulaTree& left, const FormulaTree& right) {
  FormulaTree tree;
  const auto first = append(tree, left);
  tree.text += '=';
  const auto second = append(tree, right);
  add_root(tree, NodeKind::kBinary, Operator::kEqual, {first, second});
  return tree;
}

FormulaTree disjunction(std::span<const FormulaTree> formulas) {
  FormulaTree tree;
  std::vector<std::uint32_t> children;
  for (const auto& formula : formulas) {
    tree.text += children.empty() ? "(" : " | (";
    children.push_back(append(tree, formula));
    tree.text += ')';
  }
  if (children.size() > 1) {
    add_root(tree, NodeKind::kBinary, Operator::kOr, std::move(children));
  }
  return tree;
}

FormulaTree exists(std::span<const std::string> names, const FormulaTree& body) {
  FormulaTree tree;
  std::vector<std::uint32_t> children;
  for (const auto& name : names) {
    tree.text += children.empty() ? "{" : ",";
    children.push_back(append(tree, leaf(name, NodeKind::kName, LeafKind::kName, 0)));
  }
  tree.text += "} (";
  children.push_back(append(tree, body));
  tree.text += ')';
  add_root(tree, NodeKind::kExists, Operator::kAnd, std::move(children));
  return tree;
}

FormulaTree with_leaves(const FormulaTree& tree, const LeafValue& value) {
  FormulaTree out;
  out.variables = tree.variables;
  out.parameters = tree.parameters;
  // Leaves come in the order of the text, so it is copied up to each of them; the text between two
  // of them moves together. A node comes behind its leaves: both its ends are known then.
  struct Move {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
  };
  std::vector<Move> moves = {{0, 0}};
  const auto moved = [&](std::uint32_t at) {
    const auto behind =
        std::upper_bound(moves.begin(), moves.end(), at,
                         [](std::uint32_t place, const Move& move) { return place < move.from; });
    const auto& last = *(behind - 1);
    return at - last.from + last.to;
  };
  std::vector<std::uint32_t> renumbered;
  std::uint32_t copied = 0;
  for (const auto& node : tree.nodes) {
    const auto part = node.kind == NodeKind::kName ? value(node) : std::nullopt;
    if (part) {
      out.text.append(tree.text, copied, node.begin - copied);
      moves.push_back({node.begin, length(out.text)});
      renumbered.push_back(append(out, *part));
      moves.push_back({node.end, length(out.text)});
      copied = node.end;
      continue;
    }
    auto copy = node;
    for (auto& child : copy.children) child = renumbered[child];
    copy.begin = moved(node.begin);
    copy.end = moved(node.end);
    renumbered.push_back(static_cast<std::uint32_t>(out.nodes.size()));
    out.nodes.push_back(std::move(copy));
  }
  out.text.append(tree.text, copied);
  return out;
}

FormulaTree without_blanks(const FormulaTree& tree) {
  auto out = tree;
  out.text.clear();
  std::vector<std::uint32_t> moved;
  for (const char c : tree.text) {
    moved.push_back(length(out.text));
    if (!base::is_space(c)) out.text += c;
  }
  moved.push_back(length(out.text));
  for (auto& node : out.nodes) {
    node.begin = moved[node.begin];
    node.end = moved[node.end];
  }
  return out;
}

std::set<ModelValueId> registers_in(const FormulaTree& tree) {
  std::set<ModelValueId> out;
  for (const auto& node : tree.nodes) {
    if (node.leaf == LeafKind::kRegister) out.insert(ModelValueId(node.number));
  }
  return out;
}

ParsedFormula to_ast(const FormulaTree& tree, base::FileId file, const base::SourceFiles& files) {
  ParsedFormula out{Ast(file, files[file].text()), NodeId()};
  std::vector<NodeId> ids;
  for (const auto& from : tree.nodes) {
    Node node;
    node.kind = from.kind;
    node.op = from.op;
    node.begin = from.begin;
    node.end = from.end;
    node.name_length = from.name_length;
    ids.push_back(out.ast.add_with(node, from.children.size(),
                                   [&](std::size_t i) { return ids[from.children[i]]; }));
  }
  out.root = ids.back();
  return out;
}

base::Result<FormulaTree> read_formula_tree(const base::SourceRange& range, std::string_view text,
                                            base::DiagnosticSink& sink) {
  const auto parsed = parse_binding_formula(range, text, sink);
  if (!parsed) return sink.already_reported();
  return TreeReader(*parsed, range, text, sink).read();
}

}  // namespace parallax::compiler
