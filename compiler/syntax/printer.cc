#include "compiler/syntax/printer.h"

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

#include "compiler/syntax/precedence.h"

namespace parallax::compiler {
namespace {

constexpr int kNothingFollows = 0;

/// Either a piece of text or a node still to be printed.
struct Task {
  std::string_view text;
  NodeId node;
  bool is_node = false;
  bool parentheses = false;
  /// Binding of the operator right after the node: a prefix that binds weaker than it would
  /// swallow it.
  int follows = kNothingFollows;
};

class FormulaPrinter {
 public:
  FormulaPrinter(const Ast& ast, std::string& out) : ast_(ast), out_(out) {}

  void print(NodeId root) {
    tasks_.push_back({{}, root, true, false, kNothingFollows});
    while (!tasks_.empty()) {
      const Task task = tasks_.back();
      tasks_.pop_back();
      if (task.is_node) {
        expand(task);
      } else {
        out_ += task.text;
      }
    }
  }

 private:
  // Children are pushed in source order and then turned round, as the stack pops the last first.
  void text(std::string_view text) { tasks_.push_back({text, NodeId(), false, false, 0}); }
  void node(NodeId id, bool parentheses, int follows) {
    tasks_.push_back({{}, id, true, parentheses, parentheses ? kNothingFollows : follows});
  }

  void expand(const Task& task) {
    const auto begin = tasks_.size();
    if (task.parentheses) text("(");
    const Node& node = ast_[task.node];
    switch (node.kind) {
      case NodeKind::kName:
      case NodeKind::kNumber:
        text(ast_.name(node));
        break;
      case NodeKind::kApply:
        apply(node);
        break;
      case NodeKind::kUnary:
        unary(node, task.follows);
        break;
      case NodeKind::kBinary:
        binary(node, task.follows);
        break;
      case NodeKind::kForall:
      case NodeKind::kExists:
        quantifier(node, task.follows);
        break;
      case NodeKind::kCount:
      case NodeKind::kSum:
        aggregate(node);
        break;
    }
    if (task.parentheses) text(")");
    std::reverse(tasks_.begin() + static_cast<std::ptrdiff_t>(begin), tasks_.end());
  }

  void apply(const Node& parent) {
    text(ast_.name(parent));
    text("(");
    for (std::uint32_t i = 0; i < parent.child_count; ++i) {
      if (i != 0) text(",");
      node(ast_.child(parent, i), false, kNothingFollows);
    }
    text(")");
  }

  void aggregate(const Node& parent) {
    text(ast_.name(parent));
    text("{");
    for (std::uint32_t i = 0; i < parent.child_count; ++i) {
      if (i != 0) text(i < parent.bound_count() ? "," : ": ");
      node(ast_.child(parent, i), false, kNothingFollows);
    }
    text("}");
  }

  void unary(const Node& parent, int follows) {
    text(spelling(parent.op));
    const auto child = ast_.child(parent, 0);
    const bool weaker =
        ast_[child].kind == NodeKind::kBinary && binding(ast_[child].op) <= binding(parent.op);
    node(child, weaker || swallows(child, follows), follows);
  }

  void quantifier(const Node& parent, int follows) {
    const bool all = parent.kind == NodeKind::kForall;
    text(all ? "[" : "{");
    for (std::uint32_t i = 0; i + 1 < parent.child_count; ++i) {
      if (i != 0) text(",");
      node(ast_.child(parent, i), false, kNothingFollows);
    }
    text(all ? "] " : "} ");
    node(ast_.child(parent, parent.child_count - 1), false, follows);
  }

  void binary(const Node& parent, int follows) {
    const int strength = binding(parent.op);
    const bool spaced = strength < binding(Operator::kEqual);
    for (std::uint32_t i = 0; i < parent.child_count; ++i) {
      const auto child = ast_.child(parent, i);
      const bool last = i + 1 == parent.child_count;
      if (i != 0) {
        if (spaced) text(" ");
        text(spelling(parent.op));
        if (spaced) text(" ");
      }
      const int after = last ? follows : strength;
      node(child, needs_parentheses(parent, child, i == 0) || swallows(child, after), after);
    }
  }

  /// True if `child`, as an operand of `parent`, would be read as something else.
  bool needs_parentheses(const Node& parent, NodeId child_id, bool first) const {
    const Node& child = ast_[child_id];
    if (child.kind != NodeKind::kBinary) return false;
    const int strength = binding(parent.op);
    if (binding(child.op) != strength) return binding(child.op) < strength;
    return !first || is_flat(parent.op) || strength == kComparisonBinding;
  }

  /// True if `child` is a prefix that would take the operator after it into its scope.
  bool swallows(NodeId child_id, int follows) const {
    const Node& child = ast_[child_id];
    if (is_quantifier(child.kind)) return follows > kQuantifierBinding;
    return child.kind == NodeKind::kUnary && follows > binding(child.op);
  }

  const Ast& ast_;
  std::string& out_;
  std::vector<Task> tasks_;
};

void print_items(const Ast& ast, const Statement& statement, std::string& out) {
  const Item* items = ast.items(statement);
  for (std::uint32_t i = 0; i < statement.item_count; ++i) {
    if (i != 0) out += ", ";
    out += ast.text(items[i].name);
    if (!items[i].parent.empty()) (out += ": ") += ast.text(items[i].parent);
  }
}

void print_constructor(const Ast& ast, const Statement& statement, std::string& out) {
  (out += ast.text(statement.name)) += '(';
  for (std::uint32_t i = 0; i < statement.item_count; ++i) {
    if (i != 0) out += ',';
    out += ast.text(ast.items(statement)[i].name);
  }
  out += ')';
  if (!statement.value.empty()) (out += ": ") += ast.text(statement.value);
}

void print_labelled(const Ast& ast, const Statement& statement, std::string& out) {
  if (!statement.label.empty()) (out += ast.text(statement.label)) += ": ";
  std::string formula = print_formula(ast, statement.formula);
  // A lower-case word at the start of a line could be taken for a statement.
  if (statement.label.empty() && formula[0] >= 'a' && formula[0] <= 'z') {
    formula = "(" + formula + ")";
  }
  (out += formula) += '.';
}

void append_statement(const Ast& ast, const Statement& statement, std::string& out) {
  const auto list = [&](std::string_view keyword) {
    out += keyword;
    print_items(ast, statement, out);
  };
  switch (statement.kind) {
    case StatementKind::kOption:
      (((out += "option ") += ast.text(statement.name)) += ' ') += ast.text(statement.value);
      return;
    case StatementKind::kRange:
      ((out += "range ") += ast.text(statement.sort)) += ' ';
      (out += std::to_string(ast.bounds(statement).lower)) += ' ';
      out += std::to_string(ast.bounds(statement).upper);
      return;
    case StatementKind::kSort:
      return list("sort ");
    case StatementKind::kReifiedSort:
      return list("reified sort ");
    case StatementKind::kXor:
      return list("xor ");
    case StatementKind::kMutex:
      return list("mutex ");
    case StatementKind::kNoninertial:
      return list("noninertial ");
    case StatementKind::kManualRelease:
      return list("manualrelease ");
    case StatementKind::kIgnore:
      return list("ignore ");
    case StatementKind::kConstants:
    case StatementKind::kConstructor:
      out += ast.text(statement.sort);
      out += statement.additional ? "! " : " ";
      if (statement.kind == StatementKind::kConstants) return print_items(ast, statement, out);
      return print_constructor(ast, statement, out);
    case StatementKind::kCompletion:
      out += "completion ";
      if (!statement.label.empty()) (out += ast.text(statement.label)) += ' ';
      out += ast.text(statement.name);
      return;
    case StatementKind::kLoad:
      (out += "load ") += ast.text(statement.value);
      return;
    case StatementKind::kMinimize:
      (out += "minimize ") += ast.text(statement.value);
      return;
    case StatementKind::kFormula:
      return print_labelled(ast, statement, out);
  }
}

}  // namespace

std::string print_formula(const Ast& ast, NodeId root) {
  std::string out;
  FormulaPrinter(ast, out).print(root);
  return out;
}

std::string print_statement(const Ast& ast, const Statement& statement) {
  std::string out;
  append_statement(ast, statement, out);
  return out;
}

std::string print_file(const Ast& ast) {
  std::string out;
  for (const auto& statement : ast.statements()) {
    append_statement(ast, statement, out);
    out += '\n';
  }
  return out;
}

}  // namespace parallax::compiler
