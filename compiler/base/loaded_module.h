#pragma once

#include <string>

namespace parallax::base {

/// What a module that is loaded while the program runs offers under a name. The module `file` is
/// looked for beside the program, as its run path says, then in `folder`, where it is installed.
/// Null: it is not to be had. It stays loaded; libraries do not survive being taken away.
void* symbol_of_module(const std::string& file, const std::string& folder, const char* symbol);

}  // namespace parallax::base
