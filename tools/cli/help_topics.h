#pragma once

#include <span>
#include <string_view>

namespace parallax::tools {

/// Text about all commands together: `parallax help TOPIC`, and sections of the manual.
struct HelpTopic {
  std::string_view name;   // as it is asked for
  std::string_view title;  // in a list of them
  std::string_view text;   // lines that begin with blanks stand as they are
};

std::span<const HelpTopic> help_topics();

}  // namespace parallax::tools
