#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/config/scenario_settings.h"

namespace parallax::tools {

/// A value that differs between two scenarios, or all values below a key that only one has.
struct SettingChange {
  std::vector<std::string> path;
  std::string before, after;  // one line; where a side has nothing, empty
  /// The side has no such key; the value shown is the default.
  bool before_is_default = false, after_is_default = false;
  std::string old_file, new_file;  // where it stands; empty: nowhere
  std::uint32_t old_line = 0, new_line = 0;
  std::vector<harness::Effect> effects;
};

/// The changes in the order of the paths. A missing key is compared by its default; keys that only
/// one side has are one change for the highest of them.
std::vector<SettingChange> compare_settings(const harness::ScenarioSettings& before,
                                            const harness::ScenarioSettings& after);

/// "world.bodies.box.mass_kg 0.3 -> 3"
std::string change_text(const SettingChange& change);

/// "physics: 1 changed" and a line for each, by what they can change; with `stat` the first lines
/// alone. Empty without changes.
std::string settings_text(const std::vector<SettingChange>& changes, bool stat);

/// [{"path", "old", "new", "changes": ["physics"], "old_place": {"file", "line"}, "new_place"}]
std::string settings_json(const std::vector<SettingChange>& changes);

}  // namespace parallax::tools
