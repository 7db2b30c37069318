#pragma once

#include <string>
#include <string_view>

namespace parallax::base {

/// Text for XML 1.0, in elements and attributes alike: markup and line ends other than plain ones
/// as entities, characters that XML cannot hold (controls, U+FFFE, U+FFFF) and bytes that are no
/// UTF-8 as `\x1B`, other characters that steer a display (shown_text.h) as `\u202E`.
std::string xml_escaped(std::string_view text);

}  // namespace parallax::base
