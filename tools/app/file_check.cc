#include "tools/app/file_check.h"

#include <string>
#include <vector>

#include "compiler/artifact/artifact_writer.h"
#include "compiler/pipeline/check_texts.h"
#include "tools/app/dead_retries.h"
#include "tools/app/file_kind.h"
#include "tools/app/scenario_check.h"
#include "tools/app/scenario_model.h"

namespace parallax::tools {
namespace {

bool names_scenario(const std::string& path) {
  return path.ends_with(".yaml") || path.ends_with(".yml");
}

/// Then nothing asks for clauses.
bool is_model_alone(const ModelOptions& options) {
  return options.plan.empty() && options.bind.empty() && options.regions.empty() &&
         options.until.empty() && options.minimize.empty() && !options.best && !options.property;
}

void check_model(const ModelOptions& options, Context& context) {
  const auto errors_before = context.sink().error_count();
  for (const auto& path : options.models)
    (void)expect_kind(path, {FileKind::kModel}, "a model", context);
  if (context.sink().error_count() != errors_before) return;
  (void)compiler::check_texts(compile_input(options, context), context.files(), context.sink());
}

}  // namespace

void check_files(const ModelOptions& options, Context& context) {
  std::vector<std::string> models;
  for (const auto& path : options.models) {
    // Reports into the sink; a result says only that there was nothing to report.
    auto given = options;
    given.models = {path};
    if (names_scenario(path)) {
      if (!fits_scenario(given, context)) continue;
      const auto loaded = load_scenario_model(
          path, context, {.as_run = true, .lint = options.lint, .given = &given});
      if (!loaded) continue;
      report_dead_retries(loaded->compilation, context);
      report_dead_handlers(loaded->compilation, context);
      check_before_run(*loaded, context);
    } else if (compiler::is_artifact_name(path)) {
      (void)load_artifact(given, context);
    } else {
      models.push_back(path);
    }
  }
  if (models.empty()) return;
  auto together = options;
  together.models = models;
  if (is_model_alone(together)) return check_model(together, context);
  const auto compilation = compile_models(together, context);
  if (!compilation) return;
  report_dead_retries(*compilation, context);
  report_dead_handlers(*compilation, context);
}

}  // namespace parallax::tools
