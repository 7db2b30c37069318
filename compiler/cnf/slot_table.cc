// Numbers for names that hardly change when the set of names does.
//
// The home of a key is its hash, scaled to the size of the table. Keys are placed in the order
// of their hashes, each at its home or, if that is taken, at the next free place. That is linear
// probing with entries kept in order, so the layout is a function of the set of keys and not of
// the order of insertion; a new key moves only the run of keys behind its home. At most 7/8 of
// the places are used, homes end 1/16 before the end, and a table in which the last run does not
// fit grows by a quarter.
//
// Cost: O(n log n) for n keys, for sorting.

#include "compiler/cnf/slot_table.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "compiler/base/hash.h"

namespace parallax::compiler {
namespace {

constexpr std::uint32_t kLeast = 4;  // places of the smallest table, and the unit of all sizes

std::uint64_t mixed(std::uint64_t h) {
  h ^= h >> 33U;
  h *= 0xff51afd7ed558ccdULL;
  h ^= h >> 33U;
  h *= 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33U);
}

/// The next size: a quarter more, so that a table rarely has to be laid out anew.
std::uint32_t grown(std::uint32_t capacity) {
  const auto larger = capacity + capacity / 4;
  return std::max(capacity + kLeast, (larger + kLeast - 1) / kLeast * kLeast);
}

std::optional<std::vector<std::uint32_t>> places(const std::vector<std::uint32_t>& order,
                                                 std::span<const std::uint64_t> hashes,
                                                 std::uint32_t capacity) {
  // Homes leave a little room at the end for entries that are pushed along.
  const std::uint64_t homes = capacity - capacity / 16;
  std::vector<std::uint32_t> result(hashes.size());
  std::uint64_t next = 0;
  for (const auto key : order) {
    const auto home = ((hashes[key] >> 32U) * homes) >> 32U;
    next = std::max(next, home);
    if (next >= capacity) return std::nullopt;
    result[key] = static_cast<std::uint32_t>(next++);
  }
  return result;
}

}  // namespace

SlotLayout lay_out(std::span<const std::uint64_t> hashes) {
  SlotLayout layout;
  if (hashes.empty()) return layout;
  std::vector<std::uint32_t> order(hashes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return hashes[a] < hashes[b]; });
  layout.capacity = kLeast;
  while (layout.capacity - layout.capacity / 8 < hashes.size()) {
    layout.capacity = grown(layout.capacity);
  }
  for (;;) {
    auto found = places(order, hashes, layout.capacity);
    if (found) {
      layout.place = *std::move(found);
      return layout;
    }
    layout.capacity = grown(layout.capacity);
  }
}

std::uint64_t stable_hash(std::span<const char> text, std::uint64_t seed) {
  return mixed(base::fnv1a64({text.data(), text.size()}, base::kFnvStart ^ seed));
}

std::uint64_t combine_hashes(std::uint64_t a, std::uint64_t b) {
  return mixed(a * 0x9e3779b97f4a7c15ULL + b + 0x7f4a7c15ULL);
}

}  // namespace parallax::compiler
