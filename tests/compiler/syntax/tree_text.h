#pragma once

#include <string>

#include "compiler/syntax/ast.h"

namespace parallax::test {

/// The tree with every operator application in parentheses: shows the shape without using the
/// printer's rules.
inline std::string tree_text(const compiler::Ast& ast, compiler::NodeId id) {
  using compiler::NodeKind;
  const auto& node = ast[id];
  const auto child = [&](std::uint32_t i) { return tree_text(ast, ast.child(node, i)); };
  std::string out;
  switch (node.kind) {
    case NodeKind::kName:
    case NodeKind::kNumber:
      return std::string(ast.name(node));
    case NodeKind::kApply:
      out = std::string(ast.name(node)) + "(";
      for (std::uint32_t i = 0; i < node.child_count; ++i) out += (i != 0 ? "," : "") + child(i);
      return out + ")";
    case NodeKind::kUnary:
      return "(" + std::string(spelling(node.op)) + child(0) + ")";
    case NodeKind::kBinary:
      out = "(" + child(0);
      for (std::uint32_t i = 1; i < node.child_count; ++i) {
        out += std::string(spelling(node.op)) + child(i);
      }
      return out + ")";
    case NodeKind::kForall:
    case NodeKind::kExists: {
      const bool all = node.kind == NodeKind::kForall;
      out = all ? "([" : "({";
      for (std::uint32_t i = 0; i + 1 < node.child_count; ++i)
        out += (i != 0 ? "," : "") + child(i);
      return out + (all ? "]" : "}") + child(node.child_count - 1) + ")";
    }
    case NodeKind::kCount:
    case NodeKind::kSum:
      out = std::string(ast.name(node)) + "{";
      for (std::uint32_t i = 0; i < node.child_count; ++i) {
        out += (i == 0 ? "" : i < node.bound_count() ? "," : ":") + child(i);
      }
      return out + "}";
  }
  return out;
}

}  // namespace parallax::test
