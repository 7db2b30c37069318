#pragma once

#include <map>
#include <string>

namespace parallax::tools {

/// A folder of plans in the style of CRAM's packages, for the kitchen and its binding table: a
/// system definition, a package, a file of macros and steps, and a file of helper functions,
/// handlers and retries for each of `stations` stations, which are served one after the other.
/// The text of each file by its name; about 95 lines a station.
std::map<std::string, std::string> plan_folder(int stations);

}  // namespace parallax::tools
