#include "compiler/ground/ground_table.h"

#include "compiler/base/contract.h"

namespace parallax::compiler {

void GroundTable::add(std::span<const GroundTermId> row) {
  PARALLAX_REQUIRE(row.size() == columns_, "a row has a value for every column");
  values_.insert(values_.end(), row.begin(), row.end());
  const auto number = static_cast<std::uint32_t>(rows_++);
  for (auto& [mask, index] : indexes_) note(index, mask, number);
}

std::uint64_t GroundTable::hash(std::span<const GroundTermId> key) {
  std::uint64_t h = 0x9e3779b97f4a7c15ULL;
  for (const auto value : key) {
    h ^= value.index();
    h *= 0xbf58476d1ce4e5b9ULL;
    h ^= h >> 29U;
  }
  return h;
}

void GroundTable::note(Index& index, std::uint64_t mask, std::uint32_t number) const {
  std::vector<GroundTermId> key;
  const auto values = row(number);
  for (std::size_t i = 0; i < columns_; ++i) {
    if (((mask >> i) & 1U) != 0) key.push_back(values[i]);
  }
  index[hash(key)].push_back(number);
}

/// Two keys of equal hash share a list: whoever reads the rows compares their values anyway.
std::span<const std::uint32_t> GroundTable::find(std::uint64_t mask,
                                                 std::span<const GroundTermId> key) {
  const auto [entry, added] = indexes_.try_emplace(mask);
  if (added) {
    for (std::uint32_t number = 0; number < rows_; ++number) note(entry->second, mask, number);
  }
  const auto found = entry->second.find(hash(key));
  if (found == entry->second.end()) return {};
  return found->second;
}

}  // namespace parallax::compiler
