#include "runtime/trace/vocabulary.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/hash.h"

namespace parallax::runtime {
namespace {

/// Instances of one symbol stand together in declaration order, but nothing is taken for granted.
void add(std::vector<SymbolInstances>& symbols, const std::string& atom) {
  const auto symbol = atom.substr(0, atom.find('('));
  if (symbols.empty() || symbols.back().symbol != symbol) {
    const auto known = std::find_if(symbols.begin(), symbols.end(),
                                    [&](const auto& one) { return one.symbol == symbol; });
    if (known != symbols.end()) {
      known->atoms.push_back(atom);
      return;
    }
    symbols.push_back({symbol, {}});
  }
  symbols.back().atoms.push_back(atom);
}

}  // namespace

Vocabulary vocabulary_of(const compiler::CompiledModel& model) {
  Vocabulary out;
  for (std::size_t f = 0; f < model.fluents.size(); ++f) {
    add(out.fluents, model.fluents[f].name);
    if (model.release_slots[f]) add(out.releasable, model.fluents[f].name);
  }
  for (const auto& event : model.events) add(out.events, event.name);
  std::vector<std::string> predicates;
  for (const auto& atom : model.fixed) {
    if (atom.kind == compiler::AtomKind::kPredicate) predicates.push_back(atom.name);
  }
  std::sort(predicates.begin(), predicates.end());
  for (const auto& atom : predicates) add(out.predicates, atom);
  return out;
}

std::string model_hash(const compiler::CompiledModel& model) {
  std::string bytes;
  for (const auto& source : model.sources) bytes += fmt::format("{:016x}\n", source.hash);
  for (const auto& [name, value] : model.options) bytes += fmt::format("{}={}\n", name, value);
  return fmt::format("{:016x}", base::fnv1a64(bytes));
}

}  // namespace parallax::runtime
