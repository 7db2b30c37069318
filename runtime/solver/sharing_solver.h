#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <vector>

#include "runtime/solver/sat_solver.h"

namespace parallax::runtime {

/// A solver that hands out the clauses that it learns. Each clause follows from the clauses of the
/// solver alone, whatever was assumed.
class SharingSolver : public SatSolver {
 public:
  /// The short clauses that it has learned since the last time, in the order in which it did.
  virtual std::vector<std::vector<Literal>> take_learned() = 0;
};

/// CaDiCaL as by make_cadical_solver; it keeps learned clauses of up to `longest` literals.
std::unique_ptr<SharingSolver> make_sharing_solver(std::size_t longest,
                                                   const std::atomic<bool>* stop = nullptr);

}  // namespace parallax::runtime
