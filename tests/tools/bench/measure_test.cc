// How tools/bench runs programs, reads their answers and prints rows.

#include "tools/bench/measure.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/bench/child_run.h"
#include "tools/bench/measure.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using tools::Cost;
using tools::Row;
using tools::Side;

/// A file for a program's output, removed at the end.
struct OutputFile {
  std::string path =
      (fs::temp_directory_path() / ("parallax_measure_test_" + std::to_string(::getpid())))
          .string();
  ~OutputFile() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

TEST_CASE("a run has an exit code, the end of its output, its size and its cost") {
  const OutputFile output;
  const auto run =
      tools::run_child({"sh", "-c", "head -c 100000 /dev/zero; echo end; exit 7"}, {output.path});
  REQUIRE(run);
  CHECK(run->code == 7);
  CHECK(!run->stopped);
  CHECK(run->cost.output_mb == doctest::Approx(0.100004));
  CHECK(run->tail.size() == tools::kTailBytes);
  CHECK(run->tail.ends_with("end\n"));
  CHECK(run->cost.wall_s > 0);
  CHECK(run->cost.peak_mb > 0.1);
}

TEST_CASE("a program that is not there ends with 127, one beyond its limit is stopped") {
  const OutputFile output;
  CHECK(tools::run_child({"/nowhere/no-such-program"}, {output.path})->code == 127);
  const auto stopped = tools::run_child({"sleep", "1000"}, {output.path, "", 0.05});
  REQUIRE(stopped);
  CHECK(stopped->stopped);
  CHECK(stopped->code == 128 + 9);
  const auto busy = tools::run_child({"sh", "-c", "while :; do :; done"}, {output.path, "", 1.0});
  REQUIRE(busy);
  CHECK(busy->stopped);
  CHECK(!tools::run_child({"true"}, {"/nowhere/output"}));
}

TEST_CASE("a side says why it has no figures") {
  const OutputFile output;
  tools::MeasureOptions options;
  options.repetitions = 3;
  options.time_limit_s = 0.05;
  const auto sides = tools::measure({{"good", {"/bin/echo", "12"}, "", {0}, {}},
                                     {"absent", {"/nowhere/x"}, "", {0}, {}},
                                     {"failing", {"false"}, "", {0}, {}},
                                     {"slow", {"sleep", "1000"}, "", {0}, {}}},
                                    output.path, options);
  REQUIRE(sides.size() == 4);
  CHECK(sides[0].cost);
  CHECK(sides[0].runs == 3);
  CHECK(sides[0].command == "echo 12");
  CHECK(sides[1].remark == "not installed");
  CHECK(sides[2].remark.starts_with("ended with code 1"));
  CHECK(sides[3].remark.starts_with("no end within"));
  for (std::size_t i = 1; i < 4; ++i) CHECK(!sides[i].cost);
}

TEST_CASE("the median is the middle value") {
  CHECK(tools::median({3, 1, 2}) == 2);
  CHECK(tools::median({5}) == 5);
  CHECK(tools::median({4, 1, 3, 2}) == 3);
}

TEST_CASE("answers are read from the end of the output, or are empty") {
  CHECK(tools::clingo_answer("Answer: 1\n\nSATISFIABLE\n\nModels       : 3488\nCalls : 1\n") ==
        "3488");
  CHECK(tools::clingo_answer("Models in an atom's name\n").empty());
  CHECK(tools::jsonl_answer(
            "{\"trace\":7}\n{\"summary\":true,\"traces\":42,\"complete\":true}\n") == "42");
  CHECK(tools::jsonl_answer("{\"trace\":7,\"traces\":1").empty());
  CHECK(tools::clingo_consequences("Consequences: [9;11]\n\n  Cautious   : yes\nConsequences : 11\n"
                                   "Calls : 1\n") == "11");
  CHECK(tools::clingo_consequences("Consequences: [9;11]\n").empty());
  const std::string counts =
      "{\"always\":4,\"counts\":{\"always\":11,\"sometimes\":7,\"never\":30}}";
  CHECK(tools::consequences_answer(counts, {"always"}) == "11");
  CHECK(tools::consequences_answer(counts, {"always", "sometimes"}) == "18");
  CHECK(tools::consequences_answer("{\"always\":4}", {"always"}).empty());
  CHECK(tools::count_answer("1759222\n") == "1759222");
  CHECK(tools::count_answer("error\n").empty());
}

Side side(std::string answer, double cpu_s) {
  return {"program", "command", Cost{9.0, cpu_s, 10.0, 0.0}, 5, std::move(answer), ""};
}

TEST_CASE("rows compare times and answers of those who have some") {
  Row row{"section", "row", {side("42", 2.0), side("42", 5.0)}, "42", ""};
  CHECK(row.agrees());
  CHECK(!row.ratio(0));
  CHECK(*row.ratio(1) == doctest::Approx(2.5));
  CHECK(!row.ratio(2));
  CHECK(tools::to_text(row).find("= 2.50 x ours") != std::string::npos);

  row.sides.push_back({"absent", "", std::nullopt, 0, "", "not installed"});
  CHECK(row.agrees());
  CHECK(!row.ratio(2));
  CHECK(tools::to_text(row).find("not installed") != std::string::npos);

  row.sides.push_back(side("43", 1.0));
  CHECK(!row.agrees());
  CHECK(tools::to_text(row).find("ANSWERS DIFFER") != std::string::npos);

  const auto json = nlohmann::json::parse(tools::to_json({row}));
  REQUIRE(json["rows"].size() == 1);
  CHECK(json["rows"][0]["agrees"] == false);
  CHECK(json["rows"][0]["sides"][1]["ratio"].get<double>() == doctest::Approx(2.5));
  CHECK(json["rows"][0]["sides"][2]["remark"] == "not installed");
  CHECK(!json["rows"][0]["sides"][2].contains("wall_s"));
}

TEST_CASE("a section comes to geometric means, with the best row of each peer named") {
  const auto named = [](std::string program, double cpu_s) {
    auto out = side("42", cpu_s);
    out.program = std::move(program);
    return out;
  };
  const Row dear{"s",
                 "dear",
                 {side("42", 1.0), named("clingo, auto", 16.0), named("clingo, handy", 8.0)},
                 "42",
                 ""};
  Row cheap{"s",
            "cheap",
            {side("42", 1.0), named("clingo, auto", 1.0), named("clingo, handy", 2.0)},
            "42",
            ""};
  const auto text = tools::summary_text({dear, cheap});
  CHECK(text.find("best of clingo's 2.83 x ours in 2 rows, least 1.00: cheap") !=
        std::string::npos);
  CHECK(text.find("clingo, auto     4.00 x ours in 2 rows, least 1.00: cheap") !=
        std::string::npos);
  CHECK(text.find("clingo, handy    4.00 x ours in 2 rows, least 2.00: cheap") !=
        std::string::npos);
  cheap.sides[1].cost.reset();
  cheap.sides[1].remark = "no end within 60 s of cpu";
  const auto without = tools::summary_text({dear, cheap});
  CHECK(without.find("clingo, auto     16.00 x ours in 1 rows, least 16.00: dear; no end in 1") !=
        std::string::npos);
  CHECK(tools::summary_text({dear}).empty());
}

TEST_CASE("an answer that is wrong on all sides is seen") {
  const Row row{"section", "row", {side("41", 2.0), side("41", 5.0)}, "42", ""};
  CHECK(!row.agrees());
}

}  // namespace
}  // namespace parallax::test
