#pragma once

#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "tools/cli/command.h"

namespace parallax::tools {

/// A file that `diff --markdown` writes; without a name it writes none.
struct DiffMarkdown {
  std::string file;
  std::string old_name, new_name;
  std::string text;  // of `parallax diff`
};

/// The text for a pull request: what stands without indentation becomes a paragraph, the lines
/// below it a block in which added and removed lines are coloured.
std::string diff_markdown(const DiffMarkdown& difference);

/// Refuses a file that is there and is none of an earlier call.
base::Status may_write_diff_markdown(const std::string& file, Invocation& invocation);
base::Status write_diff_markdown(const DiffMarkdown& difference, Invocation& invocation);

}  // namespace parallax::tools
