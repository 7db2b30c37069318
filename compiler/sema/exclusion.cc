#include "compiler/sema/exclusion.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/codes/names.h"
#include "compiler/sema/name_advice.h"
#include "compiler/syntax/lexer.h"

namespace parallax::compiler {

namespace {

constexpr std::array<SymbolKind, 3> kKinds = {SymbolKind::kEvent, SymbolKind::kFluent,
                                              SymbolKind::kPredicate};
// No variable of an argument can have this name, so an argument of sort time stays distinct.
constexpr std::string_view kMoment = "time ";

class Expansion {
 public:
  Expansion(const Ast& ast, const Statement& statement, Elaborator& elaborator, TypedModel& model,
            base::DiagnosticSink& sink)
      : ast_(ast),
        statement_(statement),
        elaborator_(elaborator),
        model_(model),
        sink_(sink),
        source_(ast.source(statement.source)) {}

  void resolve(const IgnoredNames& ignored, std::size_t position) {
    for (std::uint32_t i = 0; i < statement_.item_count; ++i) {
      const auto word = ast_.items(statement_)[i].name;
      if (!ignored.contains(ast_.text(word), position)) resolve_one(word);
    }
  }

  void expand() {
    if (failed_) return;
    for (std::size_t i = 0; i < symbols_.size(); ++i) {
      for (std::size_t k = i + 1; k < symbols_.size(); ++k) {
        if (!elaborator_.has_room(source_)) return;
        add({symbols_[i], symbols_[k]}, true);
      }
    }
    if (statement_.kind == StatementKind::kXor && !symbols_.empty()) add(symbols_, false);
  }

 private:
  void resolve_one(Word word) {
    const auto name = ast_.text(word);
    const auto found = model_.find_symbol(name);
    if (!found) {
      failed_ = true;
      if (model_.misdeclared.contains(name)) return;
      auto report = sink_.error(codes::kUnknownName, ast_.source(word),
                                "event, fluent or predicate", shortened(name), "");
      if (const auto near = NameAdvice(model_, sink_).symbol(name, kKinds)) {
        report.fix(NameAdvice::replace(name, model_.symbols[*near].name));
      }
      return;
    }
    const auto& symbol = model_.symbols[*found];
    if (std::find(kKinds.begin(), kKinds.end(), symbol.kind) == kKinds.end()) {
      sink_
          .error(codes::kWrongKind, ast_.source(word), shortened(name),
                 with_article(kind_word(symbol.kind)), "an event, a fluent or a predicate")
          .note(symbol.declared, "`" + signature(model_, symbol) + "` declared here");
      failed_ = true;
      return;
    }
    if (symbol.kind != SymbolKind::kPredicate && !(model_.core.holds_at && model_.core.happens)) {
      sink_.error(codes::kMissingFoundation, ast_.source(word), shortened(name));
      failed_ = true;
      return;
    }
    elaborator_.mention(*found);
    // A name written twice does not exclude itself.
    if (std::find(symbols_.begin(), symbols_.end(), *found) == symbols_.end()) {
      symbols_.push_back(*found);
    }
  }

  TermId variable(const std::string& name, SortId sort) {
    const auto known = std::find_if(variables_.begin(), variables_.end(), [&](VariableId id) {
      return model_.variables[id].name == name && model_.variables[id].sort == sort;
    });
    Term term;
    term.kind = TermKind::kVariable;
    term.variable = known != variables_.end() ? *known : model_.variables.add({name, sort});
    term.source = source_;
    if (known == variables_.end()) {
      variables_.push_back(term.variable);
      elaborator_.require_range(sort, source_);
    }
    return model_.terms.add(std::move(term));
  }

  /// Does one of the symbols have more than one argument of the sort?
  bool has_several(const std::vector<SymbolId>& symbols, SortId sort) const {
    return std::any_of(symbols.begin(), symbols.end(), [&](SymbolId id) {
      const auto& arguments = model_.symbols[id].arguments;
      return std::count(arguments.begin(), arguments.end(), sort) > 1;
    });
  }

  /// A sort's arguments are numbered where one of `numbered_by_` has several.
  std::vector<TermId> arguments(const Symbol& symbol) {
    std::vector<TermId> terms;
    for (std::size_t i = 0; i < symbol.arguments.size(); ++i) {
      const auto sort = symbol.arguments[i];
      const auto begin = symbol.arguments.begin();
      std::string name = model_.sorts[sort].name;
      if (has_several(numbered_by_, sort)) {
        const auto before = std::count(begin, begin + static_cast<std::ptrdiff_t>(i), sort);
        name += std::to_string(before + 1);
      }
      terms.push_back(variable(name, sort));
    }
    return terms;
  }

  TypedFormulaId atom(SymbolId id) {
    TypedFormula formula;
    formula.kind = FormulaKind::kAtom;
    formula.source = source_;
    // A copy: the stores grow below.
    const Symbol symbol = model_.symbols[id];
    formula.predicate = id;
    formula.terms = arguments(symbol);
    if (symbol.kind != SymbolKind::kPredicate) {
      Term term;
      term.kind = TermKind::kApply;
      term.symbol = id;
      term.arguments = std::move(formula.terms);
      term.source = source_;
      const auto applied = model_.terms.add(std::move(term));
      const bool fluent = symbol.kind == SymbolKind::kFluent;
      formula.predicate = fluent ? *model_.core.holds_at : *model_.core.happens;
      formula.terms = {applied, variable(std::string(kMoment), *model_.core.time)};
    }
    return model_.formulas.add(std::move(formula));
  }

  TypedFormulaId negated(TypedFormulaId id) {
    TypedFormula formula;
    formula.kind = FormulaKind::kNot;
    formula.children = {id};
    formula.source = source_;
    return model_.formulas.add(std::move(formula));
  }

  void add(const std::vector<SymbolId>& symbols, bool negative) {
    variables_.clear();
    TypedFormula any;
    any.kind = FormulaKind::kOr;
    any.source = source_;
    for (const auto symbol : symbols) {
      // Pairs share the n-th argument of a sort whatever its name; the disjunction of `xor` shares
      // variables by name, and numbers them for each symbol alone (the reasoner of 2005).
      numbered_by_ = negative ? symbols : std::vector<SymbolId>{symbol};
      const auto positive = atom(symbol);
      any.children.push_back(negative ? negated(positive) : positive);
    }
    auto body =
        any.children.size() == 1 ? any.children.front() : model_.formulas.add(std::move(any));
    if (!variables_.empty()) {
      TypedFormula all;
      all.kind = FormulaKind::kForall;
      all.variables = variables_;
      all.children = {body};
      all.source = source_;
      body = model_.formulas.add(std::move(all));
    }
    model_.axioms.push_back({std::string(), body, source_, false});
  }

  const Ast& ast_;
  const Statement& statement_;
  Elaborator& elaborator_;
  TypedModel& model_;
  base::DiagnosticSink& sink_;
  const base::SourceRange source_;
  std::vector<SymbolId> symbols_;
  std::vector<VariableId> variables_;  // of the axiom being made
  std::vector<SymbolId> numbered_by_;  // decide which arguments of the axiom are numbered
  bool failed_ = false;
};

}  // namespace

void add_exclusion(const Ast& ast, const Statement& statement, std::size_t position,
                   const IgnoredNames& ignored, Elaborator& elaborator, TypedModel& model,
                   base::DiagnosticSink& sink) {
  Expansion expansion(ast, statement, elaborator, model, sink);
  expansion.resolve(ignored, position);
  expansion.expand();
}

}  // namespace parallax::compiler
