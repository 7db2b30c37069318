#include <doctest/doctest.h>

#include <cmath>

#include "harness/geometry_proof/certificate.h"
#include "harness/robot/ode_simulator.h"
#include "harness/sampling/sampler.h"
#include "tools/bench/proof/proof_worlds.h"

namespace parallax::harness {
namespace {

struct Proved {
  explicit Proved(std::uint64_t number, std::int64_t boxes = 1500)
      : world(bench::random_drive(number)),
        layout(lay_out(world.spec)),
        actions(provable_actions(world.spec, layout, world.region, {world.action}, {})) {
    REQUIRE(actions.front().tests.size() == 1);
    SubdivisionLimits limits;
    limits.boxes = boxes;
    certified = certify(actions, limits);
  }
  const TestCertificate& test() const { return certified.front().tests.front(); }
  const SecondEvaluation& second() const { return actions.front().tests.front()->second(); }
  StartBox whole() const { return actions.front().tests.front()->scene().whole(); }
  State state(const std::vector<double>& start) const {
    State out;
    for (std::size_t i = 0; i < start.size(); ++i) {
      out[world.region.dimensions[i].variable] = start[i];
    }
    return out;
  }

  bench::ProofWorld world;
  WorldLayout layout;
  std::vector<ProvableAction> actions;
  std::vector<ActionCertificate> certified;
};

std::vector<double> corner_or_inside(const StartBox& box, const CounterRng& rng,
                                     std::uint64_t sample) {
  std::vector<double> start;
  for (std::size_t i = 0; i < box.size(); ++i) {
    double share = rng.uniform(100 * sample + i);
    if (sample % 2 == 1) share = std::round(share);
    start.push_back(box[i].lower + share * (box[i].upper - box[i].lower));
  }
  return start;
}

TEST_CASE("what is proved of a drive is what its controller does in the engine") {
  std::int64_t asked = 0, mixed = 0;
  for (std::uint64_t number = 1; number <= 24; ++number) {
    const Proved proved(number);
    const TestCertificate& test = proved.test();
    CHECK(test.test.function == "Drive::is_blocked");
    CHECK(test.safe + test.refuted + test.open == doctest::Approx(1.0));
    CHECK(fill(test.boxes, proved.whole()));
    if (test.safe > 0.0 && test.refuted > 0.0) ++mixed;
    OdeSimulator simulator(proved.world.spec);
    const CounterRng rng({number, 3, {}, 0, 0});
    std::uint64_t sample = 0;
    for (const DecidedBox& box : test.boxes) {
      if (box.verdict == BoxVerdict::kOpen || ++sample > 60) continue;
      const auto start = corner_or_inside(box.bounds, rng, sample);
      if (simulator.reset(proved.state(start), 1).status != SimStatus::kOk) continue;
      const Outcome outcome = simulator.act("drive", proved.world.action.arguments, 0.0);
      CAPTURE(number);
      CHECK((outcome.status == SimStatus::kFailed) == (box.verdict == BoxVerdict::kRefuted));
      ++asked;
    }
  }
  CHECK(asked > 100);
  CHECK(mixed >= 3);
}

TEST_CASE("the second evaluation finds no failure in safe boxes and would notice a wrong verdict") {
  std::int64_t noticed = 0, wrong = 0;
  for (std::uint64_t number = 1; number <= 24; ++number) {
    const Proved proved(number);
    const CounterRng rng({number, 4, {}, 0, 0});
    std::uint64_t sample = 0;
    for (const DecidedBox& box : proved.test().boxes) {
      if (box.verdict == BoxVerdict::kOpen || ++sample > 40) continue;
      const auto start = corner_or_inside(box.bounds, rng, sample);
      CAPTURE(number);
      if (box.verdict == BoxVerdict::kSafe) CHECK_FALSE(proved.second().refuses_at(start));
      if (box.verdict == BoxVerdict::kRefuted) CHECK(proved.second().refuses_at(start));
      const auto other =
          box.verdict == BoxVerdict::kSafe ? BoxVerdict::kRefuted : BoxVerdict::kSafe;
      ++wrong;
      if (!proved.second().confirms(box.bounds, other, 64)) ++noticed;
    }
  }
  CHECK(wrong > 50);
  CHECK(noticed == wrong);
}

TEST_CASE("with more boxes nothing that was decided changes, and less is open") {
  const Proved few(7, 60), many(7, 2000);
  CHECK(many.test().safe >= few.test().safe);
  CHECK(many.test().refuted >= few.test().refuted);
  const Proved again(7, 2000);
  REQUIRE(again.test().boxes.size() == many.test().boxes.size());
  for (std::size_t i = 0; i < again.test().boxes.size(); ++i) {
    CHECK(again.test().boxes[i].verdict == many.test().boxes[i].verdict);
    CHECK(again.test().boxes[i].bounds.front().lower == many.test().boxes[i].bounds.front().lower);
  }
}

}  // namespace
}  // namespace parallax::harness
