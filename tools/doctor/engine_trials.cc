#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "harness/engine/engine_module.h"
#include "tools/doctor/trials.h"

namespace parallax::tools {
namespace {

constexpr double kHeight_m = 10.0, kTime_s = 1.0;

harness::WorldSpec falling_ball(harness::EngineKind engine) {
  harness::BodySpec ball;
  ball.name = "ball";
  ball.mass_kg = 1.0;
  ball.p_WB = {0.0, 0.0, kHeight_m};
  harness::BodyShape shape;
  shape.form = harness::ShapeForm::kSphere;
  shape.size_m = {0.1, 0.1, 0.1};
  ball.shapes = {shape};
  harness::WorldSpec spec;
  spec.engine = engine;
  spec.bodies = {ball};
  return spec;
}

}  // namespace

CheckUp try_engine(harness::EngineKind engine) {
  CheckUp check{.name = harness::engine_title(engine),
                .package = harness::engine_package(engine),
                .is_needed = false};
  const std::string why = harness::why_no_engine(engine);
  if (!why.empty()) {
    check.health = Health::kAbsent;
    check.found = why;
    check.remedy = fmt::format("build again with {} installed", check.package);
    return check;
  }
  const auto spec = falling_ball(engine);
  const auto world = harness::make_world(spec);
  const std::vector<harness::Placement> start{{spec.bodies.front().p_WB, 0.0, 0.0}};
  bool sane = !world->reset(start, 1);
  const auto steps = std::lround(kTime_s / spec.solver.timestep_s);
  for (long i = 0; i < steps; ++i) sane = world->step() && sane;
  const double fallen_m = kHeight_m - world->position(*world->layout().find_body("ball")).z();
  const double expected_m = -0.5 * spec.solver.gravity_m_s2 * kTime_s * kTime_s;
  check.found = fmt::format("{} {}: a ball fell {:.2f} m in a second", world->engine().name,
                            world->engine().version, fallen_m);
  check.health = Health::kWorks;
  if (!sane || std::abs(fallen_m - expected_m) > 0.01 * expected_m) {
    check.health = Health::kBroken;
    check.remedy = fmt::format("install {} again", check.package);
  }
  return check;
}

}  // namespace parallax::tools
