// Four threads compile models of their own and list the traces of one that they share.

#include <atomic>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "parallax/parallax.h"

namespace px = parallax::api;

int main(int argc, char** argv) {
  if (argc < 2) return std::fputs("usage: four_threads MODEL.e...\n", stderr), 2;
  const std::vector<std::string> files(argv + 1, argv + argc);
  const px::Model shared = px::Model::load({.files = files});
  std::vector<std::string> counts(4), lists(4);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 4; ++i) {
    threads.emplace_back([&, i] {
      counts[i] = px::Model::load({.files = files}).count();
      shared.traces(5, [&](const px::Trace& trace) { return lists[i] += trace.text, true; });
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 1; i < 4; ++i) {
    if (counts[i] != counts[0] || lists[i] != lists[0]) return std::puts("the threads disagree"), 1;
  }
  std::printf("%s traces, counted and listed alike by four threads\n", counts[0].c_str());
  return 0;
}
