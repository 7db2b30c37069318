#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <numeric>
#include <utility>
#include <vector>

#include "runtime/session/solver_session.h"
#include "tests/support/text_model.h"

namespace parallax::test {
namespace {

constexpr const char* kClash =
    "range time 0 1\nfluent F()\nfluent G()\n"
    "HoldsAt(F(),0).\nHoldsAt(G(),0).\n!HoldsAt(F(),0).\n!HoldsAt(G(),0).\n";

std::vector<std::uint32_t> all_origins(const TextModel& model) {
  std::vector<std::uint32_t> all(model.compiled.origins.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

TEST_CASE("what is needed contradicts itself, and what is tried first goes first") {
  const TextModel model(kClash);
  REQUIRE(model.codes() == "");
  const auto lines_of = [&](std::vector<std::uint32_t> candidates) {
    runtime::SelectedOrigins selected(model.compiled, 1, runtime::make_cadical_solver());
    REQUIRE(selected.solve(candidates) == runtime::SolveStatus::kUnsatisfiable);
    const auto needed = runtime::shrink_to_needed(selected, std::move(candidates));
    CHECK_FALSE(needed.stopped);
    CHECK(selected.solve(needed.origins) == runtime::SolveStatus::kUnsatisfiable);
    std::vector<std::uint32_t> lines;
    for (const auto index : needed.origins) {
      const auto& source = model.compiled.origins[index].source;
      lines.push_back(model.files[source.file].position(source.begin).line);
    }
    return lines;
  };
  auto candidates = all_origins(model);
  // The last origin is tried while both clashes are there.
  CHECK(lines_of(candidates) == std::vector<std::uint32_t>{4, 6});
  std::reverse(candidates.begin(), candidates.end());
  CHECK(lines_of(candidates) == std::vector<std::uint32_t>{5, 7});
}

TEST_CASE("what a stopped solver has not tried counts as needed") {
  const TextModel model(kClash);
  REQUIRE(model.codes() == "");
  std::atomic<bool> stop = false;
  runtime::SelectedOrigins selected(model.compiled, 1, runtime::make_cadical_solver(&stop));
  const auto all = all_origins(model);
  REQUIRE(selected.solve(all) == runtime::SolveStatus::kUnsatisfiable);
  stop = true;
  const auto needed = runtime::shrink_to_needed(selected, all);
  CHECK(needed.stopped);
  CHECK(needed.origins == all);
}

}  // namespace
}  // namespace parallax::test
