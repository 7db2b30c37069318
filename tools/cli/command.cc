#include "tools/cli/command.h"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>

#include "compiler/base/diagnostic_printer.h"

namespace parallax::tools {

bool Invocation::color_on(int descriptor) const {
  if (options_.color != "auto") return options_.color == "always";
  const char* no_color = std::getenv("NO_COLOR");
  if (no_color != nullptr && *no_color != '\0') return false;
  return isatty(descriptor) != 0;
}

void Invocation::remark(const std::string& text) const {
  if (!options_.quiet) fmt::print(stderr, "{}\n", text);
}

void Invocation::result(const std::string& text) const {
  std::fwrite(text.data(), 1, text.size(), stdout);
  std::fflush(stdout);
}

std::string error_document(const std::vector<base::Diagnostic>& diagnostics,
                           const base::SourceFiles& files) {
  return fmt::format("{{\"status\":\"error\",\"diagnostics\":{}}}\n",
                     base::to_json(diagnostics, files));
}

void Invocation::document(std::string json) { document_ = std::move(json); }

int Invocation::finish(int code) {
  const auto diagnostics = sink_.sorted();
  if (options_.diagnostics == "json") {
    if (!diagnostics.empty()) {
      fmt::print(stderr, "{}\n", base::to_json(diagnostics, files_));
    }
  } else {
    for (const auto& diagnostic : diagnostics) {
      const bool is_error = base::info(diagnostic.code).severity == base::Severity::kError;
      if (options_.quiet && !is_error) continue;
      fmt::print(stderr, "{}", base::to_text(diagnostic, files_, {color_on(STDERR_FILENO)}));
    }
    const auto shown = static_cast<std::size_t>(20);
    if (sink_.error_count() > shown) {
      fmt::print(stderr, "{} further errors are not shown\n", sink_.error_count() - shown);
    }
  }
  if (!document_.empty()) {
    const auto end = document_.rfind('}');
    if (!diagnostics.empty()) {
      document_.insert(end, ",\"diagnostics\":" + base::to_json(diagnostics, files_));
    }
    result(document_);
  } else if (options_.json && (sink_.has_errors() || code != 0)) {
    result(error_document(diagnostics, files_));
  }
  if (!sink_.has_errors()) return code;
  // A command that knows better (a finding, an interruption) keeps its code.
  return code != 0 ? code : sink_.exit_code();
}

void add_common_options(CLI::App& app, CommonOptions& options) {
  app.add_flag("--json", options.json, "Print exactly one JSON document on standard output");
  app.add_flag("-q,--quiet", options.quiet, "Print no progress, remarks or warnings");
  app.add_flag("-v,--verbose", options.verbosity, "Say more on standard error");
  app.add_option("--color", options.color, "When to use colour")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->capture_default_str();
  app.add_option("--diagnostics", options.diagnostics, "Form of errors and warnings")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  app.add_option("--time-limit", options.time_limit_s, "End the run after this many seconds")
      ->check(CLI::PositiveNumber);
  app.add_option("--memory-limit", options.memory_limit_mb, "End the run above this many MB")
      ->check(CLI::PositiveNumber);
}

}  // namespace parallax::tools
