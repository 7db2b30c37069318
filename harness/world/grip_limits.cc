// Which grips slip although Coulomb's law holds them, by engine, step and form:
// docs/internals/physics.md, "Grips". Only what was measured is said: a form, an engine and steps
// of 0.5 to 4 ms.

#include "harness/world/grip_limits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "harness/world/arguments.h"
#include "harness/world/shapes.h"
#include "harness/world/world_layout.h"

namespace parallax::harness {
namespace {

/// A cell of the table in which grips of margin 2 slipped. `firm_holds`: none of margin 5 did.
struct SlipCell {
  EngineKind engine;
  GrippedForm form;
  double step_s;
  int slipped, runs;
  bool firm_holds;
  double sound_s;
};
constexpr std::array<SlipCell, 3> kSlips = {{
    {EngineKind::kMujoco, GrippedForm::kCylinder, 0.002, 6, 120, true, 0.001},
    {EngineKind::kMujoco, GrippedForm::kCylinder, 0.004, 27, 120, false, 0.001},
    {EngineKind::kOde, GrippedForm::kRing, 0.004, 1, 20, true, 0.002},
}};
constexpr double kFirmMargin = 5.0;

/// The cell that speaks of a step: that of the next larger step, or the last one.
const SlipCell* slip_cell(EngineKind engine, GrippedForm form, double step_s) {
  constexpr double kAlmost_s = 1e-9;
  const SlipCell* last = nullptr;
  for (const auto& cell : kSlips) {
    if (cell.engine != engine || cell.form != form || step_s <= cell.sound_s + kAlmost_s) continue;
    last = &cell;
    if (step_s <= cell.step_s + kAlmost_s) break;
  }
  return last;
}

/// A grip as the robot of the world makes it.
struct Grip {
  Eigen::Vector3d p_BG;  // middle of the pads in the frame of the body [m]
  double width_m;
  double squeeze_n;
};

std::optional<Grip> grip_of(const WorldSpec& spec, const BodySpec& body) {
  if (!spec.mobile) {
    return Grip{Eigen::Vector3d::Zero(), spec.robot.opening_m, spec.robot.grip_force_n};
  }
  if (!body.grasp) return std::nullopt;
  const auto& grasp = *body.grasp;
  const bool fits = std::any_of(spec.mobile->arms.begin(), spec.mobile->arms.end(),
                                [&](const ArmSpec& arm) { return grasp.width_m < arm.opening_m; });
  return fits ? std::optional(Grip{grasp.p_BG, grasp.width_m, grasp.effort_n}) : std::nullopt;
}

/// The force of an action that squeezes a load, as it gives it or as its controller has it; none if
/// that is the force of the body's own grip.
std::optional<double> action_squeeze_n(std::string_view controller, const State& arguments) {
  if (controller != "pick-up" && controller != "picking-up" && controller != "regrip") {
    return std::nullopt;
  }
  const std::string_view name = controller == "picking-up" ? "grip_force_n" : "effort_n";
  const auto given = arguments.find(std::string(name));
  if (given != arguments.end()) return as_number(given->second);
  const auto* spec = find_controller(controller);
  const auto* force = spec == nullptr ? nullptr : find_argument(*spec, name);
  if (force == nullptr || std::isnan(force->fallback)) return std::nullopt;
  return force->fallback;
}

/// From the point to the box round the shape [m].
double distance_m(const BodyShape& shape, const Eigen::Vector3d& p_B) {
  const Eigen::Vector3d p_S = shape_rotation(shape).transpose() * (p_B - shape.p_BS);
  return (p_S.cwiseAbs() - 0.5 * shape.size_m).cwiseMax(0.0).norm();
}

/// The form of the shapes between the pads: those within half the width of the grip of its middle.
GrippedForm gripped_form(const BodySpec& body, const Grip& grip) {
  constexpr double kPlay_m = 0.001, kSameHeading_rad = 0.05;
  std::vector<double> headings_rad;  // of upright boxes, each once; turned by half, it is the same
  for (const auto& shape : body.shapes) {
    if (distance_m(shape, grip.p_BG) > 0.5 * grip.width_m + kPlay_m) continue;
    if (shape.form == ShapeForm::kCylinder) return GrippedForm::kCylinder;
    if (!is_upright_box(shape)) continue;
    const bool known = std::any_of(headings_rad.begin(), headings_rad.end(), [&](double other) {
      return std::abs(std::remainder(shape.yaw_rad - other, std::numbers::pi)) < kSameHeading_rad;
    });
    if (!known) headings_rad.push_back(shape.yaw_rad);
  }
  // Plates of two headings are a box that is put together.
  return headings_rad.size() > 2 ? GrippedForm::kRing : GrippedForm::kOther;
}

/// The friction of the worse pad.
double pad_friction(const WorldSpec& spec, const BodySpec& body) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& gripper : grippers(spec)) {
    for (const auto* pad : {&gripper.near_pad_body, &gripper.far_pad_body}) {
      for (const auto& part : spec.bodies) {
        if (part.name != *pad) continue;
        const auto key = std::minmax(part.material, body.material);
        const auto found = spec.friction.pairs.find({key.first, key.second});
        least = std::min(
            least, found == spec.friction.pairs.end() ? spec.friction.fallback : found->second);
      }
    }
  }
  return least;
}

}  // namespace

void widen_by_action(const WorldSpec& spec, std::string_view controller, const State& arguments,
                     std::map<std::string, GripRange>& ranges) {
  const auto squeeze_n = action_squeeze_n(controller, arguments);
  if (!squeeze_n) return;
  const auto object = arguments.find("object");
  const auto* name =
      object == arguments.end() ? nullptr : std::get_if<std::string>(&object->second);
  const bool names_body =
      name != nullptr && std::any_of(spec.bodies.begin(), spec.bodies.end(),
                                     [&](const BodySpec& body) { return body.name == *name; });
  for (const auto& body : spec.bodies) {
    if (names_body && body.name != *name) continue;
    const auto grip = grip_of(spec, body);
    if (!grip) continue;
    auto& range = ranges[body.name];
    range.gentlest_n = std::min(range.gentlest_n.value_or(grip->squeeze_n), *squeeze_n);
    range.firmest_n = std::max(range.firmest_n.value_or(grip->squeeze_n), *squeeze_n);
  }
}

std::vector<DoubtfulGrip> doubtful_grips(const WorldSpec& spec,
                                         const std::map<std::string, GripRange>& ranges) {
  std::vector<DoubtfulGrip> out;
  if (grippers(spec).empty() || spec.solver.gravity_m_s2 == 0.0) return out;
  const auto layout = lay_out(spec);
  for (std::size_t i = 0; i < layout.bodies.size(); ++i) {
    const auto& body = layout.bodies[layout.bodies.id_at(i)];
    const bool is_load = layout.is_free[i] && body.gravity;
    const auto grip = is_load ? grip_of(spec, body) : std::nullopt;
    if (!grip) continue;
    const auto form = gripped_form(body, *grip);
    const auto* cell = slip_cell(spec.engine, form, spec.solver.timestep_s);
    if (cell == nullptr) continue;
    const auto at = ranges.find(body.name);
    const auto range = at == ranges.end() ? GripRange{} : at->second;
    const double friction = pad_friction(spec, body);
    const auto margin = [&](double squeeze_n, double mass_kg) {
      return 2.0 * friction * squeeze_n / (mass_kg * std::abs(spec.solver.gravity_m_s2));
    };
    const double least = margin(range.gentlest_n.value_or(grip->squeeze_n),
                                range.heaviest_kg.value_or(body.mass_kg));
    const double most =
        margin(range.firmest_n.value_or(grip->squeeze_n), range.lightest_kg.value_or(body.mass_kg));
    // A load that Coulomb's law does not hold slips in any engine.
    if (most < 1.0 || (cell->firm_holds && least >= kFirmMargin)) continue;
    out.push_back({body.name, form, cell->step_s, cell->slipped, cell->runs, cell->sound_s});
  }
  return out;
}

}  // namespace parallax::harness
