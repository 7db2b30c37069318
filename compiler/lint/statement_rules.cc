#include <map>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/lint/rules.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {
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
      if (step.leaving) {
        close(node);
      } else if (node.bound_count() > 0) {
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
    for (std::uint32_t i = 0; i < node.bound_count(); ++i) {
      scope_[ast_.name(ast_[ast_.child(node, i)])].push_back(false);
    }
    stack_.push_back({id, true});
    for (auto i = node.child_count; i-- > node.bound_count();) {
      stack_.push_back({ast_.child(node, i), false});
    }
  }

  void close(const Node& node) {
    for (auto i = node.bound_count(); i-- > 0;) {
      const Node& variable = ast_[ast_.child(node, i)];
      auto& used = scope_[ast_.name(variable)];
      if (!used.back()) {
        sink_.warning(codes::kUnusedVariable, ast_.source(variable),
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

std::vector<SymbolId> symbols_of(const LintContext& context, const Ast& ast,
                                 const Statement& statement) {
  std::vector<SymbolId> symbols;
  for (std::uint32_t i = 0; i < statement.item_count; ++i) {
    const auto found = context.model().find_symbol(ast.text(ast.items(statement)[i].name));
    if (found) symbols.push_back(*found);
  }
  return symbols;
}

/// A sort that several of the symbols have as an argument, with two of them.
struct Shared {
  SortId sort;
  SymbolId first, second;
};

std::optional<Shared> shared_argument(const TypedModel& model,
                                      const std::vector<SymbolId>& symbols) {
  std::map<std::uint32_t, SymbolId> owner;  // by sort
  for (const auto symbol : symbols) {
    for (const auto sort : model.symbols[symbol].arguments) {
      const auto [known, is_new] = owner.emplace(sort.index(), symbol);
      if (!is_new && known->second != symbol) return Shared{sort, known->second, symbol};
    }
  }
  return std::nullopt;
}

void check_exclusion(const LintContext& context, const Ast& ast, const Statement& statement) {
  const auto& model = context.model();
  const auto symbols = symbols_of(context, ast, statement);
  if (symbols.size() < 2) return;
  const auto* word = statement.kind == StatementKind::kXor ? "xor" : "mutex";
  const auto source = ast.source(statement.source);
  if (const auto shared = shared_argument(model, symbols)) {
    context.sink().warning(
        codes::kSharedExclusion, source, word, "`" + model.sorts[shared->sort].name + "`",
        "`" + model.symbols[shared->first].name + "` and `" + model.symbols[shared->second].name +
            "` may go together if these differ");
    return;
  }
  for (const auto symbol : symbols) {
    if (model.symbols[symbol].arguments.empty()) continue;
    context.sink().warning(
        codes::kSharedExclusion, source, word, "arguments",
        "two `" + model.symbols[symbol].name + "` may go together if these differ");
    return;
  }
}

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

void find_shared_exclusions(const LintContext& context) {
  for (const auto& place : context.ast().order) {
    const auto& statement = context.ast().statement(place);
    if (statement.kind == StatementKind::kMutex || statement.kind == StatementKind::kXor) {
      check_exclusion(context, context.ast().ast(place), statement);
    }
  }
}

}  // namespace parallax::compiler
