#pragma once

#include <vector>

#include "compiler/base/diagnostic.h"
#include "harness/config/scenario.h"

namespace parallax::harness {

/// Checks that fluents read variables of the type that their mapping asks for, and that intervals
/// and borders of angles are in radians. One report for each entry of the mapping.
void check_kinds(const Scenario& scenario, const std::vector<GroundFluent>& fluents,
                 const std::vector<Parameter>& parameters, base::DiagnosticSink& sink);

/// Checks that formulas and conditions of `sampling` read numbers alone.
void check_law_kinds(const Scenario& scenario, const std::vector<Parameter>& parameters,
                     base::DiagnosticSink& sink);

/// Checks that an angle is sampled in radians (angle_fault). Of a normal law without bounds the
/// mean and one standard deviation count: its tails may go round.
void check_angle(const SampledDimension& dimension, const Parameter& parameter,
                 const Scenario& scenario, base::DiagnosticSink& sink);

}  // namespace parallax::harness
