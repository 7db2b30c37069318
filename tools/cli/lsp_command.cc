#include <unistd.h>

#include <csignal>

#include "tools/cli/command.h"
#include "tools/lsp/server.h"

namespace parallax::tools {

Command lsp_command() {
  OptionTable command(
      "lsp",
      "Language server: messages, names and fixes for editors, on standard input and output");
  command.footer(
      "An editor starts it and speaks to it (Language Server Protocol 3.17). It checks models, "
      "binding\n"
      "tables and scenarios as `check` does, while they are typed. Nothing is written, and no "
      "command\n"
      "of a scenario is started. docs/guide/models.md says how editors are told about it.\n"
      "Exit codes: 0 the editor ended it, 1 the editor went away.");
  return {std::move(command), [](Invocation& invocation) {
            // It has nothing to finish, and may be waiting for its client.
            std::signal(SIGINT, SIG_DFL);
            std::signal(SIGTERM, SIG_DFL);
            const int code = lsp::serve_editor(STDIN_FILENO, STDOUT_FILENO);
            invocation.answered();
            return code;
          }};
}

}  // namespace parallax::tools
