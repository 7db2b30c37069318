#pragma once

#include <filesystem>
#include <string>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {

/// A copy of scenarios/two_models in the fixture's folder, as `two`.
class TwoModels : public CliFixture {
 public:
  TwoModels() {
    std::filesystem::copy(std::filesystem::path(PARALLAX_SOURCE_DIR) / "scenarios" / "two_models",
                          folder() / "two");
  }
  /// A scenario whose world is this model; `more`: further lines of it.
  std::string world(const std::string& model, const std::string& more = "") const {
    write("two/world.e", model);
    write("two/own.yaml", "include: common.yaml\nsimulator: {model: world.e}\n" + more +
                              "model: [opens.e, start.e]\n");
    return "two/own.yaml";
  }
};

}  // namespace parallax::test
