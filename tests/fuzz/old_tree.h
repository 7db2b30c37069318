#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace parallax::test {

/// A ground formula as the encoder of 2005 has it: lists of lists, equal if they print the same.
struct OldTree {
  enum class Kind : std::uint8_t { kTrue, kFalse, kAtom, kNot, kAnd, kOr, kImplies, kEquiv };
  Kind kind = Kind::kTrue;
  std::string atom;        // kAtom, printed
  bool is_beyond = false;  // kAtom: it lies outside a range or a sort
  std::vector<OldTree> parts;

  static OldTree constant(bool value) {
    return {value ? Kind::kTrue : Kind::kFalse, {}, false, {}};
  }
  static OldTree atom_of(std::string text, bool beyond = false) {
    return {Kind::kAtom, std::move(text), beyond, {}};
  }
  static OldTree of(Kind kind, std::vector<OldTree> parts) {
    return {kind, {}, false, std::move(parts)};
  }
  bool is(Kind wanted) const { return kind == wanted; }
  std::string print() const;
  /// Does some atom lie outside a range or a sort?
  bool has_beyond() const;
};

/// A conjunction with a false part is false, a disjunction with a true part true, before anything
/// else is looked at.
OldTree old_conjunction(std::vector<OldTree> parts);
OldTree old_disjunction(std::vector<OldTree> parts);

/// Negations at the atoms, constants and repeated parts gone; equivalences stay, or become two
/// disjunctions.
OldTree simplified(const OldTree& tree, bool expand_equivalences);

/// A literal: the atom's text, negative with a `!` in front.
using OldClause = std::vector<std::string>;
/// Clauses by distribution. False: naming parts would give fewer, so that is what happens.
bool distributed(const OldTree& simple, std::vector<OldClause>& clauses);

}  // namespace parallax::test
