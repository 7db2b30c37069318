#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "harness/world/world_spec.h"

namespace parallax::tools {

// Generated grips: a mobile robot closes its hand on a load of a given form, lifts it and drives
// away. By Coulomb's law the grip holds `margin` times what weight and motion ask for, so a load
// that leaves the hand at a margin of 2 was lost by the solver.

enum class GripForm : std::uint8_t { kBox, kRing, kHull, kCylinder, kMesh };
inline constexpr std::array kGripForms{GripForm::kBox, GripForm::kRing, GripForm::kHull,
                                       GripForm::kCylinder, GripForm::kMesh};
std::string_view to_string(GripForm form);

struct GripCell {
  GripForm form = GripForm::kBox;
  double margin = 2.0;
  double timestep_s = 0.002;
  harness::EngineKind engine = harness::EngineKind::kOde;
  /// The sides of the load are along the pads; else it is up to 0.05 rad askew.
  bool straight = false;
};

struct GripTrial {
  bool lost = false;              // at the end a pad does not touch the load
  double slip_m = 0.0;            // of the load in the hand, from the end of the squeeze on
  double turn_rad = 0.0;          // likewise
  std::int64_t unsolved = 0;      // complaints of the contact solver in steps left unsolved
  std::int64_t solved_again = 0;  // steps that it gave up at first
};

/// A load that moved by more than this in the hand has slipped.
inline constexpr double kGripSlip_m = 0.005;

/// Size, wall, sides, yaw and place of the load in the hand, friction, squeeze, speed and direction
/// of the drive follow from `seed` alone; the mass follows from them and the margin.
GripTrial try_grip(const GripCell& cell, std::uint64_t seed,
                   const harness::SolverSpec& solver = {});

}  // namespace parallax::tools
