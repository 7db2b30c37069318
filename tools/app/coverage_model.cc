#include "tools/app/coverage_model.h"

#include <utility>

#include "compiler/base/ground_name.h"
#include "compiler/base/utf8.h"
#include "compiler/base/words.h"
#include "tools/app/coverage_plan.h"
#include "tools/app/trace_check.h"

namespace parallax::tools {

using compiler::FormulaKind;
using compiler::TypedFormulaId;

namespace {

/// A statement on one line, cut after the last character that ends within 100 bytes.
std::string short_line(std::string_view text) {
  constexpr std::size_t kMost = 100;
  auto out = base::one_line(text);
  if (out.size() <= kMost) return out;
  auto end = kMost;
  while (end > 0 && base::continues_code_point(out[end])) --end;
  out.resize(end);
  return out + "...";
}

}  // namespace

ModelCoverage::ModelCoverage(const compiler::TypedModel& model,
                             const compiler::ReferenceEvaluator& evaluator,
                             const base::SourceFiles& files)
    : model_(model), files_(files), use_(evaluator) {
  for (std::size_t i = 0; i < model.symbols.size(); ++i) {
    const auto& symbol = model.symbols[model.symbols.id_at(i)];
    if (symbol.kind == compiler::SymbolKind::kEvent) all_.emplace(event(symbol), "");
  }
  for (std::size_t i = 0; i < model.effects.size(); ++i) {
    all_.emplace(effect(i), text(model.effects[i].source));
  }
  for (std::size_t i = 0; i < model.axioms.size(); ++i) {
    axioms_.push_back(axiom(i));
    if (axioms_[i]) all_.emplace(*axioms_[i], text(model.axioms[i].source));
  }
}

std::set<CoverageKey> ModelCoverage::covered_by(const runtime::Trace& trace) const {
  std::set<CoverageKey> covered;
  for (std::size_t t = 0; t < trace.points.size(); ++t) {
    for (const auto name : trace.happens(t)) {
      if (auto key = event(name)) covered.insert(*std::move(key));
    }
  }
  const auto used = use_.of(valuation_of(trace));
  for (const auto i : used.effects) covered.insert(effect(i));
  for (const auto i : used.axioms) {
    if (axioms_[i]) covered.insert(*axioms_[i]);
  }
  return covered;
}

std::optional<CoverageKey> ModelCoverage::event(std::string_view name) const {
  const auto symbol = model_.find_symbol(base::symbol_of(name));
  return symbol ? std::optional(event(model_.symbols[*symbol])) : std::nullopt;
}

std::string ModelCoverage::text(const base::SourceRange& range) const {
  return short_line(files_.text(range));
}

CoverageKey ModelCoverage::event(const compiler::Symbol& symbol) const {
  return coverage_key(CoverageGroup::kEvents, symbol.declared, symbol.name, files_);
}

CoverageKey ModelCoverage::effect(std::size_t i) const {
  const auto& axiom = model_.effects[i];
  const auto* kind = "releases";
  if (axiom.kind == compiler::EffectKind::kInitiates) kind = "initiates";
  if (axiom.kind == compiler::EffectKind::kTerminates) kind = "terminates";
  return coverage_key(CoverageGroup::kAxioms, axiom.source, kind, files_);
}

bool ModelCoverage::speaks_of_events(TypedFormulaId root) const {
  std::vector<TypedFormulaId> open = {root};
  while (!open.empty()) {
    const auto& formula = model_.formulas[open.back()];
    open.pop_back();
    if (formula.kind == FormulaKind::kAtom && formula.predicate == model_.core.happens) {
      return true;
    }
    open.insert(open.end(), formula.children.begin(), formula.children.end());
  }
  return false;
}

std::optional<CoverageKey> ModelCoverage::axiom(std::size_t i) const {
  const auto& axiom = model_.axioms[i];
  if (axiom.is_foundation || !speaks_of_events(axiom.formula)) return std::nullopt;
  auto root = axiom.formula;
  while (model_.formulas[root].kind == FormulaKind::kForall) {
    root = model_.formulas[root].children.front();
  }
  const auto& formula = model_.formulas[root];
  const bool conditional = formula.kind == FormulaKind::kImplies;
  const bool asks = conditional && speaks_of_events(formula.children.front());
  const bool brings = conditional && !asks;
  return coverage_key(CoverageGroup::kAxioms, axiom.source,
                      asks     ? "precondition"
                      : brings ? "trigger"
                               : "events",
                      files_);
}

}  // namespace parallax::tools
