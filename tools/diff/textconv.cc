#include "tools/diff/textconv.h"

#include "compiler/artifact/artifact_reader.h"
#include "compiler/base/diagnostic_codes.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/compare/model_facts.h"
#include "compiler/syntax/parser.h"
#include "tools/diff/revision.h"
#include "tools/diff/run_facts.h"
#include "tools/diff/trace_set.h"

namespace parallax::tools {
namespace {

using Text = base::Result<std::string>;

Text model_text(const std::string& path, Context& context) {
  const auto file = base::load_text(path, context.files(), context.sink());
  if (!file) return context.sink().already_reported();
  const auto ast = compiler::parse_file(*file, context.files(), context.sink());
  if (context.sink().has_errors()) return context.sink().already_reported();
  return canonical_text(compiler::text_facts(ast, context.files()));
}

Text artifact_text(const std::string& path, Context& context) {
  const auto model = compiler::load_artifact(path, context.files(), context.sink());
  if (!model) return context.sink().already_reported();
  return canonical_text(compiler::artifact_facts(*model));
}

Text plan_text(const std::string& path, RevisionKind kind, Context& context) {
  const auto plan = load_plan_revision(path, kind, context);
  if (!plan) return context.sink().already_reported();
  return plan->lisp ? compiler::canonical_plan(*plan->lisp) : canonical_text(plan->facts);
}

}  // namespace

Text canonical_text_of(const std::string& path, Context& context) {
  const auto kind = kind_of(path);
  if (kind) {
    switch (*kind) {
      case RevisionKind::kModel:
        return model_text(path, context);
      case RevisionKind::kArtifact:
        return artifact_text(path, context);
      case RevisionKind::kPlan:
      case RevisionKind::kBinding:
        return plan_text(path, *kind, context);
      case RevisionKind::kTraces: {
        const auto set = load_trace_set(path, context);
        if (!set) return context.sink().already_reported();
        return canonical_text(*set);
      }
      case RevisionKind::kRun: {
        const auto facts = load_run_facts(path, context);
        if (!facts) return context.sink().already_reported();
        return canonical_text(*facts);
      }
      case RevisionKind::kScenario:
        break;
    }
  }
  return context.sink().error_about(
      base::DiagnosticCode::kUsage, path,
      "there is a canonical text of models (.e, .dec.cnf), plans (.lisp, .bind), trace files "
      "(.jsonl) and runs only");
}

}  // namespace parallax::tools
