#pragma once

#include <string>

namespace parallax::base {

/// Looks up a symbol of a module that is loaded while the program runs. The module `file` is
/// searched beside the program, as its run path says, then in `folder`, where it is installed. Null
/// if it is not available. The module stays loaded, since libraries do not survive being unloaded.
void* symbol_of_module(const std::string& file, const std::string& folder, const char* symbol);

}  // namespace parallax::base
