#include "compiler/sema/check.h"

#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "compiler/base/diagnostic_codes.h"
#include "compiler/sema/axiom_shapes.h"
#include "compiler/sema/declarations.h"
#include "compiler/sema/elaborator.h"
#include "compiler/sema/exclusion.h"
#include "compiler/sema/function_table.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

using base::DiagnosticCode;

namespace {

constexpr std::string_view kCausalDefinitions = "foundations/ECCausal.e";

class ModelChecker {
 public:
  ModelChecker(const ModelAst& ast, const base::SourceFiles& files, const IgnoredNames& ignored,
               const CheckOptions& options, TypedModel& model, base::DiagnosticSink& sink)
      : ast_(ast),
        files_(files),
        ignored_(ignored),
        keep_causal_(options.keep_causal_definitions),
        model_(model),
        sink_(sink),
        elaborator_(model, {.complete_model = options.complete_model}, sink),
        functions_(model, sink) {}

  void run() {
    for (std::size_t i = 0; i < ast_.order.size(); ++i) {
      const auto& place = ast_.order[i];
      const auto& statement = ast_.statement(place);
      if (statement.kind == StatementKind::kFormula) {
        // Foundations wait: only those definitions stay that the model uses.
        if (!ast_.files[place.file].built_in) formula(place);
      } else if (statement.kind == StatementKind::kMutex || statement.kind == StatementKind::kXor) {
        add_exclusion(ast_.ast(place), statement, i, ignored_, elaborator_, model_, sink_);
      }
    }
    for (const auto& completion : model_.completions) elaborator_.mention(completion.predicate);
    definitions();
    check_labels();
    check_argument_ranges();
  }

 private:
  void formula(const ModelAst::Place& place) {
    const Ast& ast = ast_.ast(place);
    const auto& statement = ast_.statement(place);
    std::string label(ast.text(statement.label));
    if (!label.empty() && label[0] >= '0' && label[0] <= '9') {
      sink_.warning(DiagnosticCode::kWeightedFormula, ast.source(statement.source));
      return;
    }
    if (ignored_.concern(ast, statement)) return;
    const auto found = elaborator_.elaborate(ast, statement.formula);
    if (!label.empty()) labels_.insert(label);
    if (!found) return;
    if (elaborator_.mentions_effects()) {
      add_effect_formula(*found, std::move(label), model_, sink_);
    } else if (!functions_.add(*found, elaborator_.domains())) {
      model_.axioms.push_back({std::move(label), *found, ast.source(statement.source), false});
    }
  }

  /// Foundations define predicates by `[..] P(..) <-> ...`. A definition changes nothing about
  /// other predicates, so it is left out unless P is mentioned.
  void definitions() {
    std::vector<ModelAst::Place> waiting;
    for (const auto& place : ast_.order) {
      const bool is_formula = ast_.statement(place).kind == StatementKind::kFormula;
      if (is_formula && ast_.files[place.file].built_in) waiting.push_back(place);
    }
    bool again = true;
    while (again) {
      again = false;
      std::vector<ModelAst::Place> unused;
      for (const auto& place : waiting) {
        if (is_used(place)) {
          formula(place);
          again = true;
        } else {
          unused.push_back(place);
        }
      }
      waiting = std::move(unused);
    }
  }

  bool is_used(const ModelAst::Place& place) const {
    const Ast& ast = ast_.ast(place);
    const auto& file = files_[ast.source(ast_.statement(place).source).file];
    if (keep_causal_ && file.name() == kCausalDefinitions) return true;
    NodeId id = ast_.statement(place).formula;
    while (ast[id].kind == NodeKind::kForall) id = ast.child(ast[id], ast[id].child_count - 1);
    if (ast[id].kind == NodeKind::kBinary) id = ast.child(ast[id], 0);
    const auto symbol = model_.find_symbol(ast.name(ast[id]));
    return symbol && elaborator_.mentioned(*symbol);
  }

  void check_labels() {
    for (const auto& completion : model_.completions) {
      if (!completion.label || labels_.contains(*completion.label)) continue;
      sink_.warning(DiagnosticCode::kCompletionWithoutLabel, completion.source,
                    shortened(*completion.label), model_.symbols[completion.predicate].name);
    }
  }

  /// Every instance of a fluent or event is a thing of the model, named in a formula or not.
  void check_argument_ranges() {
    for (const auto& symbol : model_.symbols) {
      if (symbol.kind != SymbolKind::kFluent && symbol.kind != SymbolKind::kEvent) continue;
      for (const auto sort : symbol.arguments) elaborator_.require_range(sort, symbol.declared);
      if (model_.core.time) elaborator_.require_range(*model_.core.time, symbol.declared);
    }
  }

  const ModelAst& ast_;
  const base::SourceFiles& files_;
  const IgnoredNames& ignored_;
  bool keep_causal_;
  TypedModel& model_;
  base::DiagnosticSink& sink_;
  Elaborator elaborator_;
  FunctionTable functions_;
  std::unordered_set<std::string> labels_;  // look-up only
};

}  // namespace

base::Result<TypedModel> check_model(const ModelAst& ast, const base::SourceFiles& files,
                                     base::DiagnosticSink& sink, const CheckOptions& options) {
  TypedModel model;
  const IgnoredNames ignored(ast);
  declare(ast, ignored, options, model, sink);
  ModelChecker(ast, files, ignored, options, model, sink).run();
  if (sink.has_errors()) return sink.already_reported();
  return model;
}

base::Result<CheckedFormula> check_formula(TypedModel& model, const Ast& ast, NodeId root,
                                           const FormulaOptions& options,
                                           base::DiagnosticSink& sink) {
  Elaborator elaborator(model,
                        {.allow_free_time = options.allow_free_time,
                         .fluents_as_atoms = options.fluents_as_atoms,
                         .fluent_time = options.fluent_time,
                         .allow_effects = false},
                        sink);
  const auto formula = elaborator.elaborate(ast, root);
  if (!formula) return sink.already_reported();
  return CheckedFormula{*formula, elaborator.free_time()};
}

}  // namespace parallax::compiler
