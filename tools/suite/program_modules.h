#pragma once

#include <string>
#include <vector>

namespace parallax::tools {

/// The modules that this program, or a child of it, may load while it runs, and all libraries that
/// the dynamic linker finds for them, sorted: engines and readers of meshes are none of the
/// libraries that are loaded from the beginning.
std::vector<std::string> module_files();

/// The modules in these folders, with their libraries.
std::vector<std::string> module_files_in(const std::vector<std::string>& folders);

}  // namespace parallax::tools
