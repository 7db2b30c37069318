#pragma once

#include <vector>

#include "compiler/ground/formula_grounder.h"

namespace parallax::compiler {

/// One formula under expansion: what its parts (or instances) have given so far.
struct FormulaGrounder::Frame {
  const TypedFormula* formula = nullptr;
  std::size_t next_child = 0;
  std::vector<FormulaId> parts;
  bool discarded = false;  // some part named nothing that exists
  bool exists = false;     // some part named something that exists
  bool exhausted = false;
  // Quantifiers:
  std::vector<VariableId> open;         // its variables without a value from outside
  std::vector<GroundTermId> instances;  // one after the other
  std::size_t next = 0;                 // the next instance
  bool in_product = false;              // only looking for an instance that exists
  std::vector<std::size_t> odometer;
};

}  // namespace parallax::compiler
