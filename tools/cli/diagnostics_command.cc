#include "tools/cli/command.h"

namespace parallax::tools {
namespace {

/// docs/reference/diagnostics.md: the registry as a table, one section for each hundred codes'
/// letter.
std::string registry_page() {
  std::string out =
      "# Diagnostics\n\n"
      "Every error and warning has a code that is never reused. What to do is printed behind the "
      "message as `help:`, once\nfor several messages, unless a `fix:` says it for the place. This "
      "page is made by `tools/update_docs`.\n\n"
      "| code | severity | text | what to do |\n|---|---|---|---|\n";
  const auto cell = [](std::string_view text) {
    std::string escaped;
    for (const char c : text) escaped += c == '|' ? std::string("\\|") : std::string(1, c);
    return escaped;
  };
  for (const auto& info : base::all_diagnostics()) {
    out += fmt::format("| {} | {} | {} | {} |\n", info.id,
                       info.severity == base::Severity::kError ? "error" : "warning",
                       cell(info.format), cell(info.help));
  }
  return out;
}

}  // namespace

Command diagnostics_command() {
  OptionTable command("diagnostics", "Print the table of error and warning codes");
  return {std::move(command), [](Invocation& invocation) {
            invocation.result(registry_page());
            return 0;
          }};
}

}  // namespace parallax::tools
