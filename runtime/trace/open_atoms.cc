#include "runtime/trace/open_atoms.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compiler/base/json.h"

namespace parallax::runtime {

bool OpenAtoms::empty() const {
  return predicates.empty() && std::all_of(released.begin(), released.end(),
                                           [](const auto& fluents) { return fluents.empty(); });
}

const std::vector<compiler::FluentId>& OpenAtoms::released_at(std::size_t t) const {
  static const std::vector<compiler::FluentId> kNone;
  return t < released.size() ? released[t] : kNone;
}

std::vector<std::string> printed_atoms(const OpenAtoms& open,
                                       const compiler::SymbolTable& symbols) {
  auto names = open.predicates;
  for (std::size_t t = 0; t < open.released.size(); ++t) {
    for (const auto fluent : open.released[t]) {
      names.push_back("ReleasedAt(" + symbols.name(fluent) + ',' + std::to_string(t) + ')');
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string to_jsonl(const Trace& trace, const OpenAtoms& open) {
  if (open.empty()) return to_jsonl(trace);
  auto known = trace;
  std::erase_if(known.predicates,
                [&](const std::string& name) { return contains(open.predicates, name); });
  for (std::size_t t = 0; t < known.points.size(); ++t) {
    std::erase_if(known.points[t].released,
                  [&](compiler::FluentId fluent) { return contains(open.released_at(t), fluent); });
  }
  auto line = to_jsonl(known);
  line.pop_back();
  // Atoms of predicates alone need no symbols.
  static const compiler::SymbolTable kNoSymbols;
  const auto& symbols = trace.symbols == nullptr ? kNoSymbols : *trace.symbols;
  return line +
         ",\"undetermined\":" + base::json_text(nlohmann::json(printed_atoms(open, symbols))) + '}';
}

}  // namespace parallax::runtime
