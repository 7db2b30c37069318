#pragma once

#include <optional>
#include <span>
#include <vector>

#include "runtime/session/solver_session.h"

namespace parallax::runtime {

/// In which share of the traces an atom is true.
enum class Extent : std::uint8_t {
  kNone,
  kSome,  // in one, and not in another
  kAll,
  kNotAll,     // not in one; whether in another was not asked
  kAbsent,     // no trace has its timepoint
  kUndecided,  // the solver was stopped
};

/// Facts that the traces of a model have in common: its backbone and beyond. Traces end at the
/// horizon, or where state constraints hold for the first time; for an atom only traces that have
/// its timepoint count.
struct Consequences {
  /// One for each atom asked about.
  std::vector<Extent> extents;
  /// Is there a trace? None: the solver was stopped before one was found.
  std::optional<bool> any;
  bool complete = true;  // nothing is undecided
};

enum class Asked : std::uint8_t {
  kAllAndSome,
  kAll,  // only which atoms are true in all traces
};

/// Asks about HoldsAt and Happens atoms. Every valuation found settles all atoms that differ from
/// one found before; the solver is then asked to let some other one differ, until it cannot
/// (Janota, Lynce and Marques-Silva 2015, iterative algorithm with chunks that hold all
/// candidates). At most one call for each atom that is true in some only, and two for each length
/// of traces.
Consequences find_consequences(SolverSession& session, std::span<const Literal> atoms,
                               Asked asked = Asked::kAllAndSome);

}  // namespace parallax::runtime
