#pragma once

#include <string_view>

namespace parallax::tools {

/// The files of tools/page/assets, which the build embeds.
extern const std::string_view kPageStyle, kPageScript, kDotsScript;

}  // namespace parallax::tools
