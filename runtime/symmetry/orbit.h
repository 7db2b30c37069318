#pragma once

#include <gmpxx.h>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/symmetry/constant_group.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// What a trace is up to exchanging constants.
struct Orbit {
  /// Equal for two traces if and only if symmetries make one of the other.
  std::string form;
  mpz_class size;  // so many traces are of it
};

/// By what traces are told apart.
enum class Compared : std::uint8_t {
  kObserved,     // HoldsAt and Happens
  kEverything,   // also releases and user predicates
  kKey,          // of a plan or a state constraint: what happens, and what performs returned
  kKeyAndStart,  // and what holds at first
};

/// Tells orbits of traces apart. A trace is seen as a graph whose vertices are the constants and
/// whose coloured edges are its atoms; its form is the least that a permutation of the group gives
/// (search tree along the chain of stabilizers, whose nodes are partitions refined by what they are
/// connected to; McKay 1981, and Linton 2004 for images under a group), and how many permutations
/// leave it as it is (orbits of the tree's nodes, multiplied) gives the size.
class TraceOrbits {
 public:
  /// `group` outlives the orbits.
  TraceOrbits(const CompiledModel& model, const ConstantGroup& group, Compared compared);
  /// Exponential in the worst case, for traces that look alike from many constants that no exchange
  /// connects; a few refinements for others.
  Orbit of(const Trace& trace) const;

 private:
  /// An atom's name: what kind of atom it is, and which constants of the group are its arguments.
  struct Term {
    std::uint32_t kind = 0;
    std::vector<std::uint32_t> constants;
  };
  Term parse(const std::string& name);

  const ConstantGroup& group_;
  std::map<std::string, std::uint32_t, std::less<>> constants_, kinds_;
  std::vector<Term> fluents_, events_;
  std::map<std::string, Term, std::less<>> predicates_, returned_;
  Compared compared_;
  mpz_class order_;
};

}  // namespace parallax::runtime
