// Includes point downwards only, and each third-party library stays behind its seam.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

struct Include {
  std::string file;    // relative to the repository
  std::string target;  // between the quotes or brackets
  bool system = false;
};

std::vector<std::string> source_files(const std::vector<std::string>& folders = {
                                          "compiler", "runtime", "harness", "tools"}) {
  const fs::path root = PARALLAX_SOURCE_DIR;
  std::vector<std::string> files;
  for (const auto& folder : folders) {
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

/// "compiler/ground" of "compiler/ground/effects.h".
std::string folder_of(const std::string& path) { return path.substr(0, path.rfind('/')); }

/// The build's structure: the libraries whose sources lie in each folder, and the dependencies of
/// each library. CMake writes it down from the same lists that the linker gets.
struct Layers {
  std::map<std::string, std::set<std::string>> libraries;  // by folder
  std::map<std::string, std::set<std::string>> depends;    // by library
  std::map<std::string, std::string> folders;              // by library; one of its folders

  static Layers read() {
    Layers layers;
    std::ifstream in(fs::path(PARALLAX_BINARY_DIR) / "generated/layers.txt");
    std::string line;
    while (std::getline(in, line)) {
      std::istringstream words(line);
      std::string folder, library, other;
      words >> folder >> library;
      layers.libraries[folder].insert(library);
      layers.folders[library] = folder;
      auto& depends = layers.depends[library];
      while (words >> other) {
        if (other.starts_with("parallax::")) depends.insert(other);
      }
    }
    return layers;
  }

  /// The folder of the library that a file of `folder` belongs to: its own or the nearest around
  /// it.
  std::string home_of(std::string folder) const {
    while (!libraries.contains(folder) && folder.find('/') != std::string::npos)
      folder.resize(folder.rfind('/'));
    return folder;
  }

  /// Everything below the libraries of a folder, themselves included.
  std::set<std::string> below(const std::string& folder) const {
    std::set<std::string> seen;
    const auto found = libraries.find(folder);
    if (found == libraries.end()) return seen;
    std::vector<std::string> open(found->second.begin(), found->second.end());
    while (!open.empty()) {
      const auto library = open.back();
      open.pop_back();
      if (!seen.insert(library).second) continue;
      const auto& next = depends.at(library);
      open.insert(open.end(), next.begin(), next.end());
    }
    return seen;
  }
};

/// The floors of the house, lowest first.
int floor_of(const std::string& folder) {
  const std::vector<std::string> floors = {"compiler/", "runtime/", "harness/", "tools/"};
  for (std::size_t i = 0; i < floors.size(); ++i) {
    if (folder.starts_with(floors[i])) return static_cast<int>(i);
  }
  return -1;
}

TEST_CASE("the libraries stand on floors, and none leans on one above it") {
  const auto layers = Layers::read();
  REQUIRE(layers.depends.size() > 20);
  // The upper floors see only the compiled model as data, never the compiler's front end.
  const std::set<std::string> data = {"parallax::base", "parallax::artifact"};
  std::set<std::string> placed;

  for (bool moved = true; moved;) {
    moved = false;
    for (const auto& [library, depends] : layers.depends) {
      if (placed.contains(library)) continue;
      if (!std::includes(placed.begin(), placed.end(), depends.begin(), depends.end())) continue;
      placed.insert(library);
      moved = true;
    }
  }
  for (const auto& [library, depends] : layers.depends) {
    CHECK_MESSAGE(placed.contains(library), library << " depends on itself by a detour");
    const auto floor = floor_of(layers.folders.at(library));
    REQUIRE_MESSAGE(floor >= 0, library << " lies in " << layers.folders.at(library));
    for (const auto& other : depends) {
      const auto found = layers.folders.find(other);
      REQUIRE_MESSAGE(found != layers.folders.end(), library << " depends on unknown " << other);
      const auto below = floor_of(found->second);
      CHECK_MESSAGE(below <= floor, library << " depends on " << other);
      if (floor == 1 || floor == 2) {
        CHECK_MESSAGE((below != 0 || data.contains(other)),
                      library << " depends on the front end: " << other);
      }
    }
  }
}

TEST_CASE("a file includes only what its library depends on") {
  const auto layers = Layers::read();
  const auto files = source_files();
  REQUIRE(files.size() > 50);
  for (const auto& file : files) {
    const auto folder = layers.home_of(folder_of(file));
    const auto below = layers.below(folder);
    for (const auto& include : includes_of(file)) {
      if (include.system || include.target.starts_with("tools/app/version.h")) continue;
      if (include.target.starts_with("parallax/")) continue;  // another umbrella header
      const auto target = layers.home_of(folder_of(include.target));
      if (target == folder) continue;
      const auto there = layers.libraries.find(target);
      REQUIRE_MESSAGE(there != layers.libraries.end(),
                      file << " includes " << include.target << " of no library");
      const bool fine = std::any_of(there->second.begin(), there->second.end(),
                                    [&](const auto& library) { return below.contains(library); });
      CHECK_MESSAGE(fine, file << " includes " << include.target);
    }
  }
}

TEST_CASE("each third-party library stays behind its seam") {
  struct Seam {
    std::string prefix;               // prefix of the included path
    std::vector<std::string> places;  // path prefixes that may have it
  };
  const std::vector<Seam> seams = {
      {"cadical", {"runtime/solver/cadical_solver.cc", "tools/bench/plain_cadical.cc"}},
      {"ode/", {"harness/engine/ode_"}},
      {"mujoco/",
       {"harness/engine/mujoco_", "harness/import/mjcf_reader.cc", "tools/adapters/cpp/"}},
      {"btBullet", {"harness/engine/bullet_"}},
      {"Bullet", {"harness/engine/bullet_"}},
      {"LinearMath/", {"harness/engine/bullet_"}},
      {"sdf/", {"harness/import/sdf_reader.cc"}},
      {"urdf", {"harness/import/urdf_reader.cc"}},
      {"console_bridge/", {"harness/import/urdf_reader.cc"}},
      {"assimp/", {"harness/import/mesh_reader.cc"}},
      {"libqhull", {"harness/import/mesh_reader.cc"}},
      {"yaml-cpp/", {"harness/config/"}},
      {"CLI/", {"tools/cli/command_line.cc"}},
      {"Eigen/", {"harness/", "tools/bench/"}},
  };
  for (const auto& file : source_files()) {
    for (const auto& include : includes_of(file)) {
      if (!include.system) continue;
      if (include.target.starts_with("nlohmann/")) {
        const bool fine = !file.ends_with(".h") || file == "compiler/base/json.h";
        CHECK_MESSAGE(fine, file << " shows a JSON type in a header");
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

TEST_CASE("only the maker of worlds knows which engine steps them") {
  bool made = false;
  for (const auto& file : source_files()) {
    for (const auto& include : includes_of(file)) {
      for (const std::string engine : {"harness/engine/mujoco_", "harness/engine/bullet_"}) {
        if (!include.target.starts_with(engine)) continue;
        CHECK_MESSAGE(file.starts_with(engine), file << " includes " << include.target);
      }
      if (!include.target.starts_with("harness/engine/ode_")) continue;
      made = made || file == "harness/engine/physics_world.cc";
      CHECK_MESSAGE(
          (file.starts_with("harness/engine/ode_") || file == "harness/engine/physics_world.cc"),
          file << " includes " << include.target);
    }
  }
  CHECK(made);
}

TEST_CASE("one file includes CLI11, whose header takes seconds to compile") {
  std::vector<std::string> includers;
  for (const auto& file : source_files({"compiler", "runtime", "harness", "tools", "tests"})) {
    for (const auto& include : includes_of(file)) {
      if (include.target.starts_with("CLI/")) includers.push_back(file);
    }
  }
  CHECK(includers == std::vector<std::string>{"tools/cli/command_line.cc"});
}

TEST_CASE("libraries neither print nor exit") {
  for (const auto& file : source_files()) {
    const bool is_library = !file.starts_with("tools/") || file.starts_with("tools/app/") ||
                            file.starts_with("tools/diff/");
    if (!is_library) continue;
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

TEST_CASE("seconds become ticks of a clock in one place, which saturates") {
  const std::set<std::string> allowed = {"compiler/base/clock_time.cc",
                                         "tools/suite/result_cache.cc"};  // times of files
  for (const auto& file : source_files()) {
    if (allowed.contains(file)) continue;
    std::ifstream in(fs::path(PARALLAX_SOURCE_DIR) / file);
    std::stringstream text;
    text << in.rdbuf();
    CAPTURE(file);
    CHECK(text.str().find("duration_cast<") == std::string::npos);
  }
}

}  // namespace
