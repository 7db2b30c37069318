#pragma once

#include <gmpxx.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/symmetry/constant_group.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// Orbit of a trace under exchanging constants.
struct Orbit {
  /// Equal for two traces if and only if symmetries turn one into the other.
  std::string form;
  mpz_class size;  // number of traces in the orbit
};

/// Atoms by which traces are told apart.
enum class Compared : std::uint8_t {
  kObserved,     // HoldsAt and Happens
  kEverything,   // also releases and user predicates
  kKey,          // the key of a plan or a state constraint: events, and returned objects
  kKeyAndStart,  // the key, and the fluents that hold at first
};

/// Tells orbits of traces apart. A trace is seen as a graph whose vertices are the constants and
/// whose coloured edges are its atoms. Its form is the least that a permutation of the group gives
/// (search tree along the chain of stabilizers, whose nodes are partitions refined by their
/// connections; McKay 1981, and Linton 2004 for images under a group). Its size follows from the
/// number of permutations that leave it as it is (orbits of the tree's nodes, multiplied).
class TraceOrbits {
 public:
  /// `group` outlives the orbits.
  TraceOrbits(const CompiledModel& model, const ConstantGroup& group, Compared compared);
  /// Cost: exponential in the worst case, for traces that look alike from many constants that no
  /// exchange connects; a few refinements for others.
  Orbit of(const Trace& trace) const;

 private:
  /// An atom's name: the kind of atom, and the constants of the group among its arguments.
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
