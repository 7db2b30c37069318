#pragma once

#include <iostream>
#include <optional>
#include <string>

#include "harness/import/import.h"
#include "tests/harness/config/imported_world.h"

namespace parallax::harness::test {

inline const std::string kMjcf = "  mjcf: world.xml\n  models: models\n" + kCup;

inline bool skips_mjcf() {
  if (reads_mjcf()) return false;
  std::cout << "SKIPPED: this build reads no MJCF\n";
  return true;
}

/// A world with this on its third line.
inline std::string bodies_with(const std::string& inside) {
  return "<mujoco>\n<worldbody>\n" + inside + "\n</worldbody>\n</mujoco>";
}

/// An MJCF file with these sections from its second line on.
inline std::string file_with(const std::string& sections) {
  return "<mujoco>\n" + sections + "\n</mujoco>";
}

inline std::string box_at(double x, const std::string& name, const std::string& more = {}) {
  return "<body name='" + name + "' pos='" + std::to_string(x) +
         " 0 0.1'><freejoint/><geom type='box' size='0.1 0.1 0.1' mass='1'" + more + "/></body>";
}

/// A tetrahedron in OBJ.
inline constexpr const char* kTetrahedron =
    "v 0 0 0\nv 0.2 0 0\nv 0 0.2 0\nv 0 0 0.2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

inline std::optional<Scenario> taken_over(Workspace& workspace, const std::string& text) {
  std::filesystem::create_directories(workspace.folder() / "models");
  workspace.write("world.xml", text);
  return workspace.load(scenario_with(kMjcf));
}

struct BadText {
  std::string text, report;  // how the report begins
};

/// The first report, which must be the only error of a file that is refused.
inline std::string refusal_of(Workspace& workspace, const std::string& text) {
  CHECK_FALSE(taken_over(workspace, text).has_value());
  CHECK(workspace.sink.exit_code() == 3);
  for (const std::string& one : workspace.reports()) {
    if (one.front() == 'E') return one;
  }
  return {};
}

}  // namespace parallax::harness::test
