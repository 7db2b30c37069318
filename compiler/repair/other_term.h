#pragma once

#include <string>
#include <utility>
#include <vector>

#include "compiler/repair/edit_subject.h"

namespace parallax::compiler {

/// The variables of an axiom but for its time variable, with their sorts.
std::vector<SortedVariable> variables_of(const AxiomForm& form, const TypedModel& typed);

/// A fluent or event with one argument that is another one.
struct OtherTerm {
  std::string symbol;
  std::vector<std::string> arguments;
  int oddity = 0;

  std::string text() const {
    std::string out = symbol;
    for (std::size_t i = 0; i < arguments.size(); ++i) out += (i == 0 ? "(" : ",") + arguments[i];
    return out + ")";
  }
};
/// Terms that may have been meant in the place of an axiom's term.
std::vector<OtherTerm> other_terms(const EditSubject& subject, const AxiomForm& form, NodeId term);

/// Event and fluent of an effect with one argument of each exchanged.
std::vector<std::pair<std::string, std::string>> exchanged(const Ast& tree,
                                                           const EffectParts& parts,
                                                           const TypedModel& typed);

}  // namespace parallax::compiler
