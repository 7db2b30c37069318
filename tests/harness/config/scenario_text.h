#pragma once

#include <doctest/doctest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "compiler/base/diagnostic_printer.h"
#include "harness/config/scenario.h"

namespace parallax::harness::test {

inline constexpr const char* kWorld = R"(bodies:
  base: {size_m: [0.5, 0.4, 0.3], mass_kg: 30, material: steel, position_m: [0.5, -0.6, 0.2],
         settable: [x]}
  arm: {size_m: [0.06, 0.6, 0.06], mass_kg: 3, material: steel, position_m: [0.5, -0.3, 0.5]}
  palm: {size_m: [0.06, 0.16, 0.04], mass_kg: 0.6, material: steel, position_m: [0.5, 0, 0.305]}
  near: {size_m: [0.02, 0.01, 0.05], mass_kg: 0.1, material: pad, position_m: [0.5, -0.05, 0.24]}
  far: {size_m: [0.02, 0.01, 0.05], mass_kg: 0.1, material: pad, position_m: [0.5, 0.05, 0.24]}
  box: {size_m: [0.07, 0.07, 0.07], mass_kg: 0.3, material: box, position_m: [1.5, 0, 0.035],
        settable: [x, y, yaw]}
joints:
  drive: {parent: world, child: base, axis: x, range_m: [-1.0, 2.5], max_force_n: 400}
  reach: {parent: base, child: arm, axis: [1, 0, 0], range_m: [-0.6, 0.6], max_force_n: 200}
  lift: {parent: arm, child: palm, axis: z, range_m: [-0.21, 0.05], max_force_n: 200}
  weld: {type: fixed, parent: palm, child: near}
  finger: {parent: palm, child: far, axis: y, range_m: [-0.085, 0], max_force_n: 20}
robot: {base_joint: drive, base_body: base, reach_joint: reach, lift_joint: lift,
        finger_joint: finger, near_pad_body: near, far_pad_body: far}
friction: {default: 0.5, box-pad: 0.6}
)";

inline constexpr const char* kScenario = R"yaml(model: [domain.e, start.e]
plan: fetch.lisp
bind: robot.bind
constraints:
  - "HoldsAt(BoxIn(r1),time)"
horizon: 6
world: {include: world.yaml}
regions:
  cells: {r1: {x: [0, 1]}, r2: {x: [1, 2]}}
mapping:
  RobotIn(region): {inside: region, body: robot}
  BoxIn(region): {inside: region, body: box, unless: box.held}
  Holding(): {flag: box.held}
actions:
  Go(region): {controller: going, max_speed_m_s: 0.6, time_limit_s: 30}
  PickUp(): {controller: picking-up, object: box}
  Place(region): {controller: placing, object: box, target: {x: 0.5}}
sampling: {inset_m: 0.001, variables: {box.y: 0.0, box.yaw: [-0.1, 0.1]}}
)yaml";

/// A folder with the files that the scenario names, and the result of loading one of them.
class Workspace {
 public:
  Workspace() {
    auto pattern = (std::filesystem::temp_directory_path() / "parallax-XXXXXX").string();
    REQUIRE(::mkdtemp(pattern.data()) != nullptr);
    folder_ = pattern;
    for (const auto* name : {"domain.e", "start.e", "fetch.lisp", "robot.bind"}) write(name, "");
    write("world.yaml", kWorld);
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;
  ~Workspace() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  const std::filesystem::path& folder() const { return folder_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  /// Loads the text as scenario.yaml.
  std::optional<Scenario> load(const std::string& text) {
    sink = base::DiagnosticSink();
    auto result = load_scenario(write("scenario.yaml", text), files, sink);
    if (!result) return std::nullopt;
    return std::move(*result);
  }

  /// "E5102 at 3:1: text" for each diagnostic, with "fix: ..." after it.
  std::vector<std::string> reports() const {
    std::vector<std::string> out;
    for (const auto& d : sink.sorted()) {
      std::string line(base::info(d.code).id);
      if (d.range) {
        const auto at = files[d.range->file].position(d.range->begin);
        line += " at " + std::to_string(at.line) + ":" + std::to_string(at.column);
      }
      line += ": " + d.message;
      if (!d.fix.empty()) line += " fix: " + d.fix;
      out.push_back(line);
    }
    return out;
  }

  base::SourceFiles files;
  base::DiagnosticSink sink;

 private:
  std::filesystem::path folder_;
};

/// The text with its first `from` replaced, which must be there.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

}  // namespace parallax::harness::test
