#pragma once

#include <cstdint>

#include "harness/engine/physics_world.h"

namespace parallax::tools {

// Grips that hold by friction alone, compared with Coulomb's law.

/// Shape of the load in the engine. Both are the same box.
enum class LoadForm : std::uint8_t { kBox, kHull };

/// A load between two pads, one of which a motor presses against it, on a carriage that is moved so
/// that the load pulls in the plane of the pads at this angle from straight down. The least force
/// of the motor that holds it, as a share of what Coulomb's law asks for: weight and inertia over
/// twice the friction. 1 is right; with less the load is held too well.
double least_grip(harness::EngineKind engine, double timestep_s, double angle_rad,
                  LoadForm form = LoadForm::kBox);

/// A block on a slope whose fall line is turned from the x axis by this angle. The least friction
/// that holds it, as a share of the tangent of the slope.
double least_slope_friction(harness::EngineKind engine, double timestep_s, double turn_rad);

/// The speed at which a load creeps that is held with twice the force that it needs [m/s].
double creep_m_s(harness::EngineKind engine, double timestep_s, LoadForm form = LoadForm::kBox);

/// Error after a second, against Coulomb's law, of a load between two pads that are shaken up and
/// down so hard that it slips at times [m].
double shaken_load(harness::EngineKind engine, double timestep_s);

}  // namespace parallax::tools
