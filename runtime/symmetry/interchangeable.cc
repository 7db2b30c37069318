// The symmetries of a model that permute constants.
//
// First pairs: two constants are exchangeable if the exchange maps the clauses onto themselves
// (permutation_check.cc). Exchanging is transitive, so a constant is compared with one member of
// each set, and only of sets with the same signature, a hash that an exchange keeps. Neighbours
// of a set generate all its permutations. If constants of different sets have the same
// signature, symmetries that move several at once may exist, and are searched for
// (symmetry_search.cc). Each generator was checked exactly; with a bounded effort some may be
// missing, which weakens what uses them but is never wrong.
//
// Cost: one check for each constant and set of its signature.

#include "runtime/symmetry/interchangeable.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "runtime/symmetry/symmetry_search.h"

namespace parallax::runtime {

using compiler::CompiledModel;

namespace {

/// Clauses that checks may look at, beyond 16 for each clause of the model.
constexpr std::int64_t kWork = 1'000'000;

/// Literals that refinements may look at, beyond 16 times those of the model.
constexpr std::int64_t kQuick = 50'000'000;
constexpr std::int64_t kThorough = 300'000'000;

std::vector<std::vector<std::string>> cycles_of(const std::vector<std::string>& constants,
                                                const ConstantMap& map) {
  std::vector<std::vector<std::string>> cycles;
  std::vector<bool> seen(map.size());
  for (std::uint32_t first = 0; first < map.size(); ++first) {
    if (seen[first] || map[first] == first) continue;
    auto& cycle = cycles.emplace_back();
    for (auto at = first; !seen[at]; at = map[at]) {
      seen[at] = true;
      cycle.push_back(constants[at]);
    }
  }
  return cycles;
}

}  // namespace

NodeMap moved_nodes(const NamedAtoms& atoms, const ConstantMap& map) {
  NodeMap moved;
  for (std::uint32_t constant = 0; constant < map.size(); ++constant) {
    if (map[constant] == constant) continue;
    for (const auto node : atoms.mentions(constant)) {
      const auto to = atoms.image(node, map);
      PARALLAX_REQUIRE(to.has_value(), "a symmetry was checked");
      if (*to != node) moved.emplace_back(node, *to);
    }
  }
  // An atom that mentions several constants is met once from each.
  std::sort(moved.begin(), moved.end());
  moved.erase(std::unique(moved.begin(), moved.end()), moved.end());
  return moved;
}

ModelSymmetry::ModelSymmetry(const CompiledModel& model, SymmetryEffort effort) {
  const NamedAtoms atoms(model);
  const auto& names = atoms.constants();
  if (names.size() < 2) return;
  PermutationCheck check(model, atoms);
  find_sets(model, atoms, check);
  exchanges_ = generators_.size();
  if (is_settled_) {
    group_ = group_of(names, set_of_, {});
    known_order_ = group_.order();
    return;
  }
  ConstantColours colours(model, atoms, check);
  const auto most = effort == SymmetryEffort::kQuick ? kQuick : kThorough;
  const SymmetrySearch search(check, colours, set_of_, most);
  is_complete_ = search.is_complete();
  // From the first base to the last, as exchanges come.
  const auto& found = search.generators();
  for (auto g = found.size(); g-- > 0;) {
    add(atoms, found[g]);
    if (is_complete_) constants_.together.push_back(cycles_of(names, found[g]));
  }
  group_ = search.group(names);
  known_order_ = search.known_order();
}

void ModelSymmetry::add(const NamedAtoms& atoms, const ConstantMap& map) {
  auto moved = moved_nodes(atoms, map);
  if (!moved.empty()) generators_.push_back(std::move(moved));
}

void ModelSymmetry::find_sets(const CompiledModel& model, const NamedAtoms& atoms,
                              PermutationCheck& check) {
  const auto count = static_cast<std::uint32_t>(atoms.constants().size());
  const auto most = kWork + 16 * static_cast<std::int64_t>(model.clauses.size());
  // By signature the sets found so far; in the order of their first members.
  std::map<std::uint64_t, std::vector<std::size_t>> alike;
  std::vector<std::vector<std::uint32_t>> sets;
  ConstantMap map(count);
  std::iota(map.begin(), map.end(), 0U);
  const auto exchange = [&](std::uint32_t a, std::uint32_t b) { std::swap(map[a], map[b]); };
  for (std::uint32_t constant = 0; constant < count; ++constant) {
    auto& candidates = alike[check.signature(constant)];
    bool is_placed = false;
    for (const auto set : candidates) {
      if (check.work() > most) break;
      exchange(sets[set].front(), constant);
      is_placed = check.is_symmetric(map);
      exchange(sets[set].front(), constant);
      if (!is_placed) continue;
      sets[set].push_back(constant);
      set_of_.push_back(static_cast<std::uint32_t>(set));
      break;
    }
    if (is_placed) continue;
    if (!candidates.empty()) is_settled_ = false;
    candidates.push_back(sets.size());
    set_of_.push_back(static_cast<std::uint32_t>(sets.size()));
    sets.push_back({constant});
  }
  for (const auto& set : sets) {
    if (set.size() < 2) continue;
    auto& names = constants_.sets.emplace_back();
    for (const auto constant : set) names.push_back(atoms.constants()[constant]);
    for (std::size_t i = 0; i + 1 < set.size(); ++i) {
      exchange(set[i], set[i + 1]);
      add(atoms, map);
      exchange(set[i], set[i + 1]);
    }
  }
}

}  // namespace parallax::runtime
