#pragma once

#include <atomic>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>

#include "compiler/artifact/literal.h"
#include "compiler/base/known.h"

namespace parallax::runtime {

using compiler::Literal;

/// Three answers, and no way to take the third for one of the others: what asks whether something
/// is possible answers with `possible`.
enum class [[nodiscard]] SolveStatus : std::uint8_t{
    kSatisfiable, kUnsatisfiable,
    kUnknown,  // interrupted or out of its budget
};

/// Is there a solution, according to the status?
inline base::Known possible(SolveStatus status) {
  switch (status) {
    case SolveStatus::kSatisfiable:
      return base::Known::kYes;
    case SolveStatus::kUnsatisfiable:
      return base::Known::kNo;
    case SolveStatus::kUnknown:
      break;
  }
  return base::Known::kUndecided;
}

/// An incremental SAT solver.
///
///          add_clause, assume            solve() == kSatisfiable
///        +--------------------+        +--------------------------> SATISFIED: value()
///        v                    |        |
///      READY ----- solve() -----------+---------------------------> FAILED: failed()
///        ^                             |   kUnsatisfiable
///        +---- add_clause, assume -----+--------------------------> READY  (kUnknown)
///
/// Assumptions hold for one call of solve. Asking value() outside SATISFIED or failed() outside
/// FAILED violates the contract.
class SatSolver {
 public:
  virtual ~SatSolver() = default;
  virtual void add_clause(std::span<const Literal> clause) = 0;
  virtual void assume(Literal literal) = 0;
  virtual SolveStatus solve() = 0;
  /// Value of a literal in the model that was found.
  virtual bool value(Literal literal) const = 0;
  /// Is this assumption among those that made the formula unsatisfiable?
  virtual bool failed(Literal literal) const = 0;
  /// Is the literal true whatever is assumed, as far as the solver knows? Never wrong, may miss
  /// some.
  virtual bool is_fixed(Literal literal) const = 0;
  /// The value that the search tries first.
  virtual void set_phase(Literal literal) = 0;
  /// The next call of solve answers kUnknown after this many conflicts. Unlike time, this is the
  /// same on every machine.
  virtual void limit_conflicts(std::int64_t most) = 0;
  /// Conflicts so far: clauses that were learned.
  virtual std::int64_t conflicts() const = 0;
  /// Calls of solve so far.
  virtual std::int64_t solve_calls() const = 0;
};

/// CaDiCaL in its default configuration. A call of solve that is under way when `stop` is raised
/// answers kUnknown soon; `stop` may be null and outlives the solver.
std::unique_ptr<SatSolver> make_cadical_solver(const std::atomic<bool>* stop = nullptr);

/// The same solver until it has met this many conflicts in all; then every call that needs more
/// answers kUnknown. Unlike a limit on time, this is the same on every machine.
std::unique_ptr<SatSolver> make_limited_solver(std::unique_ptr<SatSolver> solver,
                                               std::int64_t conflicts);

enum class ProofForm : std::uint8_t { kBinary, kText };

enum class ProofUse : std::uint8_t {
  kOneCall,
  /// Without eliminating and substituting variables: a later call may bring their clauses back, and
  /// CaDiCaL does not write that down.
  kIncremental,
};

/// The same solver; clauses that it learns and deletes go to `proof` as DRAT, until it finds a
/// contradiction that rests on no assumption. The stream outlives the solver; the caller flushes it
/// and asks for errors.
std::unique_ptr<SatSolver> make_proving_solver(std::FILE* proof, ProofForm form,
                                               const std::atomic<bool>* stop = nullptr,
                                               ProofUse use = ProofUse::kOneCall);

}  // namespace parallax::runtime
