#include "harness/import/sdf_module.h"

#include <dlfcn.h>

#include <string>

namespace parallax::harness {

#ifdef PARALLAX_HAS_SDFORMAT

namespace {

/// Beside the program, as its run path says, or where it is installed. It stays loaded: the library
/// does not survive being taken away.
ReadSdf* loaded_reader() {
  static ReadSdf* const kReader = []() -> ReadSdf* {
    for (const auto& file :
         {std::string(kSdfModule), std::string(PARALLAX_MODULES) + "/" + kSdfModule}) {
      void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
      if (module == nullptr) continue;
      if (void* reader = ::dlsym(module, kSdfReader)) return reinterpret_cast<ReadSdf*>(reader);
    }
    return nullptr;
  }();
  return kReader;
}

}  // namespace

bool reads_sdf() { return loaded_reader() != nullptr; }

ImportedWorld import_sdf(const ImportInput& input) {
  ImportedWorld world;
  ReadSdf* const read = loaded_reader();
  if (read == nullptr) {
    world.fault = TextFault{0, "the module that reads SDF is not there"};
  } else if (!read(PARALLAX_IMPORT_VERSION, input, world)) {
    world.fault = TextFault{0, "the module that reads SDF is of another version"};
  }
  return world;
}

#else

bool reads_sdf() { return false; }

ImportedWorld import_sdf(const ImportInput& /*input*/) {
  ImportedWorld world;
  world.fault = TextFault{0, "this build reads no SDF"};
  return world;
}

#endif

}  // namespace parallax::harness
