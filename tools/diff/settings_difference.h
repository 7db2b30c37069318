#pragma once

#include <optional>
#include <string>
#include <vector>

#include "harness/config/scenario_settings.h"

namespace parallax::tools {

/// A value that two scenarios do not have in common, or all values below a key that one alone has.
struct SettingChange {
  std::vector<std::string> path;
  std::string before, after;  // one line; where a side has nothing, empty
  /// The side says nothing, and the value shown is what is taken then.
  bool before_is_default = false, after_is_default = false;
  std::string old_file, new_file;  // where it stands; empty: nowhere
  std::uint32_t old_line = 0, new_line = 0;
  std::vector<harness::Effect> effects;
};

/// The changes in the order of the paths. A key that is left out is compared as its default; what
/// a side alone has is one change for the highest key that the other has not.
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
