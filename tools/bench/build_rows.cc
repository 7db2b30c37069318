// Measures the cost of building the program: from nothing, with the tests, and after a change.

#include <fmt/core.h>

#include <array>
#include <fstream>
#include <string>
#include <vector>

#include "tools/bench/bench.h"

namespace parallax::tools {
namespace {

namespace fs = std::filesystem;

// Generous: an instrumented build on a busy machine must not end in the middle.
constexpr double kLimit_s = 3600.0;
constexpr const char* kSource = PARALLAX_SOURCE_DIR;

/// The files that a build reads, copied: the measurement edits some of them.
void copy_source(const fs::path& to) {
  fs::create_directories(to);
  for (const auto* name : {"CMakeLists.txt", "CMakePresets.json"}) {
    fs::copy_file(fs::path(kSource) / name, to / name);
  }
  for (const auto* name :
       {"compiler", "runtime", "harness", "tools", "tests", "docs", "scenarios"}) {
    fs::copy(fs::path(kSource) / name, to / name, fs::copy_options::recursive);
  }
}

class BuildRows {
 public:
  explicit BuildRows(Bench& bench) : bench_(bench), source_(bench.path("source")) {
    copy_source(source_);
  }

  void measure() {
    const auto reference = run({"g++", "-std=c++20", "-O2", "-c", "-x", "c++",
                                std::string(kSource) + "/tools/bench/build_reference.txt", "-o",
                                bench_.path("reference.o")});
    if (!reference) return bench_.add(row("the reference file", reference, "g++"));
    reference_ = *reference;
    bench_.add(row("the reference file", reference, "g++ -O2 -c"));
    (void)run({"cmake", "--preset", "release"});
    add("the program, from nothing", {"parallax"});
    add("tests and benchmarks", {"all", "bench"});
    for (const auto* file : {"compiler/ground/grounder.cc", "runtime/proof/drat_checker.cc",
                             "harness/campaign/campaign.cc", "tools/cli/main.cc"}) {
      if (!fs::exists(fs::path(source_) / file)) continue;
      std::ofstream(fs::path(source_) / file, std::ios::app) << "// changed\n";
      add(fmt::format("after a change of {}", fs::path(file).filename().string()), {"parallax"});
    }
  }

 private:
  std::optional<Cost> run(const std::vector<std::string>& command) {
    // A compiler cache would measure the cache.
    std::vector<std::string> plain = {"env", "CCACHE_DISABLE=1"};
    plain.insert(plain.end(), command.begin(), command.end());
    const auto child = run_child(plain, {bench_.path("output"), source_, kLimit_s});
    if (!child || child->code != 0) return std::nullopt;
    return child->cost;
  }

  Row row(const std::string& name, const std::optional<Cost>& cost, const std::string& command) {
    Side side{"build", command, cost, 1, "", ""};
    if (!cost) side.remark = "the command failed";
    return {"", name, {side}, {}, ""};
  }

  void add(const std::string& name, const std::vector<std::string>& targets) {
    std::vector<std::string> command = {"cmake", "--build", "--preset", "release", "--target"};
    command.insert(command.end(), targets.begin(), targets.end());
    const auto cost = run(command);
    auto result = row(name, cost, "cmake --build --preset release --target " + targets.front());
    if (cost) {
      result.note = fmt::format("{:.1f} times the reference file's processor time",
                                cost->cpu_s / reference_.cpu_s);
    }
    bench_.add(std::move(result));
  }

  Bench& bench_;
  std::string source_;
  Cost reference_;
};

}  // namespace

void measure_build(Bench& bench) {
  bench.begin("building, without a compiler cache");
  BuildRows(bench).measure();
}

}  // namespace parallax::tools
