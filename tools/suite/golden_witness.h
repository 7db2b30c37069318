#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace parallax::tools {

/// A trace in a list as `parallax traces` prints it.
struct ListedTrace {
  std::string_view number;
  std::string_view text;  // its lines below the number
};

/// Difference of two lists of traces, whatever the numbers: of each side the trace with the fewest
/// lines that the other one lacks, the first of those. Views of the texts.
struct ListDifference {
  std::optional<ListedTrace> lost, gained;
};
ListDifference list_difference(std::string_view expected, std::string_view found);

/// The trace as a line of `parallax traces --format jsonl`; empty if it is written in another way.
std::string jsonl_of(const ListedTrace& trace);

/// The first place and reason why a trace is not one of the model, from the document of `parallax
/// traces --replay --json`; empty if it is one, or that is not known.
std::string refusal_of(std::string_view replay_document);

}  // namespace parallax::tools
