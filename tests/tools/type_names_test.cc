// One definition rule across headers: a name in a namespace means one type, whichever headers are
// included.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> headers() {
  std::vector<fs::path> files;
  for (const auto* folder : {"compiler", "runtime", "harness", "tools"}) {
    for (const auto& entry :
         fs::recursive_directory_iterator(fs::path(PARALLAX_SOURCE_DIR) / folder)) {
      if (entry.path().extension() == ".h") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// The types that a header defines at the level of its namespaces, as "parallax::base::Store". The
/// layout is clang-format's: the content of a namespace is not indented, the content of a class is.
std::vector<std::string> types_of(const fs::path& header) {
  static const std::regex opening(R"(namespace ([\w:]+) \{)");
  // Neither a class of a class nor a specialisation is a new name.
  static const std::regex type(
      R"((?:template <.*> )?(?:class|struct|enum class|enum|union) (?:[A-Z]+_API )?(\w+)(?![\w<]|::).*)");
  std::vector<std::string> names;
  std::string space, line;
  std::ifstream in(header);
  while (std::getline(in, line)) {
    line.erase(std::min(line.find("  //"), line.size()));
    std::smatch found;
    if (std::regex_match(line, found, opening)) space = found[1];
    const bool only_declares = line.ends_with(";") && line.find('{') == std::string::npos;
    if (!only_declares && std::regex_match(line, found, type)) {
      names.push_back(space + "::" + found[1].str());
    }
  }
  return names;
}

TEST_CASE("no two headers define a type of the same name in one namespace") {
  std::map<std::string, fs::path> first;
  for (const auto& header : headers()) {
    for (const auto& name : types_of(header)) {
      const auto [at, fresh] = first.emplace(name, header);
      CHECK_MESSAGE(fresh, header.string(), " defines ", name, " as ", at->second.string(),
                    " does");
    }
  }
  CHECK(first.size() > 200);  // the scan sees something
}

}  // namespace
