#pragma once

#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

/// Checks that a fluent's flag, number or text reads a variable of that type.
void check_kinds(const Scenario& scenario, const std::vector<GroundFluent>& fluents,
                 const std::vector<Parameter>& parameters, base::DiagnosticSink& sink);

/// Angles are in radians: an interval of more than a turn, or one far from any turn, is in degrees.
void check_angle(const SampledDimension& dimension, const Parameter& parameter,
                 const Scenario& scenario, base::DiagnosticSink& sink);

}  // namespace parallax::harness
