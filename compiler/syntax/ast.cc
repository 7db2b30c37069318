#include "compiler/syntax/ast.h"

#include <utility>

#include "compiler/base/contract.h"

namespace parallax::compiler {

std::optional<Operator> temporal_operator(std::string_view word) {
  const auto op = kOperatorSigns.find(word);
  return op && is_temporal(*op) ? op : std::nullopt;
}

NodeId Ast::add(Node node) {
  const auto index = node_count_++;
  if ((index & (kChunkSize - 1)) == 0) chunks_.push_back(std::make_unique<Node[]>(kChunkSize));
  chunks_.back()[index & (kChunkSize - 1)] = node;
  return NodeId(static_cast<std::uint32_t>(index));
}

NodeId Ast::add(Node node, const NodeId* children, std::size_t count) {
  return add_with(node, count, [children](std::size_t i) { return children[i]; });
}

std::uint32_t Ast::add_item(const Item& item) {
  items_.push_back(item);
  return static_cast<std::uint32_t>(items_.size() - 1);
}

std::uint32_t Ast::add_bounds(const SortBounds& bounds) {
  bounds_.push_back(bounds);
  return static_cast<std::uint32_t>(bounds_.size() - 1);
}

bool same_tree(const Ast& a, NodeId a_root, const Ast& b, NodeId b_root) {
  std::vector<std::pair<NodeId, NodeId>> visit = {{a_root, b_root}};
  while (!visit.empty()) {
    const auto [left, right] = visit.back();
    visit.pop_back();
    const Node& x = a[left];
    const Node& y = b[right];
    if (x.kind != y.kind || x.child_count != y.child_count || a.name(x) != b.name(y)) return false;
    const bool has_operator = x.kind == NodeKind::kUnary || x.kind == NodeKind::kBinary;
    if (has_operator && x.op != y.op) return false;
    for (std::uint32_t i = 0; i < x.child_count; ++i) {
      visit.emplace_back(a.child(x, i), b.child(y, i));
    }
  }
  return true;
}

}  // namespace parallax::compiler
