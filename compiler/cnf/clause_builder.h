#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/source_file.h"
#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// A literal before variables are numbered: a variable of the formula store, or an auxiliary.
struct OpenLiteral {
  bool is_auxiliary = false;
  bool negated = false;
  std::uint32_t index = 0;  // variable, or number of the auxiliary
};

/// Stands for a subformula. A moving one stands for it at every timepoint.
struct OpenAuxiliary {
  FormulaId formula;  // positive
  bool moves = false;
};

struct OpenClause {
  std::vector<OpenLiteral> literals;
  std::uint32_t origin = 0;
  bool is_definition = false;
  Timepoint needed = 0;  // the horizon from which on it exists, unmoved
};

/// Clauses of a model's constraints, those that hold once apart from those that hold at every
/// timepoint (by width, GroundModel::require_always).
class ClauseBuilder {
 public:
  explicit ClauseBuilder(const GroundModel& model);
  /// Adds a constraint; call before the formula store grows further.
  void add(const Constraint& constraint);

  const std::vector<OpenClause>& once() const { return once_; }
  const std::map<Timepoint, std::vector<OpenClause>>& repeated() const { return repeated_; }
  const std::vector<OpenAuxiliary>& auxiliaries() const { return auxiliaries_; }
  /// The horizon that a formula's atoms need; its node's sign does not matter.
  Timepoint needed(FormulaId id) const { return needed_[id.node()]; }

 private:
  OpenLiteral use(FormulaId id, bool moves);
  void define_pending();
  void emit(OpenClause clause, Timepoint width);

  const GroundModel& model_;
  const FormulaStore& formulas_;
  std::vector<Timepoint> needed_;  // by node
  std::vector<bool> timed_;        // by node: mentions a timepoint
  /// By node, unmoved and moving: number of the auxiliary + 1, polarities that have a definition.
  struct Known {
    std::uint32_t auxiliary[2] = {0, 0};
    std::uint8_t defined[2] = {0, 0};
  };
  std::vector<Known> known_;
  std::vector<OpenAuxiliary> auxiliaries_;
  std::vector<std::pair<FormulaId, bool>> pending_;
  std::vector<OpenClause> once_;
  std::map<Timepoint, std::vector<OpenClause>> repeated_;
  std::uint32_t origin_ = 0;
};

// Values between the passes of the encoding, for people. `files` may be null: then without places.

/// The clauses over atoms and auxiliaries, `m.e:5 axiom: !Happens(E(),0) #3`, those that hold once
/// before those of each width.
std::string clause_lines(const GroundModel& model, const ClauseBuilder& clauses,
                         const base::SourceFiles* files);

/// Kind and name of each place, first of the slots, then of the fixed variables. Unused places are
/// left out.
std::string place_lines(const CompiledModel& model);

/// The clauses as numbers, with a heading for each section; only the first block of a repeated
/// section.
std::string numbered_lines(const CompiledModel& model, const base::SourceFiles* files);

}  // namespace parallax::compiler
