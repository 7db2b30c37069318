// parallax_proof_table: proofs of drives in random worlds, compared with samples.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "harness/geometry_proof/certificate.h"
#include "harness/robot/ode_simulator.h"
#include "harness/sampling/sampler.h"
#include "tools/bench/proof/proof_worlds.h"

namespace parallax::bench {
namespace {

using harness::BoxVerdict;

/// A start in one of the boxes, all of it or within a millimetre (milliradian) of one of its faces.
std::vector<double> start_in(const harness::StartBox& box, bool at_face,
                             const harness::CounterRng& rng) {
  constexpr double kNear = 1e-3;
  std::vector<double> start;
  for (std::size_t i = 0; i < box.size(); ++i) {
    start.push_back(box[i].lower + rng.uniform(i) * (box[i].upper - box[i].lower));
  }
  if (!at_face) return start;
  const std::size_t faces = 2 * box.size();
  const auto face =
      std::min(faces - 1, static_cast<std::size_t>(rng.uniform(100) * static_cast<double>(faces)));
  const harness::Bounds1& range = box[face / 2];
  const double depth = std::min(kNear, range.upper - range.lower) * rng.uniform(101);
  start[face / 2] = face % 2 == 0 ? range.lower + depth : range.upper - depth;
  return start;
}

struct Row {
  double safe = 0.0, refuted = 0.0, open = 0.0, seconds = 0.0;
  std::int64_t boxes = 0, unconfirmed = 0, samples = 0;
  std::int64_t failures = 0;      // samples in safe boxes that the second evaluation refuses
  std::int64_t engine = 0;        // starts whose drive the controller itself was asked about
  std::int64_t contradicted = 0;  // of them, against the verdict of their box
};

/// Asks the controller itself, in the engine, about starts in decided boxes.
void ask_controller(const ProofWorld& world, const harness::TestCertificate& test,
                    std::uint64_t number, std::int64_t starts, Row& row) {
  harness::OdeSimulator simulator(world.spec);
  for (std::int64_t n = 0; n < starts; ++n) {
    const harness::CounterRng rng({number, 2, {}, static_cast<std::uint64_t>(n), 0});
    const auto& box = test.boxes[std::min(
        test.boxes.size() - 1,
        static_cast<std::size_t>(rng.uniform(200) * static_cast<double>(test.boxes.size())))];
    if (box.verdict == BoxVerdict::kOpen) continue;
    const auto start = start_in(box.bounds, n % 2 == 0, rng);
    harness::State state;
    for (std::size_t i = 0; i < start.size(); ++i) {
      state[world.region.dimensions[i].variable] = start[i];
    }
    const auto reset = simulator.reset(state, 1);
    if (reset.status != harness::SimStatus::kOk) continue;  // things overlap
    const auto outcome = simulator.act(world.action.controller, world.action.arguments, 0.0);
    const bool refused = outcome.status == harness::SimStatus::kFailed;
    ++row.engine;
    if (refused != (box.verdict == BoxVerdict::kRefuted)) ++row.contradicted;
  }
}

Row measure(std::uint64_t number, std::int64_t samples, std::int64_t engine,
            const harness::SubdivisionLimits& limits) {
  const ProofWorld world = random_drive(number);
  const auto layout = harness::lay_out(world.spec);
  const auto actions =
      harness::provable_actions(world.spec, layout, world.region, {world.action}, {});
  const auto begin = std::chrono::steady_clock::now();
  const auto proved = harness::certify(actions, limits);
  Row row;
  row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  const auto& test = proved.front().tests.front();
  row.safe = test.safe, row.refuted = test.refuted, row.open = test.open;
  row.boxes = static_cast<std::int64_t>(test.boxes.size());
  row.unconfirmed = test.unconfirmed;
  std::vector<const harness::DecidedBox*> safe;
  for (const auto& box : test.boxes) {
    if (box.verdict == BoxVerdict::kSafe) safe.push_back(&box);
  }
  const auto& second = actions.front().tests.front()->second();
  for (std::int64_t n = 0; n < samples && !safe.empty(); ++n) {
    const harness::CounterRng rng({number, 1, {}, static_cast<std::uint64_t>(n), 0});
    const auto* box = safe[static_cast<std::size_t>(n) % safe.size()];
    ++row.samples;
    if (second.refuses_at(
            start_in(box->bounds, n / static_cast<std::int64_t>(safe.size()) % 2 == 0, rng))) {
      ++row.failures;
    }
  }
  ask_controller(world, test, number, engine, row);
  return row;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return n == 0 ? 0.0 : 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

int run(std::uint64_t worlds, std::int64_t samples, std::int64_t engine, std::int64_t boxes) {
  harness::SubdivisionLimits limits;
  limits.boxes = boxes;
  std::vector<double> decided, mixed, seconds;
  Row all;
  for (std::uint64_t number = 1; number <= worlds; ++number) {
    const Row row = measure(number, samples, engine, limits);
    fmt::print(
        "world {:3}  safe {:6.2f} %  refuted {:6.2f} %  open {:6.2f} %  {:6} boxes  {:3} "
        "unconfirmed  {:.2f} s  {} of {} samples fail  {} of {} contradicted\n",
        number, 100.0 * row.safe, 100.0 * row.refuted, 100.0 * row.open, row.boxes, row.unconfirmed,
        row.seconds, row.failures, row.samples, row.contradicted, row.engine);
    std::fflush(stdout);
    decided.push_back(row.safe + row.refuted);
    if (row.safe > 0.0 && row.safe < 1.0 && row.refuted < 1.0) mixed.push_back(decided.back());
    seconds.push_back(row.seconds);
    all.failures += row.failures, all.samples += row.samples;
    all.contradicted += row.contradicted, all.engine += row.engine;
    all.unconfirmed += row.unconfirmed, all.boxes += row.boxes;
  }
  fmt::print(
      "{} worlds: median decided {:.2f} %, least {:.2f} %; of the {} that are neither safe "
      "nor refuted throughout: median {:.2f} %, least {:.2f} %; median {:.2f} s\n",
      worlds, 100.0 * median(decided), 100.0 * *std::min_element(decided.begin(), decided.end()),
      mixed.size(), 100.0 * median(mixed),
      mixed.empty() ? 0.0 : 100.0 * *std::min_element(mixed.begin(), mixed.end()), median(seconds));
  fmt::print(
      "{} of {} samples in safe boxes fail; the controller contradicts {} of {} verdicts; "
      "{} of {} boxes not confirmed\n",
      all.failures, all.samples, all.contradicted, all.engine, all.unconfirmed, all.boxes);
  return all.failures + all.contradicted == 0 ? 0 : 1;
}

}  // namespace
}  // namespace parallax::bench

int main(int argc, char** argv) {
  const auto number = [&](int i, std::int64_t fallback) {
    return argc > i ? std::strtoll(argv[i], nullptr, 10) : fallback;
  };
  if (argc > 5 || number(1, 1) < 1 || number(4, 1) < 1) {
    fmt::print(stderr, "usage: parallax_proof_table [WORLDS [SAMPLES [ENGINE_STARTS [BOXES]]]]\n");
    return 2;
  }
  return parallax::bench::run(static_cast<std::uint64_t>(number(1, 200)), number(2, 100'000),
                              number(3, 200), number(4, 20'000));
}
