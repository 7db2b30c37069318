#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace parallax::tools {

/// The part `index` of `count`, counted from 1.
struct Shard {
  std::uint32_t index = 1;
  std::uint32_t count = 1;
};

inline constexpr std::uint32_t kMaxShards = 10'000;

/// "2/5"; nothing for anything else than 1 <= i <= n <= kMaxShards.
std::optional<Shard> parse_shard(std::string_view text);

/// Whether the case belongs to the shard. It depends on the case's id and on the count alone
/// (FNV-1a of the id, 64 bits, folded), so that new cases move no other.
bool in_shard(std::string_view id, const Shard& shard);

}  // namespace parallax::tools
