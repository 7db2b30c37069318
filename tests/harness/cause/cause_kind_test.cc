// Kinds of cause, distinguished by recorded runs.

#include "harness/cause/cause_kind.h"

#include <doctest/doctest.h>

namespace parallax::test {
namespace {

using harness::CauseFinding;
using harness::CauseKind;
using harness::CauseRun;

std::vector<CauseRun> runs(int count, bool (*failed)(int), double step = 1.0) {
  std::vector<CauseRun> out;
  for (int i = 0; i < count; ++i) out.push_back({{step * i}, failed(i)});
  return out;
}

TEST_CASE("each kind is known by its runs") {
  const auto kind = [](const std::vector<CauseRun>& list, bool is_model = false) {
    return harness::tell_cause(list, is_model).kind;
  };
  CHECK(kind(runs(1, [](int) { return true; })) == CauseKind::kUnknown);
  CHECK(kind(runs(10, [](int) { return true; })) == CauseKind::kAlways);
  CHECK(kind(runs(40, [](int i) { return i >= 30; })) == CauseKind::kRegion);
  // A search that finds no border does not show that there is none.
  CHECK(kind(runs(40, [](int i) { return i % 2 == 0; })) == CauseKind::kUnknown);
  CHECK(kind(runs(40, [](int i) { return i == 7; })) == CauseKind::kUnknown);
  // One start, several ends.
  const auto same = runs(
      20, [](int i) { return i % 3 == 0; }, 0.0);
  CHECK(kind(same) == CauseKind::kSimulator);
  CHECK(kind(same, true) == CauseKind::kRandom);
}

TEST_CASE("the sentence has the share, the parameter and the border") {
  const auto finding = harness::tell_cause(runs(40, [](int i) { return i >= 30; }), false);
  const auto words = harness::cause_words(finding, {"milk1.mass"});
  CHECK(words.find("100 % of the failures (10 of 10) have `milk1.mass` > 29") != std::string::npos);
  CHECK(words.find("0 % of the clean runs (0 of 30)") != std::string::npos);
  const auto open =
      harness::cause_words(harness::tell_cause(runs(
                                                   20, [](int i) { return i % 3 == 0; }, 0.0),
                                               true),
                           {"x"});
  CHECK(open.starts_with("From one and the same start some runs go wrong"));
}

TEST_CASE("what vanishes with another seed or half the step puts the simulator in doubt") {
  using harness::Persistence;
  const auto weighed = [](const std::vector<CauseRun>& list, std::optional<Persistence> seeds,
                          std::optional<Persistence> step) {
    auto finding = harness::tell_cause(list, false);
    harness::weigh_persistence(seeds, step, finding);
    return finding;
  };
  const auto few = runs(8, [](int i) { return i == 3; });
  CHECK(weighed(few, Persistence{5, 5}, Persistence{5, 5}).kind == CauseKind::kUnknown);
  CHECK(weighed(few, Persistence{5, 1}, Persistence{5, 5}).kind == CauseKind::kSimulator);
  const auto by_step = weighed(few, Persistence{5, 5}, Persistence{5, 0});
  CHECK(by_step.kind == CauseKind::kSimulator);
  const auto words = harness::cause_words(by_step, {"x"});
  CHECK(words ==
        "It happened in 1 of 8 runs, and the simulator is in doubt. From the failing start once "
        "more: with other seeds of the simulator it happens in 5 of 5 runs, with half its step it "
        "happens in 0 of 5 runs.");
  // A failure in all runs is stronger evidence.
  const auto always = runs(10, [](int) { return true; });
  CHECK(weighed(always, Persistence{5, 0}, std::nullopt).kind == CauseKind::kAlways);
  CHECK(weighed(few, std::nullopt, std::nullopt).kind == CauseKind::kUnknown);
  CHECK(weighed(few, Persistence{0, 0}, std::nullopt).kind == CauseKind::kUnknown);
}

}  // namespace
}  // namespace parallax::test
