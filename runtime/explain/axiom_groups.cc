#include "runtime/explain/axiom_groups.h"

#include <map>
#include <tuple>

namespace parallax::runtime {
namespace {

/// File, begin, end; and for what has no place the number of its origin.
using Key = std::tuple<std::size_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t,
                       std::uint32_t>;

/// Files in the order in which they are first seen; a compiled model names the places of the texts
/// it was made from.
Key key_of(const compiler::Origin& origin, std::uint32_t index,
           std::map<std::string, std::size_t>& files) {
  const auto& place = origin.place;
  const auto& source = origin.source;
  if (!place.file.empty()) {
    const auto file = files.emplace(place.file, files.size()).first->second;
    return {file, place.begin.line, place.begin.column, place.end.line, place.end.column, 0};
  }
  if (source.end > source.begin) {
    return {SIZE_MAX - 1,
            static_cast<std::uint32_t>(source.file.index()),
            source.begin,
            source.end,
            0,
            0};
  }
  return {SIZE_MAX, 0, 0, 0, 0, index};
}

}  // namespace

AxiomGroups group_axioms(const compiler::CompiledModel& model) {
  std::vector<bool> used(model.origins.size(), false);
  for (const auto origin : model.clause_origins) used[origin] = true;
  std::map<std::string, std::size_t> files;
  std::map<Key, std::vector<std::uint32_t>> by_place;
  for (std::uint32_t i = 0; i < model.origins.size(); ++i) {
    if (!used[i] || model.origins[i].kind == compiler::OriginKind::kInvariant) continue;
    by_place[key_of(model.origins[i], i, files)].push_back(i);
  }
  AxiomGroups groups;
  groups.group_of.assign(model.origins.size(), AxiomGroups::kNone);
  for (auto& [key, origins] : by_place) {
    for (const auto origin : origins) {
      groups.group_of[origin] = static_cast<std::uint32_t>(groups.origins.size());
    }
    groups.origins.push_back(std::move(origins));
  }
  return groups;
}

}  // namespace parallax::runtime
