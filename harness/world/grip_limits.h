#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "harness/world/world_spec.h"

namespace parallax::harness {

/// Forms of gripped loads that the engines hold differently.
enum class GrippedForm : std::uint8_t {
  kCylinder,
  kRing,   // walls round a hollow, such as `ring` of a scenario makes
  kOther,  // boxes, hulls and meshes, of which none slipped
};
/// "cylinder", "ring", "other"
std::string_view to_string(GrippedForm form);

/// A grip that an engine is known to let slip although it holds twice what it has to.
struct DoubtfulGrip {
  std::string body;
  GrippedForm form = GrippedForm::kOther;
  double measured_s = 0.0;  // the step at which it was measured
  int slipped = 0, runs = 0;
  double sound_s = 0.0;  // at this step, and at smaller ones, none slipped
};

/// Where mass and squeeze of a grip are not those of the world: what is drawn, or an action gives.
struct GripRange {
  std::optional<double> lightest_kg, heaviest_kg;
  std::optional<double> gentlest_n, firmest_n;
};

/// The bodies of a world that its robot can grip and that may slip because of engine and step, by
/// name. The limits are those of the table in docs/physics.md ("Grips"), which grip_limits_test
/// holds against this. Left out are grips that at rest always hold five times what they have to,
/// where none of those slipped, and grips that by Coulomb's law hold nothing. `ranges`: by body.
/// `spec` must pass check_world.
std::vector<DoubtfulGrip> doubtful_grips(const WorldSpec& spec,
                                         const std::map<std::string, GripRange>& ranges = {});

}  // namespace parallax::harness
