#include "runtime/trace/vocabulary.h"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/base/hash.h"

namespace parallax::runtime {
namespace {

/// Instances of one symbol stand together in declaration order, but nothing is taken for granted.
void add(std::vector<SymbolInstances>& symbols, const std::string& atom, std::size_t id) {
  const auto symbol = atom.substr(0, atom.find('('));
  if (symbols.empty() || symbols.back().symbol != symbol) {
    const auto known = std::find_if(symbols.begin(), symbols.end(),
                                    [&](const auto& one) { return one.symbol == symbol; });
    if (known != symbols.end()) {
      known->atoms.push_back(atom);
      known->ids.push_back(static_cast<std::uint32_t>(id));
      return;
    }
    symbols.push_back({symbol, {}, {}});
  }
  symbols.back().atoms.push_back(atom);
  symbols.back().ids.push_back(static_cast<std::uint32_t>(id));
}

}  // namespace

Vocabulary vocabulary_of(const compiler::CompiledModel& model) {
  Vocabulary out;
  for (std::size_t f = 0; f < model.fluents.size(); ++f) {
    add(out.fluents, model.fluents[f].name, f);
    if (model.release_slots[f]) add(out.releasable, model.fluents[f].name, f);
  }
  for (std::size_t e = 0; e < model.events.size(); ++e) add(out.events, model.events[e].name, e);
  std::vector<std::string> predicates;
  for (const auto& atom : model.fixed) {
    if (atom.kind == compiler::AtomKind::kPredicate) predicates.push_back(atom.name);
  }
  std::sort(predicates.begin(), predicates.end());
  for (std::size_t p = 0; p < predicates.size(); ++p) add(out.predicates, predicates[p], p);
  return out;
}

std::string model_hash(const compiler::CompiledModel& model) {
  std::string bytes;
  for (const auto& source : model.sources) bytes += fmt::format("{:016x}\n", source.hash);
  for (const auto& [name, value] : model.options) bytes += fmt::format("{}={}\n", name, value);
  return fmt::format("{:016x}", base::fnv1a64(bytes));
}

}  // namespace parallax::runtime
