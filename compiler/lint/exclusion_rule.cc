#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/lint/rules.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

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

void check(const LintContext& context, const Ast& ast, const Statement& statement) {
  const auto& model = context.model();
  const auto symbols = symbols_of(context, ast, statement);
  if (symbols.size() < 2) return;
  const auto* word = statement.kind == StatementKind::kXor ? "xor" : "mutex";
  const auto source = ast.source(statement.source);
  if (const auto shared = shared_argument(model, symbols)) {
    context.sink().warning(
        DiagnosticCode::kSharedExclusion, source, word, "`" + model.sorts[shared->sort].name + "`",
        "`" + model.symbols[shared->first].name + "` and `" + model.symbols[shared->second].name +
            "` may go together if these differ");
    return;
  }
  for (const auto symbol : symbols) {
    if (model.symbols[symbol].arguments.empty()) continue;
    context.sink().warning(
        DiagnosticCode::kSharedExclusion, source, word, "arguments",
        "two `" + model.symbols[symbol].name + "` may go together if these differ");
    return;
  }
}

}  // namespace

void find_shared_exclusions(const LintContext& context) {
  for (const auto& place : context.ast().order) {
    const auto& statement = context.ast().statement(place);
    if (statement.kind == StatementKind::kMutex || statement.kind == StatementKind::kXor) {
      check(context, context.ast().ast(place), statement);
    }
  }
}

}  // namespace parallax::compiler
