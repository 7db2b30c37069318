#pragma once

#include <optional>
#include <string>

#include "harness/world/world_spec.h"

namespace parallax::harness {

/// The range of densities of household things [kg/m3], hollow ones with their contents: from foam
/// and empty boxes (expanded polystyrene has 15) to copper (8960), by the tables of The Physics
/// Hypertextbook.
inline constexpr double kLightestThing_kg_m3 = 5.0, kHeaviestThing_kg_m3 = 9000.0;

/// The density of a body of this mass, the volumes of its shapes added up [kg/m3].
double density_kg_m3(const BodySpec& body, double mass_kg);

/// Is the density of a body of this mass unusual for household things? "little" or "much"; nothing
/// where it is not.
std::optional<std::string> odd_density(const BodySpec& body, double mass_kg);

}  // namespace parallax::harness
