#include "tools/cli/command.h"

#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <set>
#include <string_view>

#include "compiler/base/codes/files.h"
#include "compiler/base/diagnostic_printer.h"
#include "compiler/base/file_io.h"
#include "compiler/base/json.h"
#include "tools/app/version.h"
#include "tools/cli/limits.h"

namespace parallax::tools {

Invocation::Invocation(const CommonOptions& options)
    : Context({options.json, options.time_limit_s, options.memory_limit_mb, options.allow_outside},
              stop_flag()),
      options_(options) {}

bool Invocation::color_on(int descriptor) const {
  if (options_.color != "auto") return options_.color == "always";
  const char* no_color = std::getenv("NO_COLOR");
  if (no_color != nullptr && *no_color != '\0') return false;
  return isatty(descriptor) != 0;
}

/// A remark goes on in lines that are indented; any other line end is part of a name.
void Invocation::remark(const std::string& text) const {
  if (options_.quiet) return;
  std::string lines;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_foreign = text[i] == '\n' && text.compare(i, 2, "\n ") != 0;
    lines += is_foreign ? base::printable("\n") : std::string(1, text[i]);
  }
  write_error(lines + '\n');
}

void Invocation::result(const std::string& text) {
  keep_result(print(text, {.colors = color_on(STDOUT_FILENO)}));
}

void Invocation::exact_result(const std::string& text) { keep_result(print_exact(text)); }

void Invocation::keep_result(bool written) {
  if (written || is_lost_) return;
  is_lost_ = true;
  before_output_error_ = sink();
  stop_flag().store(true);
}

std::string error_document(const std::vector<base::Diagnostic>& diagnostics,
                           const base::SourceFiles& files) {
  return fmt::format("{{\"status\":\"error\",\"diagnostics\":{}}}\n",
                     base::to_json(diagnostics, files));
}

void Invocation::document(std::string json) { document_ = std::move(json); }

/// A reader that has seen enough (head) closes the pipe, which is not an error of ours.
void Invocation::report_output_error() {
  if (!is_lost_ || output_error() == EPIPE) return;
  sink().error_about(codes::kFileNotWritable, "standard output", std::strerror(output_error()));
  output_error_is_told();
}

void Invocation::print_diagnostics(const std::vector<base::Diagnostic>& diagnostics) const {
  if (options_.diagnostics == "sarif") {
    write_error(base::to_sarif(diagnostics, files(), kVersion) + '\n');
    return;
  }
  if (options_.diagnostics == "json") {
    if (!diagnostics.empty()) write_error(base::to_json(diagnostics, files()) + '\n');
    return;
  }
  std::set<std::string_view> said;  // the same advice once
  for (const auto& diagnostic : diagnostics) {
    const bool is_error = base::info(diagnostic.code).severity == base::Severity::kError;
    if (options_.quiet && !is_error) continue;
    const bool help = diagnostic.fix.empty() && said.insert(base::help_of(diagnostic)).second;
    const bool color = color_on(STDERR_FILENO);
    write_error(base::to_text(diagnostic, files(), {color, help}), {.colors = color});
  }
  const auto rest = [](std::size_t count, const char* what) {
    if (count <= base::DiagnosticSink::kUsualLimit) return;
    const auto hidden = count - base::DiagnosticSink::kUsualLimit;
    write_error(fmt::format("{} further {} not shown\n", hidden, what));
  };
  rest(sink().error_count() - sink().merged_count(), "errors are");
  if (!options_.quiet) rest(sink().warning_count(), "warnings are");
}

/// Writes the names of the files that were read or looked for in vain, and the memory that was
/// used.
void Invocation::write_footprint() {
  if (options_.footprint.empty()) return;
  std::set<std::string> inputs, absent;
  for (const auto& input : files().inputs()) {
    std::error_code error;
    const bool is_there = std::filesystem::exists(input, error);
    (is_there ? inputs : absent).insert(input);
  }
  rusage own{}, children{};
  ::getrusage(RUSAGE_SELF, &own);
  ::getrusage(RUSAGE_CHILDREN, &children);
  const nlohmann::json json = {
      {"schema_version", 1},
      {"inputs", inputs},
      {"absent", absent},
      {"peak_memory_mb", (own.ru_maxrss + children.ru_maxrss + 1023) / 1024}};
  (void)base::write_output(options_.footprint, base::json_text(json) + '\n', files(), sink());
}

int Invocation::finish(int code) {
  // Drops the reports after the output was lost: they are about having been stopped by that.
  if (is_lost_) sink() = before_output_error_;
  report_output_error();
  write_footprint();
  const auto diagnostics = sink().sorted();
  print_diagnostics(diagnostics);
  if (!document_.empty()) {
    const auto end = document_.rfind('}');
    if (!diagnostics.empty()) {
      document_.insert(end, ",\"diagnostics\":" + base::to_json(diagnostics, files()));
    }
    result(document_);
  } else if (options_.json && (sink().has_errors() || code != 0)) {
    result(error_document(diagnostics, files()));
  }
  if (!sink().has_errors()) return code;
  // A command with a code of its own (a finding, an interruption) keeps it.
  return code != 0 ? code : sink().exit_code();
}

void add_common_options(OptionTable& table, CommonOptions& options) {
  const UnderHeading general(table, kGeneralHeading);
  table.flag("--json", options.json, "Print exactly one JSON document on standard output");
  table.flag("-q,--quiet", options.quiet, "Print no progress, remarks or warnings");
  table.flag("-v,--verbose", options.verbosity, "Say more on standard error");
  table.option("--color", options.color, "When to use colour")
      .check(OneOf{{"auto", "always", "never"}})
      .show_default();
  table.option("--diagnostics", options.diagnostics, "Form of errors and warnings")
      .check(OneOf{{"text", "json", "sarif"}})
      .show_default();
  table.option("--time-limit", options.time_limit_s, "End the run after this many seconds")
      .check(FiniteNumber{1e-3, 1e7});
  table.option("--memory-limit", options.memory_limit_mb, "End the run above this many MB")
      .check(WholeNumber{16, 10'000'000});
  table.flag("--allow-outside", options.allow_outside,
             "Let files name files outside their folder (docs/reference/trust.md)");
  table
      .option("--footprint", options.footprint,
              "Write which files were read, and how much memory was used, as JSON")
      .file();
}

}  // namespace parallax::tools
