#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "compiler/reference/reference_evaluator.h"

namespace parallax::compiler {

/// Which axioms of a model a valuation makes use of, as indices into the typed model's.
class ReferenceUse {
 public:
  /// `evaluator`, which refuses nothing, outlives the object. Linear in the instances.
  explicit ReferenceUse(const ReferenceEvaluator& evaluator);

  struct Axioms {
    std::set<std::size_t> effects;  // an event happened while the condition held
    std::set<std::size_t> axioms;   // an event happened that an instance speaks of
  };
  Axioms of(const Valuation& valuation) const;

 private:
  const ReferenceEvaluator& evaluator_;
  /// By atom of an event: the axioms whose instances mention it.
  std::vector<std::pair<std::uint32_t, std::size_t>> mentions_;
};

}  // namespace parallax::compiler
