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

/// The programs that clingo is given for a family's model.
enum class Encoding {
  kExported,  // what `parallax compile --emit=lp` makes of it
  kTuned,     // what a clingo user would write by hand
};

/// `clingo FILE 0 -q`: counts the answer sets. The programs have one for each trace.
Contestant clingo_counts(const std::string& file, Encoding encoding);
/// `clingo FILE 0`: prints them.
Contestant clingo_lists(const std::string& file, Encoding encoding);
/// `clingo FILE COSTS --configuration=CONFIGURATION`: the optimum of a program written by hand.
Contestant clingo_minimizes(const std::string& file, const std::string& costs,
                            const std::string& configuration);
/// `clingo FILE --configuration=CONFIGURATION`: one answer set; the answer is whether there is one.
Contestant clingo_finds(const std::string& file, const std::string& configuration);
/// `clingo FILE 0 --enum-mode=MODE --configuration=CONFIGURATION`: the atoms of all answer sets
/// (cautious) or of any (brave) of an exported program; the answer is how many.
Contestant clingo_consequences(const std::string& file, const std::string& mode,
                               const std::string& configuration);
/// `clingo --mode=gringo FILE`: grounds and stops.
Contestant clingo_grounds(const std::string& file, Encoding encoding);

}  // namespace parallax::tools
