#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// The true atoms of a trace: by timepoint for the event calculus, without for user predicates.
struct Valuation {
  std::vector<std::set<std::string>> holds, happens, released;
  std::set<std::string> predicates;
};

/// The first thing that a valuation gets wrong.
struct Violation {
  base::SourceRange source;  // the axiom, effect axiom, or fluent declaration
  std::string what;          // "axiom", "DEC9", "DEC5 for RobotIn(r1)", ...
  std::int64_t timepoint = 0;
};

/// Evaluates a typed model on a valuation, slowly and obviously: formulas by recursion over their
/// meaning, DEC5 to DEC12 of Mueller 2006 as they are printed there. Shares nothing with grounder
/// and encoder; it is their oracle.
class ReferenceEvaluator {
 public:
  /// `model` outlives the evaluator; its sorts must be small.
  explicit ReferenceEvaluator(const TypedModel& model);
  std::optional<Violation> check(const Valuation& valuation) const;

  const std::vector<std::string>& fluents() const { return domains_.at(fluent_sort_); }
  const std::vector<std::string>& events() const { return domains_.at(event_sort_); }
  std::int64_t horizon() const { return horizon_; }

 private:
  /// An instance can name what does not exist; it then says nothing.
  enum class Truth : std::uint8_t { kFalse, kTrue, kNothing };
  using Environment = std::map<std::uint32_t, std::string>;
  struct Effects {
    std::set<std::string> initiated, terminated, released;
  };

  Truth evaluate(TypedFormulaId formula, Environment& environment, const Valuation& v) const;
  Truth quantified(const TypedFormula& formula, std::size_t variable, Environment& environment,
                   const Valuation& v) const;
  Truth atom(const TypedFormula& formula, const Environment& environment, const Valuation& v) const;
  std::optional<std::string> term(TermId term, const Environment& environment) const;
  bool member(SortId sort, const std::string& value) const;
  void collect(const EffectAxiom& effect, std::size_t variable, Environment& environment,
               std::int64_t t, const Valuation& v, Effects& out) const;
  std::optional<Violation> check_inertia(const Valuation& v) const;
  std::optional<Violation> check_step(const Valuation& v, std::int64_t t, const std::string& fluent,
                                      const Effects& effects) const;

  const TypedModel& model_;
  std::map<std::uint32_t, std::vector<std::string>> domains_;  // by sort
  std::map<std::string, SymbolId> fluent_symbols_;             // by ground fluent
  std::uint32_t fluent_sort_ = 0, event_sort_ = 0;
  std::int64_t horizon_ = 0;
};

/// The printed ground terms of every sort, in any order without repetition.
std::map<std::uint32_t, std::vector<std::string>> reference_domains(const TypedModel& model);

}  // namespace parallax::compiler
