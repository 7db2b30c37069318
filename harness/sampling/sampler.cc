#include "harness/sampling/sampler.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "compiler/base/diagnostic_codes.h"

namespace parallax::harness {

Sampler::Sampler(StartCuboid cuboid, double inset) : cuboid_(std::move(cuboid)), inset_(inset) {}

base::Result<Sampler> Sampler::make(StartCuboid cuboid, double inset, base::SourceRange blame,
                                    base::DiagnosticSink& sink) {
  PARALLAX_REQUIRE(inset >= 0.0 && std::isfinite(inset), "an inset that is zero or more");
  const auto errors_before = sink.error_count();
  for (const auto& [variable, interval] : cuboid.dimensions) {
    const bool fixed = interval.lower == interval.upper;
    if (fixed || interval.lower + inset < interval.upper - inset) continue;
    sink.error(base::DiagnosticCode::kSamplingTooNarrow, blame, variable, interval.lower,
               interval.upper, inset);
  }
  if (sink.error_count() != errors_before) return sink.already_reported();
  return Sampler(std::move(cuboid), inset);
}

State Sampler::draw(const DrawKey& key) const {
  const CounterRng rng(key);
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
  return state;
}

}  // namespace parallax::harness
