#include "harness/import/mjcf_module.h"

#include <utility>

#include "compiler/base/contract.h"
#include "compiler/base/loaded_module.h"
#include "harness/import/import.h"
#include "harness/import/limited_child.h"

namespace parallax::harness {
namespace {

#ifdef PARALLAX_HAS_MJCF

ReadMjcf* loaded_mjcf_reader() {
  static auto* const kReader = reinterpret_cast<ReadMjcf*>(
      base::symbol_of_module(kMjcfModule, PARALLAX_MODULES, kMjcfReader));
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

MjcfModel read_mjcf(const std::vector<MjcfFile>& files, const std::atomic<bool>* stop) {
  ReadMjcf* const read = loaded_mjcf_reader();
  PARALLAX_REQUIRE(read != nullptr, "reads_mjcf()");
  const auto work = [&] {
    MjcfModel model;
    if (!read(PARALLAX_IMPORT_VERSION, files, model)) {
      model.fault = "the module that reads MJCF is of another version";
    }
    return bytes_of(model);
  };
  const ChildAnswer answer = answer_of_child(work, kMaxMjcfAnswer, false, stop);
  switch (answer.end) {
    case ChildEnd::kAnswered:
      break;
    case ChildEnd::kNotStarted:
      return no_model("no process can be started to read it");
    case ChildEnd::kTooLong:
      return no_model("it takes too long to read");
    case ChildEnd::kStopped:
      return no_model("it was not read to its end: the program is to end");
    case ChildEnd::kCrashed:
      return no_model("MuJoCo's reader crashed on it");
  }
  auto model = model_of(answer.bytes);
  return model ? *std::move(model) : no_model("MuJoCo's reader broke off");
}

}  // namespace parallax::harness
