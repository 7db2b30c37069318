#include <cstddef>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/lint/rules.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

/// Looks through the trees of one file. On the syntax tree, as the typed model has lost where a
/// variable was written.
class VariableUse {
 public:
  VariableUse(const Ast& ast, base::DiagnosticSink& sink) : ast_(ast), sink_(sink) {}

  void check(NodeId root) {
    stack_ = {{root, false}};
    while (!stack_.empty()) {
      const Step step = stack_.back();
      stack_.pop_back();
      const Node& node = ast_[step.node];
      const bool quantifier = node.kind == NodeKind::kForall || node.kind == NodeKind::kExists;
      if (step.leaving) {
        close(node);
      } else if (quantifier) {
        open(step.node, node);
      } else if (node.kind == NodeKind::kName) {
        const auto found = scope_.find(ast_.name(node));
        if (found != scope_.end() && !found->second.empty()) found->second.back() = true;
      } else {
        for (auto i = node.child_count; i-- > 0;) stack_.push_back({ast_.child(node, i), false});
      }
    }
  }

 private:
  struct Step {
    NodeId node;
    bool leaving = false;
  };

  void open(NodeId id, const Node& node) {
    for (std::uint32_t i = 0; i + 1 < node.child_count; ++i) {
      scope_[ast_.name(ast_[ast_.child(node, i)])].push_back(false);
    }
    stack_.push_back({id, true});
    stack_.push_back({ast_.child(node, node.child_count - 1), false});
  }

  void close(const Node& node) {
    for (auto i = node.child_count - 1; i-- > 0;) {
      const Node& variable = ast_[ast_.child(node, i)];
      auto& used = scope_[ast_.name(variable)];
      if (!used.back()) {
        sink_.warning(DiagnosticCode::kUnusedVariable, ast_.source(variable),
                      shortened(ast_.name(variable)));
      }
      used.pop_back();
    }
  }

  const Ast& ast_;
  base::DiagnosticSink& sink_;
  std::vector<Step> stack_;
  std::unordered_map<std::string_view, std::vector<bool>> scope_;  // innermost last; look-up only
};

}  // namespace

void find_unused_variables(const LintContext& context) {
  for (const auto& file : context.ast().files) {
    if (file.built_in) continue;
    VariableUse use(file.ast, context.sink());
    for (const auto& statement : file.ast.statements()) {
      if (statement.kind == StatementKind::kFormula) use.check(statement.formula);
    }
  }
}

}  // namespace parallax::compiler
