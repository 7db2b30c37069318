// Measures the cost of every stage from a model to its traces, over the number of things, rooms and
// steps.

#include <fmt/core.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tools/bench/bench.h"
#include "tools/bench/families/household.h"

namespace parallax::tools {
namespace {

struct Size {
  int items = 0;
  int rooms = 0;
  int steps = 0;
};

constexpr Size kItems[] = {{4, 2, 16}, {8, 2, 16}, {16, 2, 16}, {32, 2, 16}, {64, 2, 16}};
constexpr Size kRooms[] = {{8, 2, 24}, {8, 8, 24}, {8, 32, 24}};
constexpr Size kSteps[] = {{4, 2, 24}, {4, 2, 48}, {4, 2, 100}, {4, 2, 200}, {4, 2, 400}};

std::string written(Bench& bench, const std::string& name, const std::string& text) {
  auto file = bench.path(name);
  std::ofstream(file) << text;
  return file;
}

void measure(Bench& bench, const Size& size) {
  const auto made = household(size.items, size.rooms, size.steps);
  const auto model = written(bench, "household.e", made.model);
  const auto binding = written(bench, "household.bind", made.binding);
  const auto plan = written(bench, "household.lisp", made.plan);
  const auto artifact = bench.path("household.dec.cnf");
  const auto side = [](std::string stage, std::vector<std::string> command) {
    auto contestant = parallax_with(std::move(command));
    contestant.program = std::move(stage);
    return contestant;
  };
  const auto name = fmt::format("{} / {} / {}", size.items, size.rooms, size.steps);
  const auto stages =
      run_child({bench_program(), "stages", model, "--plan", plan, "--bind", binding},
                {bench.path("output"), "", 600.0});
  Row row;
  row.name = name;
  row.note = stages && stages->code == 0 ? stages->tail : "could not be measured";
  while (row.note.ends_with('\n')) row.note.pop_back();
  bench.add(std::move(row));
  bench.compare(
      "", {side("compile", {"compile", model, "--plan", plan, "--bind", binding, "-o", artifact}),
           side("first trace", {"traces", artifact, "--limit", "1", "--order", "any"}),
           side("count", {"traces", artifact, "--count"})});
  std::error_code ignored;
  std::filesystem::remove(artifact, ignored);
}

}  // namespace

void measure_growth(Bench& bench) {
  const auto all = [&](const char* over, const auto& sizes) {
    bench.begin(fmt::format("a household (items / rooms / steps), over its {}", over));
    for (const auto& size : sizes) measure(bench, size);
  };
  all("items", kItems);
  all("rooms", kRooms);
  all("steps", kSteps);
}

}  // namespace parallax::tools
