#pragma once

#include <filesystem>
#include <string>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {

/// A copy of the kitchen's scenario files in the fixture's folder, to be changed.
class KitchenCopy : public CliFixture {
 public:
  KitchenCopy() {
    std::filesystem::copy(std::filesystem::path(PARALLAX_SOURCE_DIR) / "scenarios" / "kitchen",
                          folder() / "kitchen");
  }
  /// Lays something over the world of all plans.
  void lay_over(const std::string& world) const {
    replace("kitchen/common.yaml", "  include: world.yaml", "  include: world.yaml\n  " + world);
  }
};

}  // namespace parallax::test
