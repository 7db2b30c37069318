#include "tools/suite/shard.h"

#include <charconv>

#include "compiler/base/hash.h"

namespace parallax::tools {
namespace {

bool parse_whole(std::string_view text, std::uint32_t& out) {
  const auto* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, out);
  return error == std::errc() && stop == end;
}

}  // namespace

std::optional<Shard> parse_shard(std::string_view text) {
  const auto slash = text.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  Shard shard;
  if (!parse_whole(text.substr(0, slash), shard.index)) return std::nullopt;
  if (!parse_whole(text.substr(slash + 1), shard.count)) return std::nullopt;
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
