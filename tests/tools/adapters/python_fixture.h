#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <iostream>
#include <string>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {

/// Says on a line of its own that a test did not happen; false where there is Python.
inline bool skipped_without_python() {
  if (run_process({"sh", "-c", "command -v python3"}).code == 0) return false;
  std::cout << "SKIPPED: there is no python3\n";
  return true;
}

/// A folder with the Python adapter and its example.
class PythonFixture : public CliFixture {
 public:
  PythonFixture() {
    namespace fs = std::filesystem;
    const fs::path source = fs::path(PARALLAX_PYTHON_ADAPTER);
    fs::copy_file(source / "parallax_adapter.py", folder() / "parallax_adapter.py");
    fs::copy(source / "examples", folder());
  }

  /// Answers to the requests of a simulator of these lines, with the adapter imported and
  /// `sim.run()` at the end. Its standard error is in `errors`.
  std::string answers(const std::string& program, const std::string& requests) {
    write("program.py", "from parallax_adapter import *\n" + program + "\nsim.run()\n");
    write("requests", requests);
    ProcessOptions options;
    options.folder = folder().string();
    const auto result = run_process({"sh", "-c", "exec python3 -B program.py < requests"}, options);
    errors = result.err;
    return result.out;
  }

  std::string errors;
};

}  // namespace parallax::test
