#include "harness/import/sdf_module.h"

#include "compiler/base/loaded_module.h"

namespace parallax::harness {

#ifdef PARALLAX_HAS_SDFORMAT

namespace {

ReadSdf* loaded_reader() {
  static auto* const kReader =
      reinterpret_cast<ReadSdf*>(base::symbol_of_module(kSdfModule, PARALLAX_MODULES, kSdfReader));
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
