#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "compiler/formula/formula.h"

namespace parallax::compiler {

/// Formulas as text for people: `a & (b | !c)`. A part that occurs in several places is written
/// `#1` there and defined once, so that the text is linear in the formulas' graph. No recursion.
class FormulaText {
 public:
  /// `store` outlives the object.
  FormulaText(const FormulaStore& store, std::function<std::string(std::int32_t)> atom_name);

  /// Notes the places of a formula's parts; call for every formula before the first text.
  void count(FormulaId formula);
  std::string text(FormulaId formula);
  /// The parts that the texts so far have named, and those that these name: `#1 = b | !c`, a line
  /// each.
  std::string definitions();

 private:
  /// The store may have grown since the last call.
  void know_nodes();
  std::string part_name(FormulaId id);

  const FormulaStore& store_;
  std::function<std::string(std::int32_t)> atom_name_;
  std::vector<std::uint32_t> uses_;     // by node
  std::vector<std::uint32_t> numbers_;  // by node; 0: not named
  std::vector<FormulaId> named_;        // by number - 1; positive
};

}  // namespace parallax::compiler
