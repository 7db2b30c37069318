#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace parallax::base {

/// The name without links followed, absolute and without dots.
std::string absolute_name(const std::string& name);

/// The folder that contains all of the files, by their absolute names; empty if there are none.
std::filesystem::path common_folder(const std::map<std::string, std::string>& texts_by_name);

}  // namespace parallax::base
