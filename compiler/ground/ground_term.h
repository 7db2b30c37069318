#pragma once

#include <compare>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "compiler/sema/typed_model.h"

namespace parallax::compiler {

struct GroundTermTag {
  static constexpr bool kOrdered = true;  // order of first construction
};
using GroundTermId = base::Id<GroundTermTag>;

/// A variable-free term: a constant, an integer, or a constructor over ground terms.
struct GroundTerm {
  TermKind kind = TermKind::kInteger;  // kObject, kInteger or kApply
  ObjectId object;
  std::int64_t integer = 0;
  SymbolId symbol;
  std::vector<GroundTermId> arguments;
};

/// Hash-consed ground terms: equal terms have equal ids (unique names).
class GroundTermStore {
 public:
  GroundTermId object(ObjectId id);
  GroundTermId integer(std::int64_t value);
  GroundTermId apply(SymbolId symbol, std::vector<GroundTermId> arguments);
  const GroundTerm& operator[](GroundTermId id) const { return terms_[id]; }
  std::size_t size() const { return terms_.size(); }
  /// Printed without blanks, `On(cup1,table)`, `F()`, `3`.
  std::string text(GroundTermId id, const TypedModel& model) const;

 private:
  using Key = std::tuple<int, std::int64_t, std::vector<std::uint32_t>>;
  GroundTermId intern(Key key, GroundTerm term);
  base::Store<GroundTermId, GroundTerm> terms_;
  std::map<Key, GroundTermId> index_;
};

}  // namespace parallax::compiler
