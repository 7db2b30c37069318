// Two revisions of a model compared.

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tools/bench/bench.h"
#include "tools/bench/contestants.h"

namespace parallax::tools {
namespace {

constexpr const char* kKitchenFolder = PARALLAX_SOURCE_DIR "/scenarios/kitchen";

std::string kitchen_text() {
  std::ifstream in(std::string(kKitchenFolder) + "/domain.e");
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

}  // namespace

/// Driving takes the robot from its place also with one arm out: one condition less in one axiom.
void measure_difference(Bench& bench) {
  bench.begin("two revisions of the kitchen that differ in one axiom, compared");
  const auto text = kitchen_text();
  const std::string condition = "HoldsAt(Parked(right),time) & base1!=base2";
  const auto at = text.find(condition);
  if (at == std::string::npos) throw std::runtime_error("the kitchen has no such axiom");
  auto edited = text;
  edited.replace(at, condition.size(), "base1!=base2");
  std::ofstream(bench.path("old.e")) << text;
  std::ofstream(bench.path("new.e")) << edited;
  for (const auto* horizon : {"5", "15"}) {
    auto contestant = parallax_with({"diff", bench.path("old.e"), bench.path("new.e"), "--with",
                                     std::string(kKitchenFolder) + "/start.e", "-I", kKitchenFolder,
                                     "--horizon", horizon, "--quiet"});
    contestant.good_codes = {1};
    bench.compare(std::string("horizon ") + horizon, {contestant});
  }
}

}  // namespace parallax::tools
