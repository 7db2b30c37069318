#include "runtime/symmetry/constant_group.h"

#include <algorithm>
#include <map>

namespace parallax::runtime {

mpz_class ConstantGroup::order() const {
  mpz_class product = 1;
  for (const auto& level : levels) product *= static_cast<unsigned long>(level.orbit.size());
  return product;
}

namespace {

/// The pairs of a level's orbit and other constants, by their orbits under the level's group: the
/// next level's orbits, moved along with the base.
std::vector<ConstantGroup::Tie> ties_of(const ConstantGroup::Level& level,
                                        const std::vector<std::uint32_t>& whole,
                                        const std::vector<std::uint32_t>& below) {
  std::map<std::uint32_t, std::size_t> sizes;
  for (const auto orbit : below) ++sizes[orbit];
  std::map<std::uint32_t, std::uint32_t> largest;  // by orbit of the level: one of the next
  for (std::uint32_t one = 0; one < whole.size(); ++one) {
    auto& most = largest.emplace(whole[one], below[one]).first->second;
    if (sizes[below[one]] > sizes[most]) most = below[one];
  }
  std::vector<ConstantGroup::Tie> ties;
  for (std::uint32_t one = 0; one < whole.size(); ++one) {
    if (one == level.base || largest[whole[one]] == below[one]) continue;
    for (std::size_t i = 0; i < level.orbit.size(); ++i) {
      ties.push_back({level.orbit[i], level.to[i][one], below[one]});
    }
  }
  return ties;
}

}  // namespace

ConstantGroup group_of(const std::vector<std::string>& constants,
                       const std::vector<std::uint32_t>& set_of, const GroupParts& parts) {
  const auto& whole = parts.orbits.empty() ? set_of : parts.orbits.front();
  std::map<std::uint32_t, std::size_t> sizes;
  for (const auto orbit : whole) ++sizes[orbit];
  ConstantGroup group;
  ConstantMap number(constants.size());
  std::vector<std::uint32_t> moved;
  for (std::uint32_t one = 0; one < constants.size(); ++one) {
    if (sizes[whole[one]] < 2) continue;
    number[one] = static_cast<std::uint32_t>(moved.size());
    moved.push_back(one);
    group.constants.push_back(constants[one]);
  }
  for (const auto& level : parts.levels) {
    auto& out = group.levels.emplace_back();
    out.base = number[level.base];
    for (const auto one : level.orbit) out.orbit.push_back(number[one]);
    for (const auto& map : level.to) {
      auto& permutation = out.to.emplace_back();
      for (const auto one : moved) permutation.push_back(number[map[one]]);
    }
  }
  const auto add_orbits = [&](const std::vector<std::uint32_t>& orbits) {
    auto& out = group.orbits.emplace_back();
    std::map<std::uint32_t, std::uint32_t> numbers;
    for (const auto one : moved) {
      out.push_back(
          numbers.emplace(orbits[one], static_cast<std::uint32_t>(numbers.size())).first->second);
    }
  };
  for (const auto& orbits : parts.orbits) add_orbits(orbits);
  if (parts.orbits.empty()) add_orbits(set_of);
  for (std::size_t level = 0; level < parts.levels.size(); ++level) {
    group.ties.push_back(
        ties_of(group.levels[level], group.orbits[level], group.orbits[level + 1]));
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> left;
  for (const auto one : moved) {
    const bool is_base =
        std::find(parts.bases.begin(), parts.bases.end(), one) != parts.bases.end();
    if (!is_base) left[set_of[one]].push_back(number[one]);
  }
  for (const auto& [set, members] : left) {
    for (auto base = members.begin(); base + 1 < members.end(); ++base) {
      group.levels.push_back({*base, {base, members.end()}, {}});
    }
  }
  return group;
}

}  // namespace parallax::runtime
