#pragma once

#include <compare>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

struct GroundTermTag {
  static constexpr bool kOrdered = true;  // order of first construction
};
using GroundTermId = base::Id<GroundTermTag>;

/// A variable-free term: a constant, an integer, or a constructor over ground terms. The arguments
/// lie in the store.
struct GroundTerm {
  TermKind kind = TermKind::kInteger;  // kObject, kInteger or kApply
  ObjectId object;
  SymbolId symbol;
  std::uint32_t first_argument = 0, argument_count = 0;
  std::int64_t integer = 0;
};

/// Hash-consed ground terms: equal terms have equal ids (unique names).
class GroundTermStore {
 public:
  GroundTermStore();
  GroundTermId object(ObjectId id);
  GroundTermId integer(std::int64_t value);
  GroundTermId apply(SymbolId symbol, std::span<const GroundTermId> arguments);
  const GroundTerm& operator[](GroundTermId id) const { return terms_[id.index()]; }
  /// Valid until the next construction.
  std::span<const GroundTermId> arguments(GroundTermId id) const {
    const auto& term = terms_[id.index()];
    return std::span(pool_).subspan(term.first_argument, term.argument_count);
  }
  std::size_t size() const { return terms_.size(); }
  /// Printed without blanks, `On(cup1,table)`, `F()`, `3`.
  std::string text(GroundTermId id, const TypedModel& model) const;

 private:
  GroundTermId intern(const GroundTerm& term, std::span<const GroundTermId> arguments);
  bool equal(const GroundTerm& a, const GroundTerm& b,
             std::span<const GroundTermId> arguments) const;
  void grow();

  std::vector<GroundTerm> terms_;
  std::vector<GroundTermId> pool_;
  std::vector<std::uint32_t> table_;  // open addressing: index + 1; 0 means empty
};

}  // namespace parallax::compiler
