#pragma once

#include <optional>
#include <string>

#include "harness/world/world_spec.h"

namespace parallax::harness {

/// What household things weigh [kg/m3], hollow ones with what is in them: from foam and empty boxes
/// (expanded polystyrene has 15) to copper (8960), by the tables of The Physics Hypertextbook.
inline constexpr double kLightestThing_kg_m3 = 5.0, kHeaviestThing_kg_m3 = 9000.0;

/// Of a body of this mass, its boxes counted one by one.
double density_kg_m3(const BodySpec& body, double mass_kg);

/// Does a thing of this mass and the body's size weigh what no household thing weighs? "little" or
/// "much"; nothing where it does not.
std::optional<std::string> odd_density(const BodySpec& body, double mass_kg);

}  // namespace parallax::harness
