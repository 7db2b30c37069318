#include <fmt/core.h>

#include <filesystem>
#include <vector>

#include "compiler/artifact/artifact_writer.h"
#include "compiler/artifact/describe.h"
#include "compiler/cnf/encoder.h"
#include "compiler/ground/grounder.h"
#include "compiler/sema/check.h"
#include "compiler/syntax/loader.h"
#include "tools/bench/bench.h"
#include "tools/bench/stopwatch.h"

namespace parallax::tools {

int print_stages(const std::string& file) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  Stopwatch watch;
  const std::vector<std::filesystem::path> paths = {file};
  const auto ast = compiler::load_model(paths, {}, files, sink);
  if (!ast) return 3;
  const auto typed = compiler::check_model(*ast, files, sink);
  if (!typed) return 3;
  auto ground = compiler::ground_model(*typed, {}, sink);
  if (!ground) return 3;
  const double ground_ms = watch.lap_ms();
  auto model = compiler::encode(*ground);
  compiler::describe_sources(model, files);
  compiler::sort_clauses(model);
  const double encode_ms = watch.lap_ms();
  const auto text = compiler::to_artifact(model);
  const double write_ms = watch.lap_ms();
  fmt::print(
      "read and ground {:.1f} ms, clauses {:.1f} ms, text {:.1f} ms; {} clauses, {:.1f} MB\n",
      ground_ms, encode_ms, write_ms, model.clauses.size(),
      1e-6 * static_cast<double>(text.size()));
  return 0;
}

}  // namespace parallax::tools
