#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/region/state_mapping.h"

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

class LawDraw;
struct SamplingLaw;

/// A start, and how many candidates the conditions of its law had refused before it.
struct DrawnStart {
  State start;
  std::int64_t refused = 0;
};

/// Draws start states independently, uniformly from a cuboid or by a law conditioned on it.
///
/// Dimension i of the cuboid takes value i of the key's stream, so a draw can be repeated alone
/// and does not depend on the draws before it. A dimension with equal bounds is fixed. Where
/// conditions refuse a candidate the next one takes the values that follow.
class Sampler {
 public:
  /// How far [m, rad] a drawn value stays from the ends of its interval, so that no start is
  /// within rounding of a border.
  static constexpr double kDefaultInset = 1e-6;

  /// Reports kSamplingTooNarrow for every dimension that the inset uses up, and what
  /// LawDraw::make reports. Without a law every dimension is uniform.
  static base::Result<Sampler> make(StartCuboid cuboid, double inset, base::SourceRange blame,
                                    base::DiagnosticSink& sink, const SamplingLaw* law = nullptr);

  /// One value in [lower + inset, upper - inset) per dimension.
  State draw(const DrawKey& key) const { return draw_counting(key, nullptr).start; }
  /// Adds what each condition of law() has refused, unless `refusals` is null.
  DrawnStart draw_counting(const DrawKey& key, std::vector<std::int64_t>* refusals) const;
  /// Null where all dimensions are uniform and nothing is cut out of the cuboid.
  const LawDraw* law() const { return law_.get(); }
  const StartCuboid& cuboid() const { return cuboid_; }
  double inset() const { return inset_; }
  /// Share of the cuboid's volume in its rim, where the inset lets no start be drawn.
  double rim_share() const;

 private:
  Sampler(StartCuboid cuboid, double inset);
  StartCuboid cuboid_;
  double inset_;
  std::shared_ptr<const LawDraw> law_;
};

}  // namespace parallax::harness
