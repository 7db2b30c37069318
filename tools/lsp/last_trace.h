#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace parallax::tools::lsp {

/// Markdown about when a fluent holds in the last trace of the newest run of one of the scenarios,
/// among the run folders beside a scenario and in folders `out` there and up to three levels above;
/// empty where there is none that can be read.
std::string last_values(std::string_view fluent, const std::vector<std::string>& scenarios);

}  // namespace parallax::tools::lsp
