#include <fmt/format.h>

#include "compiler/base/codes/scenarios.h"
#include "harness/config/sections.h"
#include "harness/world/arguments.h"
#include "harness/world/step_length.h"

namespace parallax::harness {

void check_step_lengths(const Scenario& scenario, base::DiagnosticSink& sink) {
  const WorldLayout layout = lay_out(scenario.world);
  for (const ActionBinding& action : scenario.actions) {
    const ControllerSpec* controller = find_controller(action.controller);
    if (controller == nullptr) continue;  // reported when it was read
    for (const LongStep& one : long_steps(*controller, action.arguments, scenario.world, layout)) {
      const auto own = action.argument_sources.find(one.argument);
      const auto place = own == action.argument_sources.end() ? action.source : own->second;
      sink.warning(codes::kLongStep, place,
                   fmt::format("actions/{}/{}", action.event, one.argument), one.speed_m_s,
                   1e3 * one.step_m, 1e3 * scenario.world.solver.timestep_s, one.thin_body,
                   1e3 * one.thickness_m);
    }
  }
}

}  // namespace parallax::harness
