#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "compiler/base/diagnostic.h"
#include "compiler/pipeline/compile.h"
#include "compiler/reference/reference_evaluator.h"
#include "runtime/replay/trace_replay.h"

namespace parallax::tools {

/// Why a trace is none of the model: the first reason, and some of the others.
struct Blame {
  std::int64_t timepoint = 0;
  base::DiagnosticNote first;
  std::vector<base::DiagnosticNote> others;
};

/// What the evaluator finds wrong with a trace that mentions every atom: the earliest violation,
/// among equals the first of the text. None if it finds nothing.
std::optional<Blame> evaluated_blame(const runtime::ClaimedTrace& trace,
                                     const compiler::ReferenceEvaluator& evaluator);

/// A minimal set of axioms that cannot hold with the trace up to the verdict's timepoint. None if
/// the solver was stopped.
std::optional<Blame> core_blame(const compiler::Compilation& compilation,
                                const runtime::TraceReplay& replay,
                                const runtime::ClaimedTrace& trace,
                                const runtime::ReplayVerdict& verdict);

}  // namespace parallax::tools
