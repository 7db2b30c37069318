#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/formula/formula.h"
#include "compiler/ground/ground_term.h"
#include "compiler/ground/universe.h"

namespace parallax::compiler {

/// A propositional formula that holds, and the text that says so.
struct Constraint {
  FormulaId formula;
  std::uint32_t origin = 0;
};

/// The model without variables: atoms, and the formulas that hold over them. Atoms are numbered
/// timepoint by timepoint (HoldsAt, ReleasedAt, Happens, each in declaration order), so a SAT
/// variable's place does not depend on what the axioms say.
class GroundModel {
 public:
  GroundModel(const TypedModel& model, GroundTermStore terms, Universe universe);

  Timepoint horizon() const { return universe_.horizon(); }
  const TypedModel& typed() const { return *typed_; }
  GroundTermStore& terms() { return terms_; }
  const GroundTermStore& terms() const { return terms_; }
  const Universe& universe() const { return universe_; }
  FormulaStore& formulas() { return formulas_; }
  const FormulaStore& formulas() const { return formulas_; }

  const std::vector<GroundTermId>& fluents() const { return fluents_; }
  const std::vector<GroundTermId>& events() const { return events_; }
  std::optional<std::uint32_t> fluent_number(GroundTermId term) const;
  std::optional<std::uint32_t> event_number(GroundTermId term) const;

  /// HoldsAt for 0 <= t <= horizon.
  FormulaId holds(std::uint32_t fluent, Timepoint t);
  /// Happens for 0 <= t < horizon: events at the last timepoint have no effect and do not exist.
  FormulaId happens(std::uint32_t event, Timepoint t);
  /// False for fluents that nothing ever releases.
  FormulaId released(std::uint32_t fluent, Timepoint t);
  bool can_be_released(std::uint32_t fluent) const { return release_slot_[fluent].has_value(); }
  /// An atom that is made when first asked for.
  FormulaId named_atom(AtomKind kind, std::string name, std::optional<Timepoint> time);

  std::uint32_t add_origin(base::SourceRange source, std::string what);
  void require(FormulaId formula, std::uint32_t origin);

  /// The horizon from which on every atom of the formula exists.
  Timepoint needed_horizon_of(FormulaId formula) const;

  const std::vector<Atom>& atoms() const { return atoms_; }
  const std::vector<Constraint>& constraints() const { return constraints_; }
  const std::vector<Origin>& origins() const { return origins_; }

 private:
  void allocate_timed_atoms();
  std::vector<bool> releasable_symbols() const;

  const TypedModel* typed_;  // outlives the ground model
  GroundTermStore terms_;
  Universe universe_;
  FormulaStore formulas_;
  std::vector<GroundTermId> fluents_, events_;
  std::unordered_map<GroundTermId, std::uint32_t> fluent_numbers_, event_numbers_;
  std::vector<std::optional<std::uint32_t>> release_slot_;  // by fluent
  std::uint32_t release_count_ = 0;
  std::vector<Atom> atoms_;
  std::map<std::tuple<AtomKind, std::string, Timepoint>, std::int32_t> named_;
  std::vector<Constraint> constraints_;
  std::vector<Origin> origins_;
};

}  // namespace parallax::compiler
