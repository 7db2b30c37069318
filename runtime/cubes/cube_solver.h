#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

struct CubeOptions {
  /// Threads at most. What is found does not depend on it.
  std::int64_t jobs = 1;
  /// A call that takes more conflicts than this is cut into cubes.
  std::int64_t easy = 5'000;
  /// Conflicts of each lane between two exchanges.
  std::int64_t round = 2'000;
  /// Solvers that work on cubes; more threads than these are of no use.
  std::size_t lanes = 2;
  const std::atomic<bool>* stop = nullptr;
};

/// CaDiCaL for easy calls, several of them for hard ones. A call is first given to one solver. If
/// it does not decide within `easy` conflicts, the question is split by one variable after the
/// other, until every lane (a solver of its own) has a cube: literals that it assumes besides. A
/// lane that has refuted its cube takes half of another one's. The lanes work in rounds of a fixed
/// number of conflicts, and after each one exchange the short clauses that they learned. Work is
/// counted, not timed: the answer, and the valuation found, is that of the first round in which a
/// lane finds one, and there of the first lane, whatever the number of threads. Easy calls are
/// answered as by make_cadical_solver, byte for byte. Memory: its own clauses once more, and from
/// the first hard call on a solver for each lane. limit_conflicts and conflicts mean those of all
/// lanes together; the last round may exceed a limit by a few.
std::unique_ptr<SatSolver> make_cube_solver(const CubeOptions& options);

/// `make_cube_solver` where somebody asked for `jobs` threads, else (0) `make_cadical_solver`.
std::unique_ptr<SatSolver> make_solver_for_jobs(std::int64_t jobs, const std::atomic<bool>* stop);

}  // namespace parallax::runtime
