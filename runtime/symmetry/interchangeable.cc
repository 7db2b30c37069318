#include "runtime/symmetry/interchangeable.h"

#include <map>

#include "runtime/symmetry/swap_check.h"

namespace parallax::runtime {

using compiler::CompiledModel;

namespace {

/// Clauses that checks may look at, beyond so many of each that the model has.
constexpr std::int64_t kWork = 1'000'000;

NodeSwap named_swap(const NamedAtoms& atoms, std::uint32_t a, std::uint32_t b) {
  NodeSwap swap;
  for (const auto node : atoms.mentions(a)) {
    const auto to = atoms.swapped(node, a, b);
    PARALLAX_REQUIRE(to.has_value(), "an exchange was checked");
    // What mentions both is met once from either side.
    if (*to != node) swap.emplace_back(std::min(node, *to), std::max(node, *to));
  }
  std::sort(swap.begin(), swap.end());
  swap.erase(std::unique(swap.begin(), swap.end()), swap.end());
  return swap;
}

}  // namespace

ModelSymmetry::ModelSymmetry(const CompiledModel& model) {
  const NamedAtoms atoms(model);
  const auto count = static_cast<std::uint32_t>(atoms.constants().size());
  if (count < 2) return;
  SwapCheck check(model, atoms);
  const auto most = kWork + 16 * static_cast<std::int64_t>(model.clauses.size());
  // By signature the sets found so far; in the order of their first members.
  std::map<std::uint64_t, std::vector<std::size_t>> alike;
  std::vector<std::vector<std::uint32_t>> sets;
  for (std::uint32_t constant = 0; constant < count; ++constant) {
    auto& candidates = alike[check.signature(constant)];
    bool is_placed = false;
    for (const auto set : candidates) {
      if (check.work() > most) break;
      is_placed = check.is_symmetric(sets[set].front(), constant);
      if (!is_placed) continue;
      sets[set].push_back(constant);
      break;
    }
    if (is_placed) continue;
    candidates.push_back(sets.size());
    sets.push_back({constant});
  }
  for (const auto& set : sets) {
    if (set.size() < 2) continue;
    auto& names = constants_.sets.emplace_back();
    for (const auto constant : set) names.push_back(atoms.constants()[constant]);
    for (std::size_t i = 0; i + 1 < set.size(); ++i) {
      auto swap = named_swap(atoms, set[i], set[i + 1]);
      if (!swap.empty()) swaps_.push_back(std::move(swap));
    }
  }
}

}  // namespace parallax::runtime
