#pragma once

#include <string>

namespace parallax::tools {

/// CaDiCaL and nothing else: reads a DIMACS file with the solver's own reader and solves it once.
/// The exit code of a SAT competition program: 10 satisfiable, 20 unsatisfiable; 1 if the file
/// cannot be read.
int solve_plainly(const std::string& file);

}  // namespace parallax::tools
