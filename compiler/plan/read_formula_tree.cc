// A formula of the binding table: its tree, with every name settled.
#include <fmt/core.h>

#include <map>
#include <utility>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/plan/formula_tree.h"

namespace parallax::compiler {
namespace {

bool is_mapping_function(std::string_view name) {
  return name == "region" || name == "place" || name == "gaze";
}

bool is_quantifier(const FormulaNode& node) {
  return node.kind == NodeKind::kForall || node.kind == NodeKind::kExists;
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
    return sink_.error(base::DiagnosticCode::kBindingSyntax,
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
      if (is_quantifier(node)) opening[first[i]].push_back(i);
    }
    Scope scope;
    for (std::uint32_t i = 0; i < out_.nodes.size(); ++i) {
      // The outermost one has the highest number.
      for (auto at = opening[i].rbegin(); at != opening[i].rend(); ++at) {
        if (!open(out_.nodes[*at], scope)) return false;
      }
      auto& node = out_.nodes[i];
      if (is_quantifier(node)) close(node, scope);
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
    for (std::size_t i = 0; i + 1 < quantifier.children.size(); ++i) {
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
    for (std::size_t i = 0; i + 1 < quantifier.children.size(); ++i) {
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

base::Result<FormulaTree> read_formula_tree(const base::SourceRange& range, std::string_view text,
                                            base::DiagnosticSink& sink) {
  const auto parsed = parse_binding_formula(range, text, sink);
  if (!parsed) return sink.already_reported();
  return TreeReader(*parsed, range, text, sink).read();
}

}  // namespace parallax::compiler
