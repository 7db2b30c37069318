// Loads the plugin by its path and asks it.

#include <dlfcn.h>

#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 3) return std::fputs("usage: host PLUGIN.so MODEL.e\n", stderr), 2;
  void* plugin = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
  if (plugin == nullptr) return std::fprintf(stderr, "%s\n", dlerror()), 3;
  using Count = int (*)(const char*, char*, unsigned long);
  const auto count = reinterpret_cast<Count>(dlsym(plugin, "count_traces"));
  if (count == nullptr) return std::fprintf(stderr, "%s\n", dlerror()), 3;
  char text[4096];
  const int code = count(argv[2], text, sizeof text);
  std::printf("%s\n", text);
  return code;
}
