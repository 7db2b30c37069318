// A plugin: one C function over libparallax, for hosts in any language.

#include <algorithm>
#include <cstring>
#include <exception>

#include "parallax/parallax.h"

/// Writes the number of traces of a model, or what is wrong with it, into `text`. 0: counted.
extern "C" __attribute__((visibility("default"))) int count_traces(const char* file, char* text,
                                                                   unsigned long size) {
  std::string out;
  int code = 0;
  try {
    out = parallax::api::Model::load({.files = {file}}).count();
  } catch (const std::exception& failure) {
    out = failure.what();
    code = 3;
  }
  const auto length = std::min<std::size_t>(out.size(), size - 1);
  std::memcpy(text, out.data(), length);
  text[length] = 0;
  return code;
}
