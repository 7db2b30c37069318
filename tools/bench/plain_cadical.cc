#include <cadical.hpp>

#include "tools/bench/bench.h"

namespace parallax::tools {

int solve_plainly(const std::string& file) {
  CaDiCaL::Solver solver;
  int variables = 0;
  if (solver.read_dimacs(file.c_str(), variables, 1) != nullptr) return 1;
  return solver.solve();
}

}  // namespace parallax::tools
