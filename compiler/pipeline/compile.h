#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/compiled_model.h"
#include "compiler/base/diagnostic.h"
#include "compiler/ground/pass.h"
#include "compiler/ground/universe.h"
#include "compiler/pipeline/compile_report.h"
#include "compiler/plan/plan_graph.h"
#include "compiler/plan/pose_locator.h"
#include "compiler/plan/unroll_limits.h"
#include "compiler/sema/check.h"
#include "compiler/sema/typed_model.h"
#include "compiler/syntax/loader.h"

namespace parallax::compiler {

struct PlanFormulas;

/// A plan and its binding table, both already read into the source files.
struct PlanInput {
  std::vector<base::FileId> plan;  // its files in order (load_plan_files)
  base::FileId binding;
  /// The function to run, or a call of it, `(fetch :cup)`; the default is the last one defined.
  std::optional<std::string> entry = std::nullopt;
  const PoseLocator* locator = nullptr;  // outlives the call; none: there are no regions
  UnrollLimits limits = {};
  bool interleave = false;
  bool failures_by_reason = false;
  /// Used where neither input nor model give a horizon: as many timepoints as the longest path of
  /// the plan has performs, at most this number.
  std::int64_t max_horizon = 50;
};

/// A state constraint: a text in the source files, which is one formula to its end, and the place
/// that messages name, which is another one when the text was unfolded or unquoted from it.
struct ConstraintText {
  base::SourceRange text;
  base::SourceRange place;
  bool negated = false;  // the constraint is that the formula does not hold
};

/// A formula about a state with its place; the timepoint of the state is called `time` in it. Or
/// about a trace, if temporal operators stand in it.
struct StateConstraint {
  CheckedFormula formula;
  base::SourceRange source;
  bool temporal = false;
  bool violated =
      false;  // what counts is that it is not so; a formula about a state says so itself
};

struct CompileInput {
  std::vector<std::filesystem::path> models;
  std::optional<base::FileId> text;  // instead of the models: one that is among the files
  LoadOptions load;
  std::optional<std::int64_t> horizon;  // replaces the range of `time`
  std::optional<PlanInput> plan;
  std::vector<ConstraintText> constraints;
  /// Quantities that best traces minimize, the most important one first; see objective.h.
  std::vector<base::SourceRange> objectives = {};
  bool objectives_of_model = false;  // those that its `minimize` statements say
  bool hits_at_start = false;        // the constraints may also hold at timepoint 0
  GroundOptions ground;
  std::string producer;   // the program and its version, for the artifact; may be empty
  bool costs = false;     // also count what each axiom costs
  std::string emit_pass;  // the value after this pass is wanted as text; may be empty
  bool lint = false;      // also report legal but suspicious text (W21xx)
  /// The model will only be written (CompiledModel::folded). Clauses that hold at every timepoint
  /// are kept once, so its memory does not grow with the horizon by them.
  bool folded = false;
};

struct Compilation {
  CompiledModel model;
  std::unique_ptr<TypedModel> typed;         // the checked model, for an independent evaluation
  std::vector<StateConstraint> constraints;  // as they were asked for; part of `typed`
  std::vector<AxiomCost> costs;              // if asked for
  PassLog passes;                            // the runs with times, and the text of `emit_pass`
  std::optional<PlanGraph> plan;             // the unrolled control flow
  std::shared_ptr<const PlanFormulas> plan_formulas;  // its formulas, checked; part of `typed`
};

/// The passes of grounding and encoding, in the order in which they run. Plan and constraints are
/// encoded between the two.
std::vector<PassInfo> compile_passes();

/// The whole front end: load, parse, check, unroll the plan, ground, encode. Every error of every
/// stage that could be reached is in the sink.
base::Result<Compilation> compile_model(const CompileInput& input, base::SourceFiles& files,
                                        base::DiagnosticSink& sink);

}  // namespace parallax::compiler
