// Recorded bounds of speed: how they are read, and when a row counts as slow.

#include "tools/bench/bounds.h"

#include <doctest/doctest.h>

namespace parallax::test {
namespace {

using tools::BoundVerdict;
using tools::judge_build;
using tools::judge_question;

TEST_CASE("bounds are read as they are written") {
  tools::Bounds bounds;
  bounds.questions = {{"count a", 0.5}, {"list b", 12.34}};
  bounds.builds = {{"all", 300.0}};
  std::string error;
  const auto read = tools::parse_bounds(tools::to_json(bounds), error);
  REQUIRE(read);
  CHECK(read->builds == bounds.builds);
  CHECK(read->questions.at("count a") == 0.5);
  CHECK(read->questions.at("list b") == 12.3);
}

TEST_CASE("a file of bounds that guards nothing is refused") {
  for (const auto* text :
       {"", "[]", "{}", "{\"questions\":{}}", "{\"questions\":[],\"builds\":{}}",
        "{\"questions\":{\"a\":0},\"builds\":{}}", "{\"questions\":{\"a\":-1},\"builds\":{}}",
        "{\"questions\":{\"a\":\"1\"},\"builds\":{}}",
        "{\"questions\":{\"a\":null},\"builds\":{}}"}) {
    CAPTURE(text);
    std::string error;
    CHECK_FALSE(tools::parse_bounds(text, error));
    CHECK_FALSE(error.empty());
  }
}

TEST_CASE("a question is slow from one and a quarter times its recorded cost on") {
  CHECK(judge_question(1.24, 1.0) == BoundVerdict::kWithin);
  CHECK(judge_question(1.25, 1.0) == BoundVerdict::kExceeded);
  CHECK(judge_question(0.5, 1.0) == BoundVerdict::kFaster);
  CHECK(judge_question(0.81, 1.0) == BoundVerdict::kWithin);
  CHECK(judge_question(1.0, std::nullopt) == BoundVerdict::kUnknown);
}

TEST_CASE("a build is told from a tenth longer on, and fails from a quarter on") {
  CHECK(judge_build(1.09, 1.0) == BoundVerdict::kWithin);
  CHECK(judge_build(1.11, 1.0) == BoundVerdict::kLonger);
  CHECK(judge_build(1.26, 1.0) == BoundVerdict::kExceeded);
  CHECK(judge_build(0.8, 1.0) == BoundVerdict::kFaster);
  CHECK(judge_build(1.0, std::nullopt) == BoundVerdict::kUnknown);
}

}  // namespace
}  // namespace parallax::test
