#pragma once

#include <string>

namespace parallax::tools {

// What programs found, read from the end of their output; empty if it is not there.

/// The number in `Models       : 3488` of clingo's statistics.
std::string clingo_answer(const std::string& tail);

/// The number of traces in the closing object of a list in jsonl.
std::string jsonl_answer(const std::string& tail);

/// The number that is the whole of the first line.
std::string count_answer(const std::string& tail);

}  // namespace parallax::tools
