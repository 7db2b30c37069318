#include "compiler/sema/check.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/base/diagnostic.h"
#include "compiler/sema/axiom_shapes.h"
#include "compiler/sema/calculus_axioms.h"
#include "compiler/sema/declarations.h"
#include "compiler/sema/elaborator.h"
#include "compiler/sema/exclusion.h"
#include "compiler/sema/name_advice.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {
namespace {

/// Recognises `F(C1,...,Cn)=V.` and keeps the model's table of function values.
class FunctionTable {
 public:
  FunctionTable(TypedModel& model, bool last_counts, base::DiagnosticSink& sink)
      : model_(model), last_counts_(last_counts), sink_(sink) {}

  /// True if `formula` is an entry of the table; it is then no axiom. If the same arguments have
  /// another value already: E2304, or W2009 where the last one counts.
  bool add(TypedFormulaId formula, SortDomains& domains);

 private:
  bool is_value(TermId term) const;
  void append_key(TermId term, std::string& key) const;
  bool lies_in(TermId value, SortId sort, SortDomains& domains) const;

  TypedModel& model_;
  bool last_counts_;
  base::DiagnosticSink& sink_;
  std::unordered_map<std::string, std::size_t> entries_;  // key of F(C1..Cn) to position
};

std::string printed(const TypedModel& model, TermId term) {
  const Term& value = model.terms[term];
  if (value.kind == TermKind::kInteger) return std::to_string(value.integer);
  if (value.kind == TermKind::kObject) return model.objects[value.object].name;
  return value.kind == TermKind::kApply ? model.symbols[value.symbol].name + "(...)" : "?";
}

bool FunctionTable::is_value(TermId root) const {
  std::vector<TermId> visit = {root};
  while (!visit.empty()) {
    const Term& term = model_.terms[visit.back()];
    visit.pop_back();
    if (term.kind == TermKind::kVariable || term.kind == TermKind::kArithmetic) return false;
    if (term.kind != TermKind::kApply) continue;
    if (model_.symbols[term.symbol].kind == SymbolKind::kFunction) return false;
    visit.insert(visit.end(), term.arguments.begin(), term.arguments.end());
  }
  return true;
}

void FunctionTable::append_key(TermId root, std::string& key) const {
  std::vector<TermId> visit = {root};
  while (!visit.empty()) {
    const Term& term = model_.terms[visit.back()];
    visit.pop_back();
    if (term.kind == TermKind::kObject) {
      key += 'o' + std::to_string(term.object.index());
    } else if (term.kind == TermKind::kInteger) {
      key += 'i' + std::to_string(term.integer);
    } else {  // the number of arguments is fixed, so no bracket is needed
      key += 'a' + std::to_string(term.symbol.index());
      visit.insert(visit.end(), term.arguments.rbegin(), term.arguments.rend());
    }
  }
}

bool FunctionTable::lies_in(TermId value, SortId sort, SortDomains& domains) const {
  const Term& term = model_.terms[value];
  if (term.kind == TermKind::kInteger) {
    return model_.sorts[sort].integer && domains.contains(sort, term.integer);
  }
  if (term.kind == TermKind::kObject) {
    const auto& sorts = model_.objects[term.object].sorts;
    return std::any_of(sorts.begin(), sorts.end(),
                       [&](SortId own) { return model_.is_subsort(own, sort); });
  }
  const auto& result = model_.symbols[term.symbol].result;
  return result && model_.is_subsort(*result, sort);
}

bool FunctionTable::add(TypedFormulaId id, SortDomains& domains) {
  const TypedFormula& formula = model_.formulas[id];
  if (formula.kind != FormulaKind::kCompare || formula.compare != CompareOp::kEqual) return false;
  const Term& left = model_.terms[formula.terms[0]];
  const TermId value = formula.terms[1];
  if (left.kind != TermKind::kApply || model_.symbols[left.symbol].kind != SymbolKind::kFunction ||
      !is_value(value) ||
      !std::all_of(left.arguments.begin(), left.arguments.end(),
                   [this](TermId argument) { return is_value(argument); })) {
    return false;
  }
  const Symbol& function = model_.symbols[left.symbol];
  if (!lies_in(value, *function.result, domains)) {
    sink_
        .warning(codes::kFunctionValueOutsideSort, model_.terms[value].source,
                 printed(model_, value), model_.sorts[*function.result].name)
        .note(function.declared, "`" + signature(model_, function) + "` declared here");
  }
  std::string key;
  append_key(formula.terms[0], key);
  const auto [entry, is_new] = entries_.emplace(key, model_.function_values.size());
  if (is_new) {
    model_.function_values.push_back({left.symbol, left.arguments, value, formula.source});
    return true;
  }
  auto& before = model_.function_values[entry->second];
  std::string old_value, new_value;
  append_key(before.value, old_value);
  append_key(value, new_value);
  if (old_value == new_value) return true;
  if (!last_counts_) {
    sink_
        .error(codes::kFunctionValueTwice, formula.source, printed(model_, formula.terms[0]),
               printed(model_, before.value))
        .note(before.source, "that value is given here");
    return true;
  }
  sink_
      .warning(codes::kFunctionValueReplaced, formula.source, printed(model_, formula.terms[0]),
               printed(model_, before.value))
      .note(before.source, "that value is given here");
  before.value = value;
  before.source = formula.source;
  return true;
}

constexpr std::string_view kCausalDefinitions = "foundations/ECCausal.e";

class ModelChecker {
 public:
  ModelChecker(const ModelAst& ast, const base::SourceFiles& files, const IgnoredNames& ignored,
               const CheckOptions& options, Repetitions& repetitions, TypedModel& model,
               base::DiagnosticSink& sink)
      : ast_(ast),
        files_(files),
        ignored_(ignored),
        repetitions_(repetitions),
        model_(model),
        sink_(sink),
        elaborator_(model, {.complete_model = options.complete_model}, sink),
        functions_(model, options.old_reasoner, sink) {}

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
      sink_.warning(codes::kWeightedFormula, ast.source(statement.source));
      return;
    }
    if (ignored_.concern(ast, statement)) return;
    if (holds_by_itself(place)) return;
    const auto found = elaborator_.elaborate(ast, statement.formula);
    if (!label.empty()) labels_.insert(label);
    if (!found) return;
    if (elaborator_.mentions_effects()) {
      add_effect_formula(*found, std::move(label), model_, sink_);
    } else if (!functions_.add(*found, elaborator_.domains())) {
      model_.axioms.push_back({std::move(label), *found, ast.source(statement.source), false});
    }
  }

  /// An axiom of the calculus written out, or a text of the foundations in a copy of them.
  bool holds_by_itself(const ModelAst::Place& place) {
    const Ast& ast = ast_.ast(place);
    const auto& statement = ast_.statement(place);
    const auto& file = ast_.files[place.file];
    if (file.built_in || !mentions_any(ast, statement, kEffectNames)) return false;
    // Each of them does, and hardly any effect axiom.
    if (!mentions_any(ast, statement, kHappens)) return false;
    const auto shape = ClauseShape::of(ast, statement);
    if (!shape) return false;
    if (!calculus_) calculus_.emplace();
    if (file.repeats_foundation && repeats_definition(*shape)) return true;
    if (!calculus_->recognises(*shape)) return false;
    // DEC3 and DEC4 are written with a predicate that somebody may have defined in another way.
    if (mentions_any(ast, statement, kTrajectoryNames) && has_unusual_interval()) return false;
    repetitions_.note_axiom(ast.source(statement.source));
    return true;
  }

  static constexpr std::array<std::string_view, 2> kTrajectoryNames = {"Trajectory",
                                                                       "AntiTrajectory"};
  static constexpr std::array<std::string_view, 1> kHappens = {"Happens"};
  static constexpr std::array<std::string_view, 3> kEffectNames = {"Initiates", "Terminates",
                                                                   "Releases"};

  static bool mentions_any(const Ast& ast, const Statement& formula,
                           std::span<const std::string_view> names) {
    for (auto i = formula.first_node.index(); i <= formula.formula.index(); ++i) {
      const Node& node = ast[NodeId(i)];
      if (node.kind == NodeKind::kApply &&
          std::find(names.begin(), names.end(), ast.name(node)) != names.end()) {
        return true;
      }
    }
    return false;
  }

  template <typename Visit>
  bool any_formula(const Visit& visit) const {
    return std::any_of(ast_.order.begin(), ast_.order.end(), [&](const ModelAst::Place& place) {
      return ast_.statement(place).kind == StatementKind::kFormula && visit(place);
    });
  }

  bool repeats_definition(const ClauseShape& shape) const {
    return any_formula([&](const ModelAst::Place& place) {
      if (!ast_.files[place.file].built_in) return false;
      const auto definition = ClauseShape::of(ast_.ast(place), ast_.statement(place));
      return definition && shape.same_as(*definition);
    });
  }

  bool has_unusual_interval() const {
    return any_formula([&](const ModelAst::Place& place) {
      const Ast& ast = ast_.ast(place);
      const auto& statement = ast_.statement(place);
      if (!CalculusAxioms::defined_interval(ast, statement.formula)) return false;
      const auto shape = ClauseShape::of(ast, statement);
      return !shape || !calculus_->is_usual_definition(*shape);
    });
  }

  /// Foundations define predicates by `[..] P(..) <-> ...`. A definition changes nothing about
  /// other predicates, so it is left out unless P is mentioned. ECCausal.e is loaded for its
  /// definitions alone: they stay.
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
          const auto before = model_.axioms.size();
          formula(place);
          for (auto i = before; i < model_.axioms.size(); ++i) {
            model_.axioms[i].is_foundation = true;
          }
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
    if (file.name() == kCausalDefinitions) return true;
    NodeId id = ast_.statement(place).formula;
    while (ast[id].kind == NodeKind::kForall) id = ast.child(ast[id], ast[id].child_count - 1);
    if (ast[id].kind == NodeKind::kBinary) id = ast.child(ast[id], 0);
    const auto symbol = model_.find_symbol(ast.name(ast[id]));
    return symbol && elaborator_.mentioned(*symbol);
  }

  void check_labels() {
    for (const auto& completion : model_.completions) {
      if (!completion.label || labels_.contains(*completion.label)) continue;
      sink_.warning(codes::kCompletionWithoutLabel, completion.source, shortened(*completion.label),
                    model_.symbols[completion.predicate].name);
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
  Repetitions& repetitions_;
  TypedModel& model_;
  base::DiagnosticSink& sink_;
  Elaborator elaborator_;
  FunctionTable functions_;
  std::optional<CalculusAxioms> calculus_;  // made when first asked
  std::unordered_set<std::string> labels_;  // look-up only
};

}  // namespace

base::Result<TypedModel> check_model(const ModelAst& ast, const base::SourceFiles& files,
                                     base::DiagnosticSink& sink, const CheckOptions& options) {
  TypedModel model;
  std::size_t nodes = 0;
  for (const auto& file : ast.files) nodes += file.ast.node_count();
  // About as many as there will be: to let them grow takes a tenth of the time.
  model.terms.reserve(nodes / 2);
  model.formulas.reserve(nodes / 2);
  const IgnoredNames ignored(ast);
  Repetitions repetitions(ast, sink);
  declare(ast, ignored, options, repetitions, model, sink);
  ModelChecker(ast, files, ignored, options, repetitions, model, sink).run();
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

base::Result<CheckedSum> check_sum(TypedModel& model, TreePart formula,
                                   std::optional<TreePart> weight, base::DiagnosticSink& sink) {
  Elaborator elaborator(model, {.allow_free_variables = true, .allow_effects = false}, sink);
  std::optional<TypedFormulaId> bound;
  if (weight) {
    // A comparison asks for integers, in the words that are known from formulas.
    auto& ast = *weight->ast;
    Node node;
    node.kind = NodeKind::kBinary;
    node.op = Operator::kLessEqual;
    node.begin = ast[weight->root].begin;
    node.end = ast[weight->root].end;
    const NodeId sides[] = {weight->root, weight->root};
    bound = elaborator.elaborate(ast, ast.add(node, sides, 2));
  }
  const auto checked = elaborator.elaborate(*formula.ast, formula.root);
  if (!checked || (weight && !bound)) return sink.already_reported();
  CheckedSum sum{*checked, std::nullopt, elaborator.free_variables()};
  if (bound) sum.weight = model.formulas[*bound].terms[0];
  return sum;
}

}  // namespace parallax::compiler
