// Includes point downwards only, and each third-party library stays behind its seam.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // relative to the repository
  std::string target;  // between the quotes or brackets
  bool system = false;
};

std::vector<std::string> source_files() {
  const fs::path root = PARALLAX_SOURCE_DIR;
  std::vector<std::string> files;
  for (const auto* folder : {"compiler", "runtime", "harness", "tools"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const auto extension = entry.path().extension();
      if (extension == ".h" || extension == ".cc") {
        files.push_back(fs::relative(entry.path(), root).generic_string());
      }
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<Include> includes_of(const std::string& file) {
  std::ifstream in(fs::path(PARALLAX_SOURCE_DIR) / file);
  std::vector<Include> includes;
  std::string line;
  while (std::getline(in, line)) {
    if (!line.starts_with("#include ")) continue;
    const char open = line[9];
    const auto end = line.find(open == '<' ? '>' : '"', 10);
    includes.push_back({file, line.substr(10, end - 10), open == '<'});
  }
  return includes;
}

/// "compiler/ground" of "compiler/ground/effects.h"; "tools" of "tools/cli/main.cc".
std::string module_of(const std::string& path) {
  const auto first = path.find('/');
  if (path.starts_with("tools/")) return "tools";
  return path.substr(0, path.find('/', first + 1));
}

/// What each module may include besides itself.
const std::map<std::string, std::vector<std::string>>& allowed() {
  static const std::vector<std::string> front = {"compiler/base", "compiler/artifact"};
  static const std::vector<std::string> harness = {
      "compiler/base", "runtime/trace",      "harness/region", "harness/sampling",
      "harness/world", "harness/confidence", "harness/config", "harness/campaign"};
  static const std::map<std::string, std::vector<std::string>> table = {
      {"compiler/base", {}},
      {"compiler/artifact", {"compiler/base"}},
      {"compiler/syntax", {"compiler/base"}},
      {"compiler/sema", {"compiler/base", "compiler/syntax"}},
      {"compiler/lint", {"compiler/base", "compiler/syntax", "compiler/sema"}},
      {"compiler/compare",
       {"compiler/base", "compiler/syntax", "compiler/plan", "compiler/artifact"}},
      {"compiler/asp", {"compiler/base", "compiler/sema"}},
      {"compiler/formula", front},
      {"compiler/plan", {"compiler/base"}},
      {"compiler/ground",
       {"compiler/base", "compiler/artifact", "compiler/sema", "compiler/formula"}},
      {"compiler/cnf",
       {"compiler/base", "compiler/artifact", "compiler/ground", "compiler/formula"}},
      {"compiler/reference", {"compiler/base", "compiler/sema"}},
      {"compiler/pipeline",
       {"compiler/base", "compiler/artifact", "compiler/syntax", "compiler/sema", "compiler/ground",
        "compiler/formula", "compiler/cnf", "compiler/plan", "compiler/lint"}},
      {"runtime/solver", front},
      {"runtime/session", {"compiler/base", "compiler/artifact", "runtime/solver"}},
      {"runtime/proof", {"compiler/base"}},
      {"runtime/trace", front},
      {"runtime/certify",
       {"compiler/base", "compiler/artifact", "runtime/proof", "runtime/solver", "runtime/session",
        "runtime/trace"}},
      {"runtime/explain",
       {"compiler/base", "compiler/artifact", "runtime/proof", "runtime/solver"}},
      {"runtime/enumerate",
       {"compiler/base", "compiler/artifact", "runtime/solver", "runtime/session",
        "runtime/trace"}},
      {"runtime/compare",
       {"compiler/base", "compiler/artifact", "runtime/solver", "runtime/session", "runtime/trace",
        "runtime/enumerate", "runtime/graph"}},
      {"runtime/graph",
       {"compiler/base", "compiler/artifact", "runtime/solver", "runtime/session",
        "runtime/trace", "runtime/enumerate"}},
      {"runtime/replay",
       {"compiler/base", "compiler/artifact", "runtime/solver", "runtime/session",
        "runtime/trace"}},
      {"harness/region", {"compiler/base", "harness/world"}},  // State of simulator.h only
      {"harness/sampling", {"compiler/base", "harness/region", "harness/world"}},
      {"harness/world", {"compiler/base"}},
      {"harness/confidence", {"compiler/base", "harness/region", "harness/world"}},
      {"harness/config",
       {"compiler/base", "harness/region", "harness/world", "harness/confidence",
        "harness/sampling"}},
      {"harness/campaign", harness},
      {"harness/draw", {"compiler/base", "harness/region", "harness/world"}},
      {"harness/report", harness},
  };
  return table;
}

TEST_CASE("every include points downwards") {
  const auto files = source_files();
  REQUIRE(files.size() > 50);
  for (const auto& file : files) {
    const auto module = module_of(file);
    if (module == "tools") continue;  // the top of the house
    const auto rule = allowed().find(module);
    REQUIRE_MESSAGE(rule != allowed().end(), module << " has no rule in this test");
    for (const auto& include : includes_of(file)) {
      if (include.system) continue;
      const auto target = module_of(include.target);
      const bool fine =
          target == module || std::count(rule->second.begin(), rule->second.end(), target) != 0;
      CHECK_MESSAGE(fine, file << " includes " << include.target);
    }
  }
}

TEST_CASE("each third-party library stays behind its seam") {
  struct Seam {
    std::string prefix;               // of the include
    std::vector<std::string> places;  // path prefixes that may have it
  };
  const std::vector<Seam> seams = {
      {"cadical", {"runtime/solver/cadical_solver.cc", "tools/bench/plain_cadical.cc"}},
      {"ode/", {"harness/world/ode_"}},
      {"yaml-cpp/", {"harness/config/"}},
      {"CLI/", {"tools/"}},
      {"Eigen/", {"harness/", "tools/bench/"}},
  };
  for (const auto& file : source_files()) {
    for (const auto& include : includes_of(file)) {
      if (!include.system) continue;
      if (include.target.starts_with("nlohmann/")) {
        CHECK_MESSAGE(!file.ends_with(".h"), file << " shows a JSON type in a header");
      }
      for (const auto& seam : seams) {
        if (!include.target.starts_with(seam.prefix)) continue;
        const bool fine = std::any_of(seam.places.begin(), seam.places.end(),
                                      [&](const auto& place) { return file.starts_with(place); });
        CHECK_MESSAGE(fine, file << " includes <" << include.target << ">");
      }
    }
  }
}

TEST_CASE("libraries neither print nor exit") {
  for (const auto& file : source_files()) {
    if (file.starts_with("tools/")) continue;
    std::ifstream in(fs::path(PARALLAX_SOURCE_DIR) / file);
    std::string line;
    while (std::getline(in, line)) {
      const auto code = line.substr(0, line.find("//"));
      for (const auto* word : {"std::cout", "std::cerr", "std::exit(", "printf("}) {
        const bool here =
            code.find(word) != std::string::npos && code.find("snprintf(") == std::string::npos;
        CHECK_MESSAGE(!here, file << ": " << line);
      }
    }
  }
}

}  // namespace
