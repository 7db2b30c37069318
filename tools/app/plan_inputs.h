#pragma once

#include <set>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/plan/plan_graph.h"
#include "runtime/trace/open_atoms.h"
#include "runtime/trace/trace.h"

namespace parallax::tools {

/// The symbols that the formulas of a plan are about: in outcomes, questions and goals.
std::set<std::string> symbols_read(const compiler::PlanGraph& plan);

/// Inputs of a plan on the way of a trace that the trace does not show: the predicates that its
/// formulas are about, as `Fragile(cup)` or, where a formula names that very atom, `!Fragile(cup)`;
/// and the values of free variables of its entry, `?x=cup`. Nothing that is open in the trace.
std::vector<std::string> plan_inputs(const compiler::PlanGraph& plan,
                                     const compiler::CompiledModel& model,
                                     const runtime::Trace& trace, const runtime::OpenAtoms& open);

}  // namespace parallax::tools
