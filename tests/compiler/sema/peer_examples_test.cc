// Domain files written for the 2005 reasoner, where they are at hand.

#include "tests/support/peer_examples.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "tests/compiler/front_end.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

TEST_CASE("every example of the 2005 reasoner is read and checked without an error") {
  const auto found = peer_examples();
  if (!found) return;
  const fs::path folder = *found / "examples";
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
    options.include_dirs = {folder, *found};
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
