#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace parallax::tools::lsp {

/// The text of a file as it is edited, or as it lies on disk; none where it cannot be read.
using TextOf = std::function<std::optional<std::string>(const std::string& path)>;

/// The files that `check` has to be asked about to look at a file with all that it reads: a
/// scenario, or one or more model files. Found by names that texts mention beside each other,
/// without compiling anything.
std::vector<std::string> roots_of(const std::string& path, const TextOf& text_of);

/// A root and every file that it mentions, directly or by others, as far as they lie beside each
/// other or below.
std::vector<std::string> files_below(const std::string& root, const TextOf& text_of);

/// The files of all roots that share a file with the roots of this one, and so on: those that a new
/// name concerns.
std::vector<std::string> family_of(const std::string& path, const TextOf& text_of);

}  // namespace parallax::tools::lsp
