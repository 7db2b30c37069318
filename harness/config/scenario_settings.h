#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/base/word_table.h"

namespace parallax::harness {

/// The effects that a setting of a scenario can have, in the order of the pipeline.
enum class Effect : std::uint8_t { kTraces, kStarts, kPhysics, kJudgement, kClaim, kWords };
inline constexpr auto kEffectWords =
    base::word_table<Effect>("traces", "starts", "physics", "judgement", "claim", "words only");
constexpr std::string_view to_string(Effect effect) { return kEffectWords.of(effect); }

/// One value of a scenario, by the way to it through the keys.
struct Setting {
  std::vector<std::string> path;        // "world", "bodies", "box", "shapes", "[0]", "size_m"
  std::string value;                    // the same text for all writings of one value; one line
  std::optional<std::string> fallback;  // what the reader takes where the key is left out
  bool given = true;                    // false: `value` is the fallback
  std::string file;                     // where it stands, as messages print it; empty: nowhere
  std::uint32_t line = 0;

  bool is_default() const { return fallback && *fallback == value; }
};

/// "world.bodies.box.shapes[0].size_m"
std::string path_text(const std::vector<std::string>& path);

/// Effects of a setting at this path; at least one for every key of a scenario.
std::vector<Effect> effects_of(const std::vector<std::string>& path);

/// The keys that the reader admits at a map that it read.
struct KnownKeys {
  std::vector<std::string> path;
  std::vector<std::string> keys;
};

/// All values of a scenario, with includes laid together and imported worlds and meshes taken over,
/// but model, plan, binding table and constraints, which are compared as texts of their own. What
/// is said by layout, comments, order of keys, includes or an abbreviation says nothing here.
struct ScenarioSettings {
  std::vector<Setting> all;  // sorted by path, no path twice
  std::vector<KnownKeys> known;
};

/// SHA-256 over the settings that can have this effect, 16 digits, without those that say what is
/// the default and those below the keys `without`.
std::string hash_of_settings(const ScenarioSettings& settings, Effect effect,
                             const std::vector<std::string>& without = {});

/// Puts one more value among them.
void insert(ScenarioSettings& settings, Setting setting);

}  // namespace parallax::harness
