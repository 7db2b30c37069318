#include "harness/world/density.h"

#include "harness/world/shapes.h"

namespace parallax::harness {

double density_kg_m3(const BodySpec& body, double mass_kg) {
  double sum_m3 = 0.0;
  for (const BodyShape& shape : body.shapes) sum_m3 += volume_m3(shape);
  return mass_kg / sum_m3;
}

std::optional<std::string> odd_density(const BodySpec& body, double mass_kg) {
  const double density = density_kg_m3(body, mass_kg);
  if (density < kLightestThing_kg_m3) return "little";
  if (density > kHeaviestThing_kg_m3) return "much";
  return std::nullopt;
}

}  // namespace parallax::harness
