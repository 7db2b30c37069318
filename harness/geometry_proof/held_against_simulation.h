#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "harness/geometry_proof/certificate.h"
#include "harness/sampling/sampler.h"

namespace parallax::harness {

/// The results of simulating uniform starts, for one test.
struct SimulatedTest {
  struct Count {
    std::int64_t starts = 0, refused = 0;
  };
  std::array<Count, 3> by_verdict;  // of the box that the start lies in, by BoxVerdict
  /// Simulations in which an assumption of the proof was broken; they say nothing of the verdicts
  /// and are not counted there. `broken`: by assumption.
  std::int64_t not_as_assumed = 0;
  std::map<std::string, std::int64_t> broken;
  /// Starts whose simulation contradicts the verdict of their box.
  std::vector<State> contradictions;
};

/// Simulates `count` starts of `sampler` and compares, for each test of `actions`, whether the
/// controller refused with the verdict of the box that the start lies in. Starts that are invalid
/// are drawn again. In the order of the tests.
std::vector<SimulatedTest> simulate_tests(const WorldSpec& spec, const WorldLayout& layout,
                                          const Sampler& sampler, std::uint64_t seed,
                                          std::int64_t count, const std::vector<ProofAction>& calls,
                                          const std::vector<ProvableAction>& actions,
                                          const std::vector<ActionCertificate>& proved,
                                          const std::atomic<bool>* stop);

}  // namespace parallax::harness
