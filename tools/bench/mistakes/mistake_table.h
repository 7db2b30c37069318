#pragma once

#include <string>
#include <vector>

#include "tools/bench/mistakes/mistake_trial.h"

namespace parallax::tools {

/// Counts over some outcomes.
struct MistakeCounts {
  std::string name;
  int all = 0, invisible = 0, permissive = 0, shown = 0;
  int first = 0, three = 0;    // right on the plan that showed the mistake
  int second = 0, random = 0;  // of `three`: right on the other plan, and on random sequences
  int silent = 0;              // a wrong first proposal without any mark
  std::vector<double> list_s;  // sorted
};

/// One of each world, of the held-out worlds and of the others, of each kind, of the axioms
/// of triggered events, and of all single mistakes; doubles are a kind of their own and count
/// nowhere else.
std::vector<MistakeCounts> count_mistakes(const std::vector<MistakeOutcome>& outcomes);

/// One row of the table in words.
std::string to_words(const MistakeCounts& counts);
/// A table in Markdown.
std::string to_markdown(const std::vector<MistakeCounts>& counts);
/// The same as one JSON document, with shares.
std::string to_json(const std::vector<MistakeCounts>& counts);

}  // namespace parallax::tools
