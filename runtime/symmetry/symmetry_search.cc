// Symmetries that exchange several constants at once, by individualization and refinement (McKay
// 1981).
//
// Colour refinement (constant_colours.cc) splits the constants into cells; no symmetry leaves a
// cell. A base is a constant of a cell that exchanges of two constants do not explain; it is
// told apart and the colours are refined again, until all cells are explained. From the last
// base to the first, each constant of the base's cell is tried as its image, the bases before it
// being fixed: source and target are refined side by side, branching on further cells, until the
// map is complete and is checked on the clauses (permutation_check.cc). Images that known
// permutations already reach, and those in the orbit of a refuted one, are not tried. The
// permutations found, with the exchanges, generate the group as a chain of stabilizers: each
// level has the orbit of its base and a permutation to each member, so the order is the product
// of the orbits' sizes.
//
// Cost: exponential in the worst case; refinements, checks and memory have fixed budgets, beyond
// which only the exchanges are kept.

#include "runtime/symmetry/symmetry_search.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace parallax::runtime {

namespace {

/// Clauses that checks may look at, beyond 16 for each clause of the model.
constexpr std::int64_t kChecks = 1'000'000;
/// Words that permutations of all levels may take.
constexpr std::int64_t kMostWords = 8'000'000;

ConstantMap identity(std::size_t count) {
  ConstantMap map(count);
  std::iota(map.begin(), map.end(), 0U);
  return map;
}

bool has_number(const std::vector<std::uint32_t>& all, std::uint32_t one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

/// The members of classes, smallest number first.
class Classes {
 public:
  explicit Classes(std::size_t count) : parent_(identity(count)) {}
  std::uint32_t of(std::uint32_t one) {
    while (parent_[one] != one) one = parent_[one] = parent_[parent_[one]];
    return one;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = of(a);
    b = of(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace

SymmetrySearch::SymmetrySearch(PermutationCheck& check, ConstantColours& colours,
                               const std::vector<std::uint32_t>& set_of, std::int64_t most)
    : check_(check), colours_(colours), set_of_(set_of) {
  const auto clauses = static_cast<std::int64_t>(check.entries().size());
  most_check_ = check.work() + kChecks + 16 * clauses;
  most_colours_ = most + 16 * colours.size();
  choose_bases();
  find_generators();
}

bool SymmetrySearch::may_go_on() {
  complete_ = complete_ && check_.work() <= most_check_ && colours_.work() <= most_colours_ &&
              words_ <= kMostWords;
  return complete_;
}

/// Cells of more than one constant, and the others, in the order of their first members.
std::vector<std::vector<std::uint32_t>> SymmetrySearch::cells_of(const Colours& colours) const {
  std::map<std::uint64_t, std::size_t> places;
  std::vector<std::vector<std::uint32_t>> cells;
  for (std::uint32_t constant = 0; constant < colours.size(); ++constant) {
    const auto [found, is_new] = places.emplace(colours[constant], cells.size());
    if (is_new) cells.emplace_back();
    cells[found->second].push_back(constant);
  }
  return cells;
}

bool SymmetrySearch::is_within_set(const std::vector<std::uint32_t>& cell) const {
  return std::all_of(cell.begin(), cell.end(),
                     [&](auto one) { return set_of_[one] == set_of_[cell.front()]; });
}

/// Chooses bases until only exchanges within sets are left.
void SymmetrySearch::choose_bases() {
  while (may_go_on()) {
    auto& refined = refined_.emplace_back();
    refined.colours = colours_.refined(bases_, refined.rounds);
    auto cells = cells_of(refined.colours);
    const auto open = std::find_if(cells.begin(), cells.end(),
                                   [&](const auto& cell) { return !is_within_set(cell); });
    if (open == cells.end()) return;
    bases_.push_back(open->front());
    candidates_.push_back(std::move(*open));
  }
}

/// By constant: the number of its orbit under the known permutations that fix the bases before the
/// level.
std::vector<std::uint32_t> SymmetrySearch::orbits_at(std::size_t level) const {
  Classes classes(set_of_.size());
  std::map<std::uint32_t, std::uint32_t> first_of_set;
  const std::vector<std::uint32_t> fixed(bases_.begin(),
                                         bases_.begin() + static_cast<std::ptrdiff_t>(level));
  for (std::uint32_t one = 0; one < set_of_.size(); ++one) {
    if (!has_number(fixed, one)) {
      classes.join(first_of_set.emplace(set_of_[one], one).first->second, one);
    }
  }
  for (std::size_t g = 0; g < generators_.size(); ++g) {
    if (level_of_[g] < level) continue;
    for (std::uint32_t one = 0; one < set_of_.size(); ++one) classes.join(one, generators_[g][one]);
  }
  std::vector<std::uint32_t> out;
  for (std::uint32_t one = 0; one < set_of_.size(); ++one) out.push_back(classes.of(one));
  return out;
}

void SymmetrySearch::find_generators() {
  levels_.resize(bases_.size());
  for (auto level = bases_.size(); level-- > 0;) {
    const auto base = bases_[level];
    const std::vector<std::uint32_t> before(bases_.begin(),
                                            bases_.begin() + static_cast<std::ptrdiff_t>(level));
    auto orbits = orbits_at(level);
    std::set<std::uint32_t> refuted;  // one of an orbit speaks for all of it
    for (const auto candidate : candidates_[level]) {
      if (orbits[candidate] == orbits[base] || refuted.contains(orbits[candidate])) continue;
      if (!may_go_on()) break;
      auto from = before, to = before;
      from.push_back(base);
      to.push_back(candidate);
      auto found = find(std::move(from), std::move(to));
      if (!found) {
        refuted.insert(orbits[candidate]);
        continue;
      }
      generators_.push_back(std::move(*found));
      level_of_.push_back(level);
      orbits = orbits_at(level);
    }
    close_level(level);
  }
}

/// The orbit of the level's base, and a permutation that takes the base to each constant of it.
void SymmetrySearch::close_level(std::size_t level) {
  auto& out = levels_[level];
  out.base = bases_[level];
  out.orbit = {out.base};
  out.to = {identity(set_of_.size())};
  std::vector<bool> seen(set_of_.size());
  seen[out.base] = true;
  const auto reach = [&](std::uint32_t next, ConstantMap map) {
    seen[next] = true;
    out.orbit.push_back(next);
    out.to.push_back(std::move(map));
    words_ += static_cast<std::int64_t>(set_of_.size());
  };
  for (std::size_t level_before = 0; level_before < level; ++level_before) {
    seen[bases_[level_before]] = true;
  }
  for (std::size_t i = 0; i < out.orbit.size() && may_go_on(); ++i) {
    const auto at = out.orbit[i];
    for (std::uint32_t next = 0; next < set_of_.size(); ++next) {
      if (seen[next] || set_of_[next] != set_of_[at]) continue;
      auto map = out.to[i];
      for (auto& image : map) image = image == at ? next : image == next ? at : image;
      reach(next, std::move(map));
    }
    for (std::size_t g = 0; g < generators_.size(); ++g) {
      if (level_of_[g] < level || seen[generators_[g][at]]) continue;
      auto map = out.to[i];
      for (auto& image : map) image = generators_[g][image];
      reach(generators_[g][at], std::move(map));
    }
  }
}

/// Images in the order in which they are tried: a constant that makes an exchange, or stays where
/// it is, is as a rule what the model means. One of a set stands for all.
std::vector<std::uint32_t> SymmetrySearch::images_to_try(
    const std::vector<std::uint32_t>& from, const std::vector<std::uint32_t>& to,
    std::uint32_t constant, const std::vector<std::uint32_t>& cell) const {
  std::vector<std::uint32_t> out;
  std::set<std::uint32_t> sets;
  const auto add = [&](std::uint32_t one) {
    if (has_number(cell, one) && sets.insert(set_of_[one]).second) out.push_back(one);
  };
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (to[i] == constant) add(from[i]);
  }
  add(constant);
  for (const auto one : cell) add(one);
  return out;
}

/// A symmetry that takes each constant of one list to that of the other. Exhaustive, unless it
/// takes too long.
std::optional<ConstantMap> SymmetrySearch::find(std::vector<std::uint32_t> from,
                                                std::vector<std::uint32_t> to) {
  if (!may_go_on()) return std::nullopt;
  const bool is_known =
      from.size() < refined_.size() && std::equal(from.begin(), from.end(), bases_.begin());
  auto refined = is_known ? refined_[from.size()] : Refined();
  if (!is_known) refined.colours = colours_.refined(from, refined.rounds);
  const auto& source = refined.colours;
  const auto target = colours_.after(to, refined.rounds);
  auto sorted_source = source, sorted_target = target;
  std::sort(sorted_source.begin(), sorted_source.end());
  std::sort(sorted_target.begin(), sorted_target.end());
  if (sorted_source != sorted_target) return std::nullopt;
  for (const auto& cell : cells_of(source)) {
    if (is_within_set(cell)) continue;
    std::vector<std::uint32_t> others;
    for (std::uint32_t one = 0; one < target.size(); ++one) {
      if (target[one] == source[cell.front()]) others.push_back(one);
    }
    for (const auto image : images_to_try(from, to, cell.front(), others)) {
      auto more_from = from, more_to = to;
      more_from.push_back(cell.front());
      more_to.push_back(image);
      auto found = find(std::move(more_from), std::move(more_to));
      if (found) return found;
    }
    return std::nullopt;
  }
  return finish(source, target);
}

/// Within sets every choice is as good as any other: constants stay where they are if they can.
std::optional<ConstantMap> SymmetrySearch::finish(const Colours& source, const Colours& target) {
  std::map<std::uint64_t, std::vector<std::uint32_t>> open;
  auto map = identity(source.size());
  for (std::uint32_t one = 0; one < target.size(); ++one) {
    if (target[one] != source[one]) open[target[one]].push_back(one);
  }
  std::map<std::uint64_t, std::size_t> used;
  for (std::uint32_t one = 0; one < source.size(); ++one) {
    if (target[one] != source[one]) map[one] = open[source[one]][used[source[one]]++];
  }
  if (!check_.is_symmetric(map)) return std::nullopt;
  return map;
}

mpz_class SymmetrySearch::known_order() const {
  mpz_class order = 1;
  std::map<std::uint32_t, std::uint32_t> left;
  for (std::uint32_t one = 0; one < set_of_.size(); ++one) {
    if (!has_number(bases_, one)) order *= ++left[set_of_[one]];
  }
  for (const auto& level : levels_) {
    order *= static_cast<unsigned long>(std::max<std::size_t>(level.orbit.size(), 1));
  }
  return order;
}

ConstantGroup SymmetrySearch::group(const std::vector<std::string>& constants) const {
  GroupParts parts;
  if (!complete_) return group_of(constants, set_of_, parts);
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    if (levels_[level].orbit.size() < 2) continue;  // only looked as if it moved
    parts.levels.push_back(levels_[level]);
    parts.orbits.push_back(orbits_at(level));
  }
  parts.bases = bases_;
  parts.orbits.push_back(orbits_at(levels_.size()));
  return group_of(constants, set_of_, parts);
}

}  // namespace parallax::runtime
