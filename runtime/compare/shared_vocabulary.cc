#include "runtime/compare/shared_vocabulary.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace parallax::runtime {
namespace {

using compiler::GroundName;

/// The names of one kind that both lists have, with their slots, in the order of the first.
struct SharedName {
  std::uint32_t name = 0;
  std::optional<std::uint32_t> first, second;
};

class NameMatcher {
 public:
  explicit NameMatcher(SharedVocabulary& out) : out_(out) {}

  std::vector<SharedName> match(const std::vector<GroundName>& first,
                                const std::vector<GroundName>& second) {
    std::map<std::string_view, const GroundName*> others;
    for (const auto& ground : second) others.emplace(ground.name, &ground);
    std::vector<SharedName> shared;
    for (const auto& ground : first) {
      const auto found = others.find(ground.name);
      if (found == others.end()) {
        out_.only_first.push_back(ground.name);
        continue;
      }
      shared.push_back(
          {static_cast<std::uint32_t>(out_.names.size()), ground.slot, found->second->slot});
      out_.names.push_back(ground.name);
      others.erase(found);
    }
    for (const auto& [name, ground] : others) out_.only_second.emplace_back(name);
    return shared;
  }

 private:
  SharedVocabulary& out_;
};

}  // namespace

SharedVocabulary shared_vocabulary(const CompiledModel& first, const CompiledModel& second,
                                   Timepoint n) {
  SharedVocabulary out;
  NameMatcher matcher(out);
  const auto fluents = matcher.match(first.fluents, second.fluents);
  const auto events = matcher.match(first.events, second.events);
  out.fluents = fluents.size();
  out.events = events.size();
  std::sort(out.only_first.begin(), out.only_first.end());
  std::sort(out.only_second.begin(), out.only_second.end());
  const auto add = [&](AtomKind kind, const std::vector<SharedName>& names, Timepoint t) {
    for (const auto& name : names) {
      if (!name.first && !name.second) continue;
      SharedAtom atom{kind, name.name, t, std::nullopt, std::nullopt};
      if (name.first) atom.first = Literal::positive(first.variable(*name.first, t));
      if (name.second) atom.second = Literal::positive(second.variable(*name.second, t));
      out.shared.push_back(atom);
    }
  };
  for (Timepoint t = 0; t <= n; ++t) {
    add(AtomKind::kHoldsAt, fluents, t);
    if (t < n) add(AtomKind::kHappens, events, t);
  }
  return out;
}

SharedVocabulary exchanged(const SharedVocabulary& vocabulary) {
  auto out = vocabulary;
  for (auto& atom : out.shared) std::swap(atom.first, atom.second);
  std::swap(out.only_first, out.only_second);
  return out;
}

CompiledModel truncated(const CompiledModel& model, Timepoint n) {
  PARALLAX_REQUIRE(n <= model.horizon, "a model is not made longer");
  CompiledModel out = model;
  if (n == model.horizon) return out;
  out.horizon = n;
  out.clauses = {};
  out.clause_timepoints.clear();
  out.clause_origins.clear();
  out.clause_is_definition.clear();
  out.sections.clear();
  for (std::size_t i = 0; i < model.clauses.size(); ++i) {
    if (model.clause_timepoints[i] > n) continue;
    out.clauses.add(model.clauses[i]);
    out.clause_timepoints.push_back(model.clause_timepoints[i]);
    out.clause_origins.push_back(model.clause_origins[i]);
    out.clause_is_definition.push_back(model.clause_is_definition[i]);
  }
  return out;
}

}  // namespace parallax::runtime
