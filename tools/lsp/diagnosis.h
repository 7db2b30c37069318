#pragma once

#include <atomic>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compiler/base/open_texts.h"

namespace parallax::tools::lsp {

/// One message about a file as an editor shows it; offsets are bytes of the text that was checked.
struct EditorMessage {
  std::size_t begin = 0, end = 0;
  bool is_error = true;
  std::string code, text;
  std::string fix;  // what would mend it, in a sentence
};

/// A change of a text that does what the sentence of a fix says.
struct EditorFix {
  std::size_t begin = 0, end = 0;
  std::string text;
};

/// Messages by file, as `parallax check ROOT` reports them on these texts; none if `stop` was
/// raised meanwhile.
std::optional<std::map<std::string, std::vector<EditorMessage>>> checked(
    const std::string& root, const base::OpenTexts& texts, std::atomic<bool>& stop);

/// The change that a fix describes ("replace `a` with `b`", "add `.` after `b`", "remove the
/// period"), where it can be told from the text; none for advice that somebody has to think about.
std::optional<EditorFix> fix_of(const EditorMessage& message, const std::string& text);

}  // namespace parallax::tools::lsp
