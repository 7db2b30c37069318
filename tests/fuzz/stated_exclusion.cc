#include "tests/fuzz/stated_exclusion.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

namespace parallax::test {
namespace {

using compiler::SymbolKind;

/// An object to be chosen: the sort and the place among the arguments of this sort; place 0 is the
/// only argument.
using Slot = std::pair<std::string, std::size_t>;

class Definition {
 public:
  Definition(const StatedExclusion& exclusion, const compiler::TypedModel& model,
             const compiler::Valuation& trace)
      : exclusion_(exclusion), model_(model), trace_(trace) {}

  bool holds() {
    for (const auto name : exclusion_.names) {
      if (model_.symbols[name].kind == SymbolKind::kPredicate) return true;
    }
    for (std::size_t t = 0; t < trace_.holds.size(); ++t) {
      const auto& names = exclusion_.names;
      for (std::size_t i = 0; i < names.size(); ++i) {
        for (std::size_t k = i + 1; k < names.size(); ++k) {
          if (!every_choice({names[i], names[k]}, false, t)) return false;
        }
      }
      if (exclusion_.is_xor && !every_choice(names, true, t)) return false;
    }
    return true;
  }

 private:
  /// The slot of each argument of a name.
  std::vector<Slot> slots(compiler::SymbolId name, bool only_apart) const {
    const auto& sorts = model_.symbols[name].arguments;
    std::vector<Slot> found;
    for (std::size_t i = 0; i < sorts.size(); ++i) {
      const auto end = sorts.begin() + static_cast<std::ptrdiff_t>(i);
      const auto place = static_cast<std::size_t>(std::count(sorts.begin(), end, sorts[i])) + 1;
      const bool only = std::count(sorts.begin(), sorts.end(), sorts[i]) == 1;
      found.emplace_back(model_.sorts[sorts[i]].name, only && only_apart ? 0 : place);
    }
    return found;
  }

  bool every_choice(const std::vector<compiler::SymbolId>& names, bool some, std::size_t t) {
    std::vector<Slot> open;
    for (const auto name : names) {
      // Events do not happen at the last timepoint, so no exclusion applies to them there.
      const bool event = model_.symbols[name].kind == SymbolKind::kEvent;
      if (event && t + 1 == trace_.holds.size()) return true;
      for (const auto& slot : slots(name, some)) {
        if (std::find(open.begin(), open.end(), slot) == open.end()) open.push_back(slot);
      }
    }
    std::map<Slot, std::string> chosen;
    const std::function<bool(std::size_t)> visit = [&](std::size_t next) {
      if (next == open.size()) {
        const auto count = std::count_if(names.begin(), names.end(),
                                         [&](auto name) { return is_true(name, chosen, some, t); });
        return some ? count >= 1 : count <= 1;
      }
      for (const auto& value : elements(*model_.find_sort(open[next].first))) {
        chosen[open[next]] = value;
        if (!visit(next + 1)) return false;
      }
      return true;
    };
    return visit(0);
  }

  bool is_true(compiler::SymbolId name, const std::map<Slot, std::string>& chosen, bool only_apart,
               std::size_t t) const {
    std::string atom = model_.symbols[name].name + "(";
    for (const auto& slot : slots(name, only_apart)) {
      if (atom.back() != '(') atom += ',';
      atom += chosen.at(slot);
    }
    atom += ")";
    const bool fluent = model_.symbols[name].kind == SymbolKind::kFluent;
    return (fluent ? trace_.holds : trace_.happens)[t].contains(atom);
  }

  /// The printed elements of a sort, each once.
  const std::vector<std::string>& elements(compiler::SortId sort) {
    const auto [found, is_new] = elements_.try_emplace(sort.index());
    if (!is_new) return found->second;
    std::vector<std::string> all;
    for (std::size_t i = 0; i < model_.sorts.size(); ++i) {
      const auto below = model_.sorts.id_at(i);
      if (!model_.is_subsort(below, sort)) continue;
      for (const auto object : model_.sorts[below].constants) {
        all.push_back(model_.objects[object].name);
      }
      for (const auto& range : model_.sorts[below].ranges) {
        for (auto n = range.lower; n <= range.upper; ++n) all.push_back(std::to_string(n));
      }
      for (const auto& symbol : model_.symbols) {
        if (symbol.kind == SymbolKind::kFunction || symbol.result != below) continue;
        for (auto& term : terms(symbol)) all.push_back(std::move(term));
      }
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return elements_[sort.index()] = std::move(all);
  }
  std::vector<std::string> terms(const compiler::Symbol& symbol) {
    std::vector<std::string> made = {symbol.name + "("};
    for (std::size_t i = 0; i < symbol.arguments.size(); ++i) {
      const auto values = elements(symbol.arguments[i]);
      std::vector<std::string> longer;
      for (const auto& begun : made) {
        for (const auto& value : values) longer.push_back(begun + (i > 0 ? "," : "") + value);
      }
      made = std::move(longer);
    }
    for (auto& term : made) term += ")";
    return made;
  }

  const StatedExclusion& exclusion_;
  const compiler::TypedModel& model_;
  const compiler::Valuation& trace_;
  std::map<std::uint32_t, std::vector<std::string>> elements_;
};

}  // namespace

std::vector<StatedExclusion> stated_exclusions(const compiler::ModelAst& ast,
                                               const compiler::TypedModel& model) {
  std::vector<StatedExclusion> all;
  for (const auto& place : ast.order) {
    const auto& statement = ast.statement(place);
    const bool is_xor = statement.kind == compiler::StatementKind::kXor;
    if (!is_xor && statement.kind != compiler::StatementKind::kMutex) continue;
    const auto& text = ast.ast(place);
    StatedExclusion stated{is_xor, {}, text.source(statement.source)};
    for (std::uint32_t i = 0; i < statement.item_count; ++i) {
      const auto symbol = model.find_symbol(text.text(text.items(statement)[i].name));
      if (!symbol) continue;
      const auto same = [&](compiler::SymbolId one) { return one == *symbol; };
      if (std::none_of(stated.names.begin(), stated.names.end(), same)) {
        stated.names.push_back(*symbol);
      }
    }
    all.push_back(std::move(stated));
  }
  return all;
}

bool satisfies(const StatedExclusion& exclusion, const compiler::TypedModel& model,
               const compiler::Valuation& trace) {
  return Definition(exclusion, model, trace).holds();
}

}  // namespace parallax::test
