// The logic programs of tools/bench that are written by hand have as many answer sets as the
// models have traces.

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iostream>

#include "tests/support/process.h"
#include "tests/tools/bench/path_count.h"
#include "tools/bench/child_run.h"
#include "tools/bench/families/families.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

/// Clingo's count of the answer sets; its messages about the program are part of the answer.
std::string answer_sets(const std::string& name) {
  const auto file =
      fs::temp_directory_path() / ("parallax_tuned_" + std::to_string(::getpid()) + ".lp");
  std::ofstream(file) << tools::family_program(name).value();
  const auto result = run_process({"clingo", file.string(), "0", "-q"});
  fs::remove(file);
  return tools::clingo_answer(result.out) + result.err;
}

TEST_CASE("programs by hand: as many answer sets as the models have traces") {
  if (run_process({"clingo", "--version"}).code != 0) {
    std::cout << "SKIPPED: clingo is not installed\n";
    return;
  }
  CHECK(answer_sets("lamps_2_3") == "16");
  CHECK(answer_sets("distant_2_4") == "36");
  CHECK(answer_sets("pigeon_3_4") == "24");
  CHECK(answer_sets("pigeon_4_3") == "0");
  CHECK(answer_sets("ringed_3_4") == "24");
  CHECK(answer_sets("ringed_4_3") == "0");
  CHECK(answer_sets("chain_8") == "0");
  CHECK(answer_sets("falling_5") == "1");
  CHECK(answer_sets("bankproj_3_12_3_8") == "1");
  CHECK(answer_sets("bankplan_3_6_2_3") == std::to_string(transfer_series(3, 6, 2, 3)));
  CHECK(answer_sets("robot_3_2_1") == std::to_string(robot_courses(3, 2, 1)));
  CHECK(answer_sets("robot_4_2_m1") == "0");
  CHECK(answer_sets("hanoi_2_5") == std::to_string(hanoi_courses(2, 5)));
  CHECK(answer_sets("grid_3_2_4") == std::to_string(grid_courses(3, 2, 4)));
  CHECK(answer_sets("logistics_2_2_2_4") == std::to_string(logistics_courses(2, 2, 2, 4)));
  CHECK(answer_sets("roaming_3_2_3") == std::to_string(roaming_courses(3, 2, 3)));
}

}  // namespace
}  // namespace parallax::test
