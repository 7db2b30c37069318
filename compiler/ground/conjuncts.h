#pragma once

#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

/// Something that must be true of an instance for the instance to say anything.
struct Conjunct {
  enum class Kind : std::uint8_t {
    kCompare,  // `formula`, a comparison, is true (false if `negated`)
    kAtom,     // `formula`, an atom, is true
    kEvent,    // `term` is an event that may happen at `time`
    kFluent,   // `term` is a fluent
    kTime,     // `term` is a timepoint, one with a next one if `step`
    kMeeting   // the event of the atom `formula` and the fluent of `other` can meet
  };
  Kind kind = Kind::kCompare;
  TypedFormulaId formula;
  bool negated = false;
  TermId term, time;
  bool step = false;
  TypedFormulaId other = {};
};

/// For every Happens and HoldsAt of the same timepoint among the conjuncts: they can meet.
std::vector<Conjunct> meetings_in(const TypedModel& model, const std::vector<Conjunct>& conjuncts);

/// Necessary conditions for the formula to be true (false if `negated`): the comparisons and
/// positive atoms of its conjunction. Everything else is left to evaluation.
std::vector<Conjunct> conjuncts_of(const TypedModel& model, TypedFormulaId formula, bool negated);

/// Variables of a term, in order of occurrence, with repetitions.
std::vector<VariableId> variables_of(const TypedModel& model, TermId term);

/// Variables of all terms in a formula, with repetitions.
std::vector<VariableId> variables_of(const TypedModel& model, TypedFormulaId formula);

}  // namespace parallax::compiler
