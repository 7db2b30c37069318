// One text for all ways of writing a formula that differ in layout, names and order only.
//
// The tree is built without brackets, nested connectives and quantifiers of one kind being one
// node. Operands of commutative operators are sorted by their texts. These contain names of
// bound variables, which must not matter: a variable is therefore first told apart by the text
// of the whole formula in which it alone is marked, all others being called by their sort; the
// rank of that text is its name while operands are sorted. In the end variables are numbered in
// order of occurrence. Variables that the marks do not tell apart keep the order of the text, as
// the general problem is graph isomorphism.
//
// Cost: the text is written once for each variable, so size * depth * variables; beyond a limit
// operands keep their order.

#include "compiler/compare/canonical_formula.h"

#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/syntax/precedence.h"

namespace parallax::compiler {
namespace {

/// A node of the tree without brackets: nested `&`, `|` and quantifiers of one kind are one node.
struct Canonical {
  NodeKind kind = NodeKind::kName;
  Operator op = Operator::kAnd;
  std::string_view name;
  std::optional<std::size_t> variable;  // of a bound name
  std::vector<std::size_t> bound;       // quantifiers
  std::vector<std::size_t> children;    // greater than the index of this node
};

std::string_view sort_of(std::string_view variable) {
  while (!variable.empty() && variable.back() >= '0' && variable.back() <= '9') {
    variable.remove_suffix(1);
  }
  return variable;
}

bool is_commutative(const Canonical& node) {
  if (node.kind != NodeKind::kBinary) return false;
  return node.op == Operator::kAnd || node.op == Operator::kOr || node.op == Operator::kIff ||
         node.op == Operator::kEqual || node.op == Operator::kNotEqual;
}

/// Builds the tree, parents before children, and says which variable each name is.
class TreeBuilder {
 public:
  TreeBuilder(const Ast& ast, NodeId root) : ast_(ast) { push(root, kNone); }

  void run() {
    while (!tasks_.empty()) {
      const auto task = tasks_.back();
      tasks_.pop_back();
      if (task.leaves) {
        scopes_[ast_.name(ast_[task.node])].pop_back();
      } else {
        enter(task.node, task.parent);
      }
    }
  }

  std::vector<Canonical> nodes;
  std::vector<std::string_view> sorts;  // by variable
  std::size_t depth = 0;

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  struct Task {
    NodeId node;
    std::size_t parent = kNone;
    bool leaves = false;  // ends the scope of the variable `node`
  };

  void push(NodeId node, std::size_t parent) { tasks_.push_back({node, parent, false}); }

  void enter(NodeId id, std::size_t parent) {
    const auto& node = ast_[id];
    const auto index = place(node, parent);
    if (node.bound_count() > 0) return enter_scope(node, index);
    if (node.kind == NodeKind::kName) return resolve(nodes[index]);
    for (std::uint32_t i = node.child_count; i > 0; --i) push(ast_.child(node, i - 1), index);
  }

  /// The index of the node that stands for this one: its parent's if the two are one.
  std::size_t place(const Node& node, std::size_t parent) {
    if (parent != kNone) {
      const auto& above = nodes[parent];
      const bool joins =
          node.kind == NodeKind::kBinary && (node.op == Operator::kAnd || node.op == Operator::kOr);
      if (above.kind == node.kind && (is_quantifier(node.kind) || (joins && above.op == node.op))) {
        return parent;
      }
      nodes[parent].children.push_back(nodes.size());
    }
    Canonical made;
    made.kind = node.kind;
    made.op = node.op;
    if (node.name_length != 0) made.name = ast_.name(node);
    nodes.push_back(std::move(made));
    levels_.push_back(parent == kNone ? 1 : levels_[parent] + 1);
    depth = std::max(depth, levels_.back());
    return nodes.size() - 1;
  }

  void enter_scope(const Node& node, std::size_t index) {
    for (std::uint32_t i = 0; i < node.bound_count(); ++i) {
      const auto variable = ast_.child(node, i);
      const auto name = ast_.name(ast_[variable]);
      nodes[index].bound.push_back(sorts.size());
      scopes_[name].push_back(sorts.size());
      sorts.push_back(sort_of(name));
      tasks_.push_back({variable, kNone, true});
    }
    for (auto i = node.child_count; i-- > node.bound_count();) push(ast_.child(node, i), index);
  }

  void resolve(Canonical& node) const {
    const auto scope = scopes_.find(node.name);
    if (scope != scopes_.end() && !scope->second.empty()) node.variable = scope->second.back();
  }

  const Ast& ast_;
  std::vector<Task> tasks_;
  std::vector<std::size_t> levels_;
  std::unordered_map<std::string_view, std::vector<std::size_t>> scopes_;  // look-up only
};

/// Connectives hold comparisons, and comparisons hold arithmetic, without brackets.
int level(Operator op) {
  if (binding(op) < binding(Operator::kEqual)) return 0;
  return binding(op) <= kComparisonBinding ? 1 : 2;
}

/// Would `child` be read otherwise below `parent` if it stood without brackets?
bool needs_brackets(const Canonical& parent, const Canonical& child) {
  if (is_quantifier(parent.kind) || is_aggregate(parent.kind) || parent.kind == NodeKind::kApply) {
    return false;
  }
  if (is_quantifier(child.kind)) return true;
  if (child.kind == NodeKind::kUnary) {
    return parent.kind == NodeKind::kBinary && level(parent.op) != 0;
  }
  if (child.kind != NodeKind::kBinary) return false;
  return parent.kind == NodeKind::kUnary || level(child.op) <= level(parent.op);
}

class CanonicalWriter {
 public:
  using Naming = std::function<std::string(std::size_t)>;

  explicit CanonicalWriter(TreeBuilder tree)
      : nodes_(std::move(tree.nodes)), sorts_(std::move(tree.sorts)) {}

  /// Texts of all nodes bottom up. `sorts_operands`: commutative ones in the order of their texts,
  /// which then is the order of `children`.
  std::string write(const Naming& name, bool sorts_operands) {
    std::vector<std::string> texts(nodes_.size());
    for (auto i = nodes_.size(); i-- > 0;) {
      auto& node = nodes_[i];
      if (sorts_operands && is_commutative(node)) {
        // Among equals the order of the text counts, as indices follow it.
        std::sort(node.children.begin(), node.children.end(), [&](std::size_t a, std::size_t b) {
          const int order = texts[a].compare(texts[b]);
          return order != 0 ? order < 0 : a < b;
        });
      }
      texts[i] = text_of(node, texts, name);
      for (const auto child : node.children) std::string().swap(texts[child]);
    }
    return std::move(texts[0]);
  }

  /// Variables are told apart by the formula in which they alone are marked; remaining ties are
  /// broken by the order of the text.
  void sort_operands() {
    std::vector<std::string> marked(sorts_.size());
    for (std::size_t v = 0; v < sorts_.size(); ++v) {
      marked[v] = write([&](std::size_t u) { return u == v ? "@" : std::string(sorts_[u]); }, true);
    }
    std::map<std::string_view, std::size_t> ranks;
    for (const auto& text : marked) ranks.emplace(text, 0);
    std::size_t next = 0;
    for (auto& [text, rank] : ranks) rank = ++next;
    std::vector<std::string> names;
    for (std::size_t v = 0; v < sorts_.size(); ++v) {
      names.push_back(std::string(sorts_[v]) + std::to_string(ranks.at(marked[v])));
    }
    write([&](std::size_t v) { return names[v]; }, true);
  }

  /// Numbers the variables in order of occurrence, those that nothing uses last, in order of their
  /// quantifiers.
  std::string finish() {
    numbers_.assign(sorts_.size(), 0);
    std::map<std::string_view, std::size_t> used;
    const auto number = [&](std::size_t v) {
      if (numbers_[v] == 0) numbers_[v] = ++used[sorts_[v]];
    };
    std::vector<std::size_t> order, todo = {0};
    while (!todo.empty()) {
      order.push_back(todo.back());
      const auto& node = nodes_[todo.back()];
      todo.pop_back();
      if (node.variable) number(*node.variable);
      todo.insert(todo.end(), node.children.rbegin(), node.children.rend());
    }
    for (const auto i : order) {
      for (const auto v : nodes_[i].bound) number(v);
    }
    for (auto& node : nodes_) {
      std::sort(node.bound.begin(), node.bound.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(sorts_[a], numbers_[a]) < std::pair(sorts_[b], numbers_[b]);
      });
    }
    return write(
        [&](std::size_t v) { return std::string(sorts_[v]) + std::to_string(numbers_[v]); }, false);
  }

 private:
  std::string text_of(const Canonical& node, const std::vector<std::string>& texts,
                      const Naming& name) const {
    std::string out;
    const auto operand = [&](std::size_t child) {
      const bool brackets = needs_brackets(node, nodes_[child]);
      if (brackets) out += '(';
      out += texts[child];
      if (brackets) out += ')';
    };
    switch (node.kind) {
      case NodeKind::kName:
        return node.variable ? name(*node.variable) : std::string(node.name);
      case NodeKind::kNumber:
        return std::string(node.name);
      case NodeKind::kUnary:
        out = spelling(node.op);
        operand(node.children[0]);
        return out;
      case NodeKind::kApply:
      case NodeKind::kBinary:
        break;
      case NodeKind::kForall:
      case NodeKind::kExists:
        return (node.kind == NodeKind::kForall ? "[" : "{") + names_of(node, name) +
               (node.kind == NodeKind::kForall ? "] " : "} ") + texts[node.children[0]];
      case NodeKind::kCount:
      case NodeKind::kSum:
        (out += node.name) += "{" + names_of(node, name);
        for (const auto child : node.children) out += ": " + texts[child];
        return out + "}";
    }
    const bool applied = node.kind == NodeKind::kApply;
    if (applied) (out += node.name) += '(';
    const bool spaced = !applied && level(node.op) == 0;
    for (std::size_t i = 0; i < node.children.size(); ++i) {
      if (i != 0) {
        if (spaced) out += ' ';
        out += applied ? "," : spelling(node.op);
        if (spaced) out += ' ';
      }
      operand(node.children[i]);
    }
    if (applied) out += ')';
    return out;
  }

  /// The order of the variables says nothing.
  static std::string names_of(const Canonical& node, const Naming& name) {
    std::vector<std::string> names;
    for (const auto variable : node.bound) names.push_back(name(variable));
    std::sort(names.begin(), names.end());
    std::string out;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (i != 0) out += ',';
      out += names[i];
    }
    return out;
  }

  std::vector<Canonical> nodes_;
  std::vector<std::string_view> sorts_;  // by variable
  std::vector<std::size_t> numbers_;     // by variable
};

}  // namespace

std::string canonical_formula(const Ast& ast, NodeId root) {
  TreeBuilder tree(ast, root);
  tree.run();
  const auto& node = ast[root];
  const std::size_t bytes = node.end - node.begin;
  // Files have at most 2^32 bytes and trees are much less deep, so the first product fits.
  const bool sorts = bytes * tree.depth <= kCanonicalWork / (tree.sorts.size() + 2);
  CanonicalWriter writer(std::move(tree));
  if (sorts) writer.sort_operands();
  return writer.finish();
}

}  // namespace parallax::compiler
