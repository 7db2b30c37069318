#pragma once

#include <filesystem>
#include <regex>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {

namespace fs = std::filesystem;

inline constexpr const char* kLamp =
    "range time 0 1\n"
    "fluent On()\n"
    "event Press()\n"
    "[time] Initiates(Press(),On(),time).\n"
    "!HoldsAt(On(),0).\n";  // pressed or not: two traces

/// A folder `s` with a model of two traces and a manifest of two cases.
class SuiteFixture : public CliFixture {
 public:
  SuiteFixture() {
    fs::create_directories(folder() / "s");
    write("s/lamp.e", kLamp);
    write("s/suite.yaml",
          "cases:\n"
          "  - id: both\n"
          "    model: lamp.e\n"
          "    expect: {traces: 2, golden: expected/both.txt}\n"
          "  - id: lit\n"
          "    model: lamp.e\n"
          "    constraints: HoldsAt(On(),time)\n"
          "    expect: {traces: 1}\n");
  }
  ProcessResult suite(const std::vector<std::string>& arguments) const {
    return suite_with({}, arguments);
  }
  ProcessResult suite_under_ci(const std::vector<std::string>& arguments) const {
    return suite_with({"CI=true"}, arguments);
  }

 private:
  /// `env SETTINGS... parallax suite s ARGUMENTS...`
  ProcessResult suite_with(const std::vector<std::string>& settings,
                           const std::vector<std::string>& arguments) const {
    std::vector<std::string> command = {"/usr/bin/env"};
    command.insert(command.end(), settings.begin(), settings.end());
    command.insert(command.end(), {std::string(PARALLAX_BINARY_DIR) + "/parallax", "suite", "s"});
    command.insert(command.end(), arguments.begin(), arguments.end());
    ProcessOptions options;
    options.folder = folder().string();
    return run_process(command, options);
  }
};

inline bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A JUnit report without the parts that differ between two runs of an unchanged suite: times, and
/// whether a result was taken over.
inline std::string without_times(std::string junit) {
  static const std::regex time(R"( (time|timestamp)="[^"]*")");
  static const std::regex reused(" *<system-out>(cached|resumed)</system-out>\n");
  junit = std::regex_replace(junit, time, "");
  return std::regex_replace(junit, reused, "");
}

}  // namespace parallax::test
