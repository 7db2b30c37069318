#pragma once

#include <cstddef>
#include <vector>

#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Formulas that together say that at most one of the members is true: pairs, or from `clique`
/// members on blocks of about their square root, pairs inside of each block and pairs of blocks.
/// A block, the disjunction of its members, becomes one auxiliary (the commander encoding of
/// Klieber and Kwon 2007). Of n members that is about n^1.5 clauses instead of n^2 / 2, and what
/// unit propagation finds is the same.
std::vector<FormulaId> at_most_one(const std::vector<FormulaId>& members, std::size_t clique,
                                   FormulaStore& formulas);

/// The same of HoldsAt or Happens atoms, so that constants stay interchangeable: blocks are made of
/// atoms that differ in numbers alone, which are never exchanged, and atoms with other constants
/// are apart.
std::vector<FormulaId> at_most_one(std::vector<FormulaId> atoms, std::size_t clique,
                                   GroundModel& model);

/// Finds, in each axiom, sets of atoms any two of which it excludes, and words the exclusions by
/// blocks where a set has `clique` members or more. Only axioms that hold at every timepoint.
void join_exclusions(GroundModel& model, std::size_t clique);

}  // namespace parallax::compiler
