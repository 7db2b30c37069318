#pragma once

#include "compiler/base/diagnostic.h"
#include "harness/region/state_mapping.h"
#include "harness/sampling/rng.h"

namespace parallax::harness {

/// Draws start states independently and uniformly from a cuboid.
///
/// Dimension i of the cuboid takes value i of the key's stream, so a draw can be repeated alone
/// and does not depend on the draws before it. A dimension with equal bounds is fixed.
class Sampler {
 public:
  /// How far [m, rad] a drawn value stays from the ends of its interval, so that no start is
  /// within rounding of a border.
  static constexpr double kDefaultInset = 1e-6;

  /// Reports kSamplingTooNarrow for every dimension that the inset uses up.
  static base::Result<Sampler> make(StartCuboid cuboid, double inset, base::SourceRange blame,
                                    base::DiagnosticSink& sink);

  /// One value in [lower + inset, upper - inset) per dimension.
  State draw(const DrawKey& key) const;
  const StartCuboid& cuboid() const { return cuboid_; }
  double inset() const { return inset_; }

 private:
  Sampler(StartCuboid cuboid, double inset);
  StartCuboid cuboid_;
  double inset_;
};

}  // namespace parallax::harness
