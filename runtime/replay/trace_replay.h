#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "runtime/session/solver_session.h"
#include "runtime/trace/trace.h"
#include "runtime/trace/trace_claims.h"

namespace parallax::runtime {

/// How a trace from elsewhere stands to a model.
struct ReplayVerdict {
  enum class Kind : std::uint8_t {
    kAgrees,      // it is a trace of the model, with values for the atoms that it does not mention
    kFails,       // up to `timepoint` no values of the other atoms make it one; behind its end: no
                  // trace of the model goes on from it that far
    kNoFirstHit,  // it is one, but does not end where the state constraints first hold
    kUnknown      // the solver was stopped
  };
  Kind kind = Kind::kUnknown;
  Trace completion;         // kAgrees: all atoms
  std::int64_t hidden = 0;  // HoldsAt, Happens, ReleasedAt and user predicates that it leaves open
  Timepoint timepoint = 0;  // kFails; kNoFirstHit: where they hold too early, or the end
  /// kFails: an atom is said to be true that is false in every trace of the model.
  std::optional<AtomClaim> impossible;
  std::string impossible_atom;
};

/// Checks traces against a compiled model with a solver: the claims of a trace are assumed, and the
/// solver finds values of everything else.
class TraceReplay {
 public:
  using MakeSolver = std::function<std::unique_ptr<SatSolver>()>;
  /// `model` outlives the replay.
  TraceReplay(const CompiledModel& model, MakeSolver make_solver);

  /// The lengths that traces of the model can have.
  std::pair<Timepoint, Timepoint> lengths() const;
  /// `trace` has one of these lengths and names atoms of the model only. One solver call if the
  /// trace agrees and ends at the horizon, two if it ends before, else one for each timepoint.
  ReplayVerdict replay(const ClaimedTrace& trace);
  /// For a trace that fails at `timepoint`: origins of the model that cannot hold together with its
  /// claims. Copies the model.
  UnsatCore blame(const ClaimedTrace& trace, Timepoint timepoint) const;

 private:
  struct Unit {
    Literal literal;
    Timepoint needed;  // the least horizon at which the atom exists
  };
  struct Units {
    std::vector<Unit> said;
    std::int64_t hidden = 0;
  };

  Units units_of(const ClaimedTrace& trace) const;
  std::optional<ReplayVerdict> impossible_claim(const ClaimedTrace& trace) const;
  SolveStatus solve(const Units& units, Timepoint n, std::span<const Literal> more);
  ReplayVerdict find_failure(const Units& units, Timepoint first, Timepoint last);
  ReplayVerdict find_end(const Units& units, Timepoint length);

  const CompiledModel* model_;
  MakeSolver make_solver_;
  SolverSession session_;
  compiler::AtomIndex index_;
  Symbols symbols_;
  std::unordered_set<std::string> never_holds_, never_happens_, never_released_;  // look-up only
};

}  // namespace parallax::runtime
