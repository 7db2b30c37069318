#pragma once

#include <string>
#include <vector>

#include "compiler/artifact/symbol_table.h"
#include "runtime/trace/trace.h"

namespace parallax::runtime {

/// Atoms whose value a trace leaves open: with its HoldsAt and Happens they can be true and can be
/// false. What the trace says of them is one of several possible values.
struct OpenAtoms {
  std::vector<std::vector<compiler::FluentId>> released;  // by timepoint, ascending; may end early
  std::vector<std::string> predicates;                    // atoms of user predicates, sorted

  bool empty() const;
  /// The fluents of which ReleasedAt is open at timepoint `t`, ascending.
  const std::vector<compiler::FluentId>& released_at(std::size_t t) const;
};

/// `ReleasedAt(On(A),3)`, `P(A)`; sorted by bytes.
std::vector<std::string> printed_atoms(const OpenAtoms& open, const compiler::SymbolTable& symbols);

/// As to_jsonl of the trace alone; open atoms stand in `undetermined` and nowhere else.
std::string to_jsonl(const Trace& trace, const OpenAtoms& open);

}  // namespace parallax::runtime
