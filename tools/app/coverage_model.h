#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/base/source_file.h"
#include "compiler/reference/reference_use.h"
#include "compiler/sema/typed_model.h"
#include "runtime/trace/trace.h"
#include "tools/app/coverage.h"

namespace parallax::tools {

/// The coverage items of a model, and those that a trace covers.
class ModelCoverage {
 public:
  /// All outlive the object; the evaluator refuses nothing.
  ModelCoverage(const compiler::TypedModel& model, const compiler::ReferenceEvaluator& evaluator,
                const base::SourceFiles& files);

  /// With what stands there.
  const std::map<CoverageKey, std::string>& all() const { return all_; }
  std::set<CoverageKey> covered_by(const runtime::Trace& trace) const;
  /// The event's symbol: "Go(r2)". None: the model has no such event.
  std::optional<CoverageKey> event(std::string_view name) const;

 private:
  std::string text(const base::SourceRange& range) const;
  CoverageKey event(const compiler::Symbol& symbol) const;
  CoverageKey effect(std::size_t i) const;
  bool speaks_of_events(compiler::TypedFormulaId root) const;
  std::optional<CoverageKey> axiom(std::size_t i) const;

  const compiler::TypedModel& model_;
  const base::SourceFiles& files_;
  compiler::ReferenceUse use_;
  std::vector<std::optional<CoverageKey>> axioms_;  // none: it says nothing of events
  std::map<CoverageKey, std::string> all_;
};

}  // namespace parallax::tools
