#include <doctest/doctest.h>

#include <algorithm>

#include "tests/compiler/artifact/written_model.h"
#include "tests/support/random_model.h"

namespace parallax::test {
namespace {

std::size_t stored_literals(const compiler::CompiledModel& model) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < model.clauses.size(); ++i) count += model.clauses[i].size();
  return count;
}

std::string with_horizon(std::string text, const std::string& old, int horizon) {
  const auto range = "range time 0 " + old + "\n";
  const auto at = text.find(range);
  REQUIRE(at != std::string::npos);
  return text.replace(at, range.size(), "range time 0 " + std::to_string(horizon) + "\n");
}

}  // namespace

TEST_CASE("a folded model is written as the model with all copies") {
  std::size_t compiled = 0, smaller = 0;
  const auto check = [&](const std::string& text) {
    CAPTURE(text);
    const WrittenModel all(text), folded(text, true);
    REQUIRE(folded.codes() == all.codes());
    if (all.ground == nullptr) return;
    ++compiled;
    if (folded.compiled.clauses.size() < all.compiled.clauses.size()) ++smaller;
    CHECK(folded.compiled.clause_count() == all.compiled.clauses.size());
    for (const bool projection : {true, false}) {
      CHECK(compiler::to_artifact(folded.compiled, {projection}) ==
            compiler::to_artifact(all.compiled, {projection}));
    }
  };
  check(kReleases);
  check(kFall);
  for (const int horizon : {0, 1, 2, 40}) check(with_horizon(kReleases, "3", horizon));
  for (std::uint64_t seed = 1; seed <= 300; ++seed) check(random_model(seed, kSolverSize).print());
  CHECK(compiled > 100);
  CHECK(smaller > 50);
}

TEST_CASE("what a folded model holds, and the pieces of its text, do not grow with the horizon") {
  const WrittenModel model(with_horizon(kReleases, "3", 50), true);
  REQUIRE(model.codes() == "");
  for (const int horizon : {500, 5000}) {
    const WrittenModel longer(with_horizon(kReleases, "3", horizon), true);
    CHECK(stored_literals(longer.compiled) == stored_literals(model.compiled));
    CHECK(longer.compiled.clause_count() > 9 * model.compiled.clause_count());
    std::size_t largest = 0, bytes = 0;
    std::string whole;
    compiler::write_artifact(longer.compiled, {}, [&](std::string_view piece) {
      largest = std::max(largest, piece.size());
      bytes += piece.size();
      whole += piece;
    });
    CHECK(largest < 100'000);
    if (horizon == 5000) CHECK(bytes > 10 * largest);
    const ReadText read(whole);
    REQUIRE_MESSAGE(read.model, read.codes());
    CHECK(compiler::to_artifact(*read.model) == whole);
  }
}

}  // namespace parallax::test
