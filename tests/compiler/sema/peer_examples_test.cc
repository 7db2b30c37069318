// Domain files written for the 2005 reasoner, where they are at hand.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

TEST_CASE("every example of the 2005 reasoner is read and checked without an error") {
  const char* folder = std::getenv("PARALLAX_PEER_EXAMPLES");
  if (folder == nullptr || !fs::is_directory(folder)) {
    std::cout << "SKIPPED: PARALLAX_PEER_EXAMPLES names no folder with examples\n";
    return;
  }
  std::vector<fs::path> paths;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".e") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  CHECK(!paths.empty());
  for (const auto& path : paths) {
    CAPTURE(path);
    FrontEnd front;
    compiler::LoadOptions options;
    options.include_dirs = {fs::path(folder), fs::path(folder).parent_path()};
    const std::vector<fs::path> main = {path};
    const auto ast = compiler::load_model(main, options, front.files, front.sink);
    REQUIRE_MESSAGE(ast.has_value(), front.text());
    // A library file gets its timepoints from the file that loads it.
    const compiler::CheckOptions check{.complete_model = path.filename() != "MonkeyBananas.e"};
    const auto model = compiler::check_model(*ast, front.files, front.sink, check);
    CHECK_MESSAGE(model.has_value(), front.text());
    if (!front.text().empty()) std::cout << front.text();
    if (model) CHECK(model->axioms.size() + model->effects.size() > 0);
  }
}

}  // namespace
}  // namespace parallax::test
