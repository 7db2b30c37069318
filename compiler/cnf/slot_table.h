#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace parallax::compiler {

/// Places for keys, chosen by hash so that adding or dropping a key moves few of the others: an
/// edit of the model changes little in the numbering of an artifact. A linear-probing table whose
/// entries are kept in order of their hashes; the layout depends on the set of keys only.
struct SlotLayout {
  std::vector<std::uint32_t> place;  // by key; below `capacity`
  std::uint32_t capacity = 0;        // a little larger than the number of keys
};

/// `hashes`: one for each key; equal hashes are told apart by their order. O(n log n).
SlotLayout lay_out(std::span<const std::uint64_t> hashes);

/// 64-bit FNV-1a, then mixed: a stable hash of a text, the same on every platform.
std::uint64_t stable_hash(std::span<const char> text, std::uint64_t seed = 0);
/// Mixes two hashes; not commutative.
std::uint64_t combine_hashes(std::uint64_t a, std::uint64_t b);

}  // namespace parallax::compiler
