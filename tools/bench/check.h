#pragma once

#include <string>

namespace parallax::tools {

struct CheckOptions {
  std::string bounds;        // the file of bounds
  double build_cpu_s = 0.0;  // processor time of a build from nothing; 0: not checked
  bool record = false;       // write what was measured into `bounds`
};

/// Counts the instructions of cheap questions and holds them against the recorded ones, in about
/// two minutes. Needs valgrind. Returns an exit code: 1 where one is slow, answers wrongly or is
/// not recorded, 3 if the file of bounds cannot be read.
int check_bounds(const CheckOptions& options);

}  // namespace parallax::tools
