#include "harness/import/mjcf_module.h"

#include <dlfcn.h>

#include <utility>

#include "harness/import/import.h"
#include "harness/import/limited_child.h"

namespace parallax::harness {
namespace {

#ifdef PARALLAX_HAS_MJCF

/// Beside the program, as its run path says, or where it is installed. It stays loaded.
ReadMjcf* loaded_mjcf_reader() {
  static ReadMjcf* const kReader = []() -> ReadMjcf* {
    for (const auto& file :
         {std::string(kMjcfModule), std::string(PARALLAX_MODULES) + "/" + kMjcfModule}) {
      void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
      if (module == nullptr) continue;
      if (void* reader = ::dlsym(module, kMjcfReader)) return reinterpret_cast<ReadMjcf*>(reader);
    }
    return nullptr;
  }();
  return kReader;
}

#else

ReadMjcf* loaded_mjcf_reader() { return nullptr; }

#endif

MjcfModel no_model(std::string why) {
  MjcfModel out;
  out.fault = std::move(why);
  return out;
}

}  // namespace

bool reads_mjcf() { return loaded_mjcf_reader() != nullptr; }

MjcfModel read_mjcf(const std::vector<MjcfFile>& files) {
  ReadMjcf* const read = loaded_mjcf_reader();
  if (read == nullptr) return no_model("the module that reads MJCF is not there");
  const auto work = [&] {
    MjcfModel model;
    if (!read(PARALLAX_IMPORT_VERSION, files, model)) {
      model.fault = "the module that reads MJCF is of another version";
    }
    return bytes_of(model);
  };
  const ChildAnswer answer = answer_of_child(work, kMaxMjcfAnswer, false);
  switch (answer.end) {
    case ChildEnd::kAnswered:
      break;
    case ChildEnd::kNotStarted:
      return no_model("no process can be started to read it");
    case ChildEnd::kTooLong:
      return no_model("it takes too long to read");
    case ChildEnd::kCrashed:
      return no_model("MuJoCo's reader crashed on it");
  }
  auto model = model_of(answer.bytes);
  return model ? *std::move(model) : no_model("MuJoCo's reader broke off");
}

}  // namespace parallax::harness
