#include "compiler/base/loaded_module.h"

#include <dlfcn.h>

namespace parallax::base {

void* symbol_of_module(const std::string& file, const std::string& folder, const char* symbol) {
  for (const auto& path : {file, folder + "/" + file}) {
    void* const module = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (module == nullptr) continue;
    if (void* const found = ::dlsym(module, symbol)) return found;
  }
  return nullptr;
}

}  // namespace parallax::base
