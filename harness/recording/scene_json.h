#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "harness/recording/recorded_scene.h"

namespace parallax::harness {

/// One JSON object with the members `bodies`, `grippers`, `arms` and `camera`, as
/// docs/reference/formats.md has them: in the head of a recording, and in what a simulator says of
/// itself.
std::string scene_text(const RecordedScene& scene);

/// Other members are ignored. None, and `why` says what is wrong: a scene has at most 10,000
/// bodies, 100,000 shapes and 64 grippers, no two bodies of one name, and nothing that is not
/// finite.
std::optional<RecordedScene> scene_from_text(std::string_view text, std::string& why);

}  // namespace parallax::harness
