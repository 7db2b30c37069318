#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/codes/files.h"
#include "compiler/base/suggest.h"
#include "tools/cli/command.h"

namespace parallax::tools {
namespace {

std::string_view severity_of(const base::DiagnosticInfo& info) {
  return info.severity == base::Severity::kError ? "error" : "warning";
}

/// Every code with its text, as a table of Markdown.
std::string table_of_codes() {
  std::string out = "| code | text |\n|---|---|\n";
  const auto cell = [](std::string_view text) {
    std::string escaped;
    for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
    return escaped;
  };
  for (const auto& info : base::all_diagnostics()) {
    out += fmt::format("| {} | {} |\n", info.id, cell(info.format));
  }
  return out;
}

struct DiagnosticsOptions {
  std::vector<std::string> codes;
};

void refuse(const std::string& code, base::DiagnosticSink& sink) {
  std::vector<std::string> ids;
  for (const auto& one : base::all_diagnostics()) ids.emplace_back(one.id);
  auto error = sink.error_about(codes::kUsage, code, "there is no such code");
  if (const auto near = base::nearest_name(code, ids)) {
    error.fix(fmt::format("replace `{}` with `{}`", base::printable(code), *near));
  }
  error.note("`parallax diagnostics` lists them");
}

int show_diagnostics(const DiagnosticsOptions& options, Invocation& invocation) {
  if (options.codes.empty()) {
    invocation.result(table_of_codes());
    return 0;
  }
  const auto& all = base::all_diagnostics();
  std::string out;
  for (const auto& code : options.codes) {
    const auto info =
        std::find_if(all.begin(), all.end(), [&](const auto& one) { return one.id == code; });
    if (info == all.end()) {
      refuse(code, invocation.sink());
      return 0;
    }
    out += fmt::format("{}[{}]: {}\nhelp: {}\n", severity_of(*info), info->id, info->format,
                       info->help);
  }
  invocation.result(out);
  return 0;
}

}  // namespace

Command diagnostics_command() {
  auto options = std::make_shared<DiagnosticsOptions>();
  OptionTable command("diagnostics", "Print the table of error and warning codes");
  command.footer(
      "Examples:\n"
      "  parallax diagnostics\n"
      "  parallax diagnostics E2104 W5138");
  command.option("codes", options->codes, "Codes: print what to do, instead of the table");
  return command_of(std::move(command), options, show_diagnostics);
}

}  // namespace parallax::tools
