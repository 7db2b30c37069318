#pragma once

#include <cstdint>
#include <string_view>

namespace parallax::harness {

/// splitmix64's output function; the base of every random choice here.
std::uint64_t mix64(std::uint64_t x);

/// The phase of a campaign that a draw belongs to; each has its own stream.
enum class DrawPhase : std::uint8_t { kSearch = 1, kCertify = 2, kConfirm = 3 };

/// Names one draw, so that a sample can be replayed alone: (campaign seed, trace key, phase,
/// sample index, attempt after rejected starts).
struct DrawKey {
  std::uint64_t campaign_seed = 0;
  std::uint64_t trace_key = 0;
  DrawPhase phase = DrawPhase::kCertify;
  std::uint64_t sample = 0;
  std::uint64_t attempt = 0;
};

/// Counter-based generator: value k of a key does not depend on any other value.
class CounterRng {
 public:
  explicit CounterRng(const DrawKey& key);
  std::uint64_t bits(std::uint64_t dimension) const;
  /// Uniform in [0, 1) with 53 bits; own code, as std::uniform_real_distribution differs between
  /// standard libraries.
  double uniform(std::uint64_t dimension) const;

 private:
  std::uint64_t state_;
};

/// The seed handed to the simulator for this draw (what the report calls `seed`), below 2^53 so
/// that JSON readers keep it exactly.
std::uint64_t simulator_seed(const DrawKey& key);

}  // namespace parallax::harness
