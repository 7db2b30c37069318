#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/diagnostic.h"
#include "compiler/ground/formula_grounder.h"
#include "compiler/pipeline/plan_formulas.h"
#include "compiler/plan/plan_graph.h"

namespace parallax::compiler {

/// Where there are atoms that say whether the plan would go on.
enum class RunningAtoms : std::uint8_t { kAtHorizon, kEverywhere };

/// Unrolls the plan's control flow together with the model. Control is at exactly one location or
/// terminal per timepoint (atoms `L0`, `DONE`, `FAILED(class)`, `BOUND(0)`); at a location its
/// event happens; whether it succeeded (atom `L0` of kind kSucceeded, one timepoint later) is
/// decided by its success formula, never freely; a terminal is never left. What a perform returns
/// is any one object that makes its formula true (kResult), kept in a register (kRegister) while
/// the plan has use for it. A free branch goes where its own atom says (`CHOICE(0)`). Events of
/// `plan_events` (all symbols that the binding table can produce) happen only where a location
/// performs them; other events are the model's own. Size: reachable (location, timepoint) pairs
/// times edges.
/// Returns, by timepoint: control is where unrolling was cut. From the timepoint at which it comes
/// there nothing is known of the plan, and what stands behind it is no execution.
base::Result<std::vector<FormulaId>> encode_plan(const PlanGraph& graph,
                                                 const PlanFormulas& formulas,
                                                 const std::set<std::string>& plan_events,
                                                 RunningAtoms running, GroundModel& model,
                                                 FormulaGrounder& grounder,
                                                 base::DiagnosticSink& sink);

/// The plan's steps for the artifact, by location number.
std::vector<PlanPerform> plan_steps(const PlanGraph& graph);

/// The places where unrolling was cut, in the order of the graph's terminals.
std::vector<PlanCut> plan_cuts(const PlanGraph& graph);

}  // namespace parallax::compiler
