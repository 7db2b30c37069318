#pragma once

namespace parallax::tools::lsp {

/// A language server (Microsoft 2022, Language Server Protocol 3.17) for models, plans' binding
/// tables and scenarios, which speaks on two descriptors until its client ends it or goes away.
/// Returns the exit code: 0 after `shutdown` and `exit`, 1 where the client left without them or
/// sent what is no message.
int serve_editor(int in, int out);

}  // namespace parallax::tools::lsp
