#include "tools/app/unbounded.h"

#include "compiler/base/codes/files.h"
#include "compiler/base/file_io.h"
#include "compiler/base/temporary_folder.h"

namespace parallax::tools {

std::optional<Unbounded> Unbounded::of(const compiler::Compilation& compilation,
                                       const ModelOptions& options, Context& context) {
  const auto& first = options.models.front();
  if (compilation.plan || !options.compat.empty() || first.ends_with(".yaml") ||
      first.ends_with(".yml")) {
    context.sink().error_about(codes::kUsage, first,
                               "--unbounded is for models without a plan, in the default meaning");
    return std::nullopt;
  }
  const auto shape = compiler::induction_shape(compilation, context.sink());
  if (!shape) return std::nullopt;
  return Unbounded(compilation, *shape, options, context);
}

base::Result<compiler::CompiledModel> Unbounded::compile(
    std::optional<compiler::Timepoint> stretch) {
  // Warnings were told of the model itself.
  base::DiagnosticSink sink;
  const auto options = compile_input(options_, context_).ground;
  auto model = compiler::compile_breaks(*compilation_.typed, shape_, stretch, options, sink);
  if (!model) context_.sink().adopt(sink, shape_.source, "--unbounded");
  return model;
}

runtime::ProofVerdict Unbounded::prove(const runtime::ProofClaim& claim, const std::string& path,
                                       bool keep) {
  for (const auto* suffix : {"", ".cnf", ".part", ".cnf.part"}) {
    if (!base::check_output(path + suffix, context_.files(), context_.sink())) {
      return runtime::ProofVerdict::kNotFinished;
    }
  }
  auto files = runtime::ProofFiles::create(path, context_.sink());
  if (!files) return runtime::ProofVerdict::kNotFinished;
  const auto certificate = runtime::prove(claim, *files, proof_limits(context_), context_.sink());
  if (keep && certificate.verdict == runtime::ProofVerdict::kAccepted) {
    proof_files_.push_back(path);
  }
  return certificate.verdict;
}

runtime::InductionAnswer Unbounded::decide(const std::string& kept) {
  const auto whole = compile(std::nullopt);
  if (!whole) return {runtime::InductionVerdict::kNotProved, 0, 0, std::nullopt};
  const base::TemporaryFolder folder("induction");
  const auto prefix = kept.empty() ? (folder.path() / "induction").string() : kept;
  runtime::InductionTask task;
  task.whole = &*whole;
  task.window = [this](compiler::Timepoint steps) { return compile(steps); };
  task.last_fixed = shape_.last_fixed;
  task.width = shape_.width;
  task.back = shape_.back;
  task.ahead = shape_.ahead;
  task.stop = &context_.stop();
  return runtime::decide_by_induction(
      task, [&](const runtime::ProofClaim& claim, std::string_view name) {
        return prove(claim, prefix + '.' + std::string(name), !kept.empty());
      });
}

}  // namespace parallax::tools
