#pragma once

#include <string_view>

namespace parallax::tools {

/// The files of tools/page/assets, which the build embeds.
extern const std::string_view kPageStyle, kPageScript, kDotsScript, kReplayScript;
/// three.js, with its licence in front.
extern const std::string_view kThreeScript;

}  // namespace parallax::tools
