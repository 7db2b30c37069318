// Robots and worlds of others, which are not ours to ship: how many are taken over as they are.
//
// PARALLAX_ROBOT_FILES names a folder with a `list.txt`. Its lines are `urdf PATH`, `mjcf PATH` or
// `sdf PATH`, below the folder, and `least KIND N`, how many of them have to be taken over at
// least. Each file is read as a world of its own, robots and models 5 m above the floor.

#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "tests/harness/config/imported_world.h"

namespace parallax::harness::test {
namespace {

namespace fs = std::filesystem;

struct PublicFile {
  std::string kind, path;
};

std::string text_of_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

/// The report of the first error; empty: it is taken over.
std::string refusal(const PublicFile& file, const fs::path& root) {
  const auto path = fs::canonical(root / file.path);
  const bool is_world =
      file.kind == "mjcf" ||
      (file.kind == "sdf" && text_of_file(path).find("<world") != std::string::npos);
  std::string world = file.kind + ": {file: " + path.string();
  if (!is_world) world += ", at_m: [0, 0, 5]";
  world += "}\nmodels: [" + root.string();
  // The folders above it, in which packages and models lie.
  for (auto at = path.parent_path(); at != root && at.has_relative_path(); at = at.parent_path()) {
    world += ", " + at.string();
  }
  Workspace workspace;
  workspace.write("world.yaml", world + "]\n");
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto loaded = load_world(workspace.folder() / "world.yaml", files, sink, true);
  if (loaded) return {};
  for (const auto& one : sink.sorted()) {
    if (base::info(one.code).severity == base::Severity::kError) return one.message;
  }
  return "refused without a word";
}

TEST_CASE("public robots and worlds are taken over as they are") {
  const char* named = std::getenv("PARALLAX_ROBOT_FILES");
  if (named == nullptr || !fs::exists(fs::path(named) / "list.txt")) {
    std::cout << "SKIPPED: no files of others (PARALLAX_ROBOT_FILES)\n";
    return;
  }
  const fs::path root = fs::canonical(named);
  std::vector<PublicFile> all;
  std::map<std::string, int> least, taken, count;
  std::ifstream list(root / "list.txt");
  for (std::string line; std::getline(list, line);) {
    std::istringstream words(line);
    std::string first, second;
    words >> first >> second;
    if (first == "least") {
      words >> least[second];
    } else if (!second.empty()) {
      all.push_back({first, second});
    }
  }
  REQUIRE_FALSE(all.empty());
  for (const auto& file : all) {
    ++count[file.kind];
    const auto why = refusal(file, root);
    if (why.empty()) {
      ++taken[file.kind];
    } else {
      std::cout << file.path << ": " << why << "\n";
    }
  }
  for (const auto& [kind, files] : count) {
    std::cout << kind << ": " << taken[kind] << " of " << files << "\n";
    CAPTURE(kind);
    CHECK(taken[kind] >= least[kind]);
  }
}

}  // namespace
}  // namespace parallax::harness::test
