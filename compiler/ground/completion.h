#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "compiler/ground/ground_model.h"

namespace parallax::compiler {

/// Predicate completion over ground formulas. A completed atom is true only where some formula of
/// the completion's label would be false without it: for each such formula G in which the atom p
/// occurs positively, not G[p := false] is a reason for p, and p implies one of its reasons
/// (pointwise circumscription, Lifschitz 1986; for axioms of the form `body -> P(..)` this is the
/// predicate completion of Mueller 2006, Theorem 2.1, and for a disjunction of two completed
/// events it makes them exclusive).
class CompletionWriter {
 public:
  CompletionWriter(GroundModel& model, Meaning meaning);
  /// Notes a conjunct of an axiom with this label (empty without one). Call for every axiom.
  void note(const std::string& label, FormulaId formula);
  /// Asserts the completions: false for atoms without a reason.
  void write();

 private:
  struct Completed {
    std::size_t completion = 0;  // index into the typed model's completions
    std::vector<FormulaId> reasons;
  };
  void note_conjunct(const std::string& label, FormulaId formula);
  bool applies(std::size_t completion, const std::string& label) const;
  void prepare();
  void drop_facts(std::vector<FormulaId>& reasons) const;

  GroundModel& model_;
  Meaning meaning_;
  std::vector<std::uint32_t> origins_;           // by completion
  std::map<std::int32_t, Completed> completed_;  // by SAT variable
};

}  // namespace parallax::compiler
