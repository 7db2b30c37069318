#include "harness/sampling/sampler.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/base/codes/scenarios.h"
#include "harness/sampling/law_draw.h"

namespace parallax::harness {
namespace {

/// 2^64 divided by the golden ratio, the increment of splitmix64 (Steele, Lea, Flood 2014).
constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15ULL;
/// Keeps the engine's seeds apart from the coordinates of the same draw.
constexpr std::uint64_t kSimulatorStream = 0x73696d756c61746fULL;  // "simulato"

constexpr int kSeedBits = 53;

std::uint64_t absorb(std::uint64_t state, std::uint64_t word) {
  return mix64((state + kGoldenGamma) ^ word);
}

std::uint64_t key_state(const DrawKey& key) {
  std::uint64_t state = absorb(0, key.campaign_seed);
  state = absorb(state, key.trace_key);
  state = absorb(state, static_cast<std::uint64_t>(key.phase));
  state = absorb(state, key.sample);
  return absorb(state, key.attempt);
}

}  // namespace

std::uint64_t mix64(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

CounterRng::CounterRng(const DrawKey& key) : state_(key_state(key)) {}

std::uint64_t CounterRng::bits(std::uint64_t dimension) const {
  return mix64(state_ + (dimension + 1) * kGoldenGamma);
}

double CounterRng::uniform(std::uint64_t dimension) const {
  return static_cast<double>(bits(dimension) >> 11) * 0x1.0p-53;
}

std::uint64_t simulator_seed(const DrawKey& key) {
  return absorb(key_state(key), kSimulatorStream) >> (64 - kSeedBits);
}

Sampler::Sampler(StartCuboid cuboid, double inset) : cuboid_(std::move(cuboid)), inset_(inset) {}

base::Result<Sampler> Sampler::make(StartCuboid cuboid, double inset, base::SourceRange blame,
                                    base::DiagnosticSink& sink, const SamplingLaw* law) {
  PARALLAX_REQUIRE(inset >= 0.0 && std::isfinite(inset), "an inset that is zero or more");
  const auto errors_before = sink.error_count();
  for (const auto& [variable, interval] : cuboid.dimensions) {
    const bool fixed = interval.lower == interval.upper;
    if (fixed || interval.lower + inset < interval.upper - inset) continue;
    sink.error(codes::kSamplingTooNarrow, blame, variable, interval.lower, interval.upper, inset);
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  Sampler sampler(std::move(cuboid), inset);
  if ((law == nullptr || law->is_plain()) && sampler.cuboid_.areas.empty()) return sampler;
  auto bound = LawDraw::make(sampler.cuboid_, law == nullptr ? SamplingLaw() : *law, inset, sink);
  if (!bound) return sink.already_reported();
  sampler.law_ = *std::move(bound);
  return sampler;
}

double Sampler::rim_share() const {
  double drawn = 1.0;
  for (const auto& [variable, interval] : cuboid_.dimensions) {
    if (interval.lower != interval.upper) drawn *= 1.0 - 2.0 * inset_ / interval.width();
  }
  return 1.0 - drawn;
}

DrawnStart Sampler::draw_counting(const DrawKey& key, std::vector<std::int64_t>* refusals) const {
  const CounterRng rng(key);
  if (law_) {
    // If one candidate in a thousand is a start, this number does not suffice once in 10^43 draws.
    constexpr std::int64_t kMostCandidates = 100'000;
    std::vector<double> point(law_->coordinates());
    for (std::int64_t refused = 0; refused < kMostCandidates; ++refused) {
      const auto first = static_cast<std::uint64_t>(refused) * point.size();
      for (std::size_t i = 0; i < point.size(); ++i) point[i] = rng.uniform(first + i);
      if (auto start = law_->start_at(point, refusals)) return {*std::move(start), refused};
    }
    PARALLAX_REQUIRE(false, "a law that lets starts through, which was found when it was bound");
  }
  State state;
  for (std::size_t i = 0; i < cuboid_.dimensions.size(); ++i) {
    const auto& [variable, interval] = cuboid_.dimensions[i];
    double value = interval.lower;
    if (interval.lower != interval.upper) {
      const double lower = interval.lower + inset_;
      const double upper = interval.upper - inset_;
      value = lower + rng.uniform(i) * (upper - lower);
      // Rounding may reach the upper end, which belongs to the neighbour.
      value = std::min(value, std::nextafter(upper, lower));
    }
    state.emplace(variable, value);
  }
  return {std::move(state), 0};
}

}  // namespace parallax::harness
