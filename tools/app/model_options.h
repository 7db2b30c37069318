#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/artifact/artifact_reader.h"
#include "compiler/pipeline/compile.h"
#include "tools/app/context.h"

namespace parallax::tools {

/// The options of every command that reads a model.
struct ModelOptions {
  std::vector<std::string> models;
  std::vector<std::string> include_dirs;
  std::string compat;                      // "decreasoner", or empty for the standard meaning
  std::int64_t horizon = -1;               // -1: as the model says
  std::vector<std::string> until;          // state constraints
  std::vector<std::string> minimize = {};  // objectives, the most important one first
  bool best = false;  // by the objectives that the model's `minimize` statements say
  /// `verify`: traces end where this formula does not hold.
  std::optional<std::string> property = std::nullopt;
  std::vector<std::string> plan;  // Lisp files and folders in order; none or with `bind`
  std::string bind;               // the binding table
  std::string plan_entry;         // the function to run; empty: as the plan says
  std::string regions;            // the scenario whose regions the plan's poses lie in
  compiler::UnrollLimits unroll;
  std::string par = "in-order";   // the branches of `par`: in-order or interleave
  std::int64_t max_horizon = 50;  // of plans, where nothing says the horizon
  bool lint = false;              // `check`: report what is legal but hardly meant
  std::string emit_pass;          // `compile`: the pass whose value is printed
  bool stats = false;             // count what each axiom costs; commands offer it themselves
  bool folded = false;            // `compile`: the model is only to be written
};

compiler::CompileInput compile_input(const ModelOptions& options, const Context& context);

/// May the options be given with the scenario that they name? Reports the first one that says what
/// the scenario says itself (kUsage).
base::Status fits_scenario(const ModelOptions& options, Context& context);

/// Is one of the models a compiled one (`.cnf`)?
bool names_artifact(const ModelOptions& options);
/// The compiled model that the options name, read without the front end. Reports a second model,
/// options that belong to the compilation, and another horizon (E6014).
base::Result<compiler::CompiledModel> load_artifact(const ModelOptions& options, Context& context);

}  // namespace parallax::tools
