#pragma once

#include <optional>
#include <string>
#include <vector>

#include "compiler/pipeline/compile.h"
#include "compiler/pipeline/induction_model.h"
#include "runtime/induction/induction.h"
#include "tools/app/certify.h"
#include "tools/app/context.h"
#include "tools/app/model_options.h"

namespace parallax::tools {

/// `verify --unbounded`: does what holds up to the horizon hold at every timepoint?
class Unbounded {
 public:
  /// Checks that induction can speak of the model; None: it cannot, which was reported. All
  /// references outlive the object.
  static std::optional<Unbounded> of(const compiler::Compilation& compilation,
                                     const ModelOptions& options, Context& context);

  /// To be called where no violation was found up to the horizon. `kept`: the proof file beside
  /// which the proofs of the induction are kept; empty: they are checked and go.
  runtime::InductionAnswer decide(const std::string& kept);
  const std::vector<std::string>& proof_files() const { return proof_files_; }

 private:
  Unbounded(const compiler::Compilation& compilation, compiler::InductionShape shape,
            const ModelOptions& options, Context& context)
      : compilation_(compilation), shape_(shape), options_(options), context_(context) {}
  base::Result<compiler::CompiledModel> compile(std::optional<compiler::Timepoint> stretch);
  runtime::ProofVerdict prove(const runtime::ProofClaim& claim, const std::string& path, bool keep);

  const compiler::Compilation& compilation_;
  compiler::InductionShape shape_;
  const ModelOptions& options_;
  Context& context_;
  std::vector<std::string> proof_files_;
};

}  // namespace parallax::tools
