#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"
#include "harness/simulator/simulator.h"
#include "harness/world/world_spec.h"

namespace parallax::harness {

/// Forms of gripped loads that the engines hold differently.
enum class GrippedForm : std::uint8_t {
  kCylinder,
  kRing,   // walls round a hollow, such as `ring` of a scenario makes
  kOther,  // boxes, hulls and meshes, of which none slipped
};
inline constexpr auto kGrippedFormWords =
    base::word_table<GrippedForm>("cylinder", "ring", "other");
constexpr std::string_view to_string(GrippedForm form) { return kGrippedFormWords.of(form); }

/// A grip that an engine is known to let slip although it holds twice what it has to.
struct DoubtfulGrip {
  std::string body;
  GrippedForm form = GrippedForm::kOther;
  double measured_s = 0.0;  // the step at which it was measured
  int slipped = 0, runs = 0;
  double sound_s = 0.0;  // at this step, and at smaller ones, none slipped
};

/// Ranges of mass and squeeze that a draw or an action gives instead of the values of the world.
struct GripRange {
  std::optional<double> lightest_kg, heaviest_kg;
  std::optional<double> gentlest_n, firmest_n;
};

/// Widens the ranges by the squeeze that an action gives: of the body that its `object` names,
/// else, as where that stands for an argument of the event, of every body that the robot can grip.
/// Forces for handles are left out.
void widen_by_action(const WorldSpec& spec, std::string_view controller, const State& arguments,
                     std::map<std::string, GripRange>& ranges);

/// The bodies of a world that its robot can grip and that may slip because of engine and step, by
/// name. The limits are those of the table in docs/internals/physics.md ("Grips"), which
/// grip_limits_test holds against this. Left out are grips that at rest always hold five times what
/// they have to, where none of those slipped, grips that by Coulomb's law hold nothing, and loads
/// without weight. `ranges`: by body. `spec` must pass check_world.
std::vector<DoubtfulGrip> doubtful_grips(const WorldSpec& spec,
                                         const std::map<std::string, GripRange>& ranges = {});

}  // namespace parallax::harness
