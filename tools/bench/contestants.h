#pragma once

#include <string>
#include <vector>

#include "tools/bench/measure.h"

namespace parallax::tools {

/// `parallax ARGUMENTS...`
Contestant parallax_with(std::vector<std::string> arguments);
/// `parallax traces FILE --count`; the answer is the number of traces.
Contestant parallax_counts(const std::string& file);
/// `parallax traces FILE --limit 0 --format jsonl`; the answer is the number of traces.
Contestant parallax_lists(const std::string& file);

/// `clingo FILE 0 -q`: counts the answer sets. The exported programs have one for each trace.
Contestant clingo_counts(const std::string& file);
/// `clingo FILE 0`: prints them.
Contestant clingo_lists(const std::string& file);
/// `clingo --mode=gringo FILE`: grounds and stops.
Contestant clingo_grounds(const std::string& file);

/// The number after "Models       :" in the end of clingo's output; empty if there is none.
std::string clingo_answer(const std::string& tail);
/// The number in the closing object of a jsonl list; empty if there is none.
std::string jsonl_answer(const std::string& tail);

}  // namespace parallax::tools
