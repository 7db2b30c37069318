#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace parallax::harness {

/// The place of `name`, a relative way that may have `..` in it, from `folder` on, and the one of
/// `roots` that it lies below. None: it leads out of all of them, or a part of it is not plain
/// (plain_path.h). Nothing is opened; links are not looked for.
std::optional<std::pair<std::filesystem::path, std::filesystem::path>> way_within(
    const std::filesystem::path& folder, const std::string& name,
    const std::vector<std::filesystem::path>& roots);

}  // namespace parallax::harness
