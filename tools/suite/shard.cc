#include "tools/suite/shard.h"

#include "compiler/base/hash.h"
#include "compiler/base/whole_number.h"

namespace parallax::tools {

std::optional<Shard> parse_shard(std::string_view text) {
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  Shard shard;
  const auto index = base::whole_number<std::uint32_t>(text.substr(0, slash));
  const auto count = base::whole_number<std::uint32_t>(text.substr(slash + 1));
  if (!index || !count) return std::nullopt;
  shard.index = *index;
  shard.count = *count;
  if (shard.index < 1 || shard.index > shard.count || shard.count > kMaxShards) {
    return std::nullopt;
  }
  return shard;
}

bool in_shard(std::string_view id, const Shard& shard) {
  auto hash = base::fnv1a64(id);
  // The low bits of FNV mix badly; the high half is folded in.
  hash ^= hash >> 32U;
  return hash % shard.count == shard.index - 1;
}

}  // namespace parallax::tools
