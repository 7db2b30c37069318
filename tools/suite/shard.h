#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"

namespace parallax::tools {

/// The part `index` of `count`, counted from 1.
struct Shard {
  std::uint32_t index = 1;
  std::uint32_t count = 1;
};
bool operator==(const Shard& a, const Shard& b);
std::string to_string(const Shard& shard);

inline constexpr std::uint32_t kMaxShards = 10'000;

/// "2/5"; nothing for anything else than 1 <= i <= n <= kMaxShards.
std::optional<Shard> parse_shard(std::string_view text);

/// The value of an environment variable, empty without one.
using Environment = std::function<std::string(const std::string& name)>;

/// The part that the option --shard names: `I/N`; `slurm`: the task of a job array; `env`: what the
/// environment says, the first of PARALLAX_SHARD_INDEX and _TOTAL (from 0, as a matrix of GitHub
/// counts its jobs), a Slurm array, CI_NODE_INDEX and _TOTAL of GitLab (from 1). Reports kUsage.
base::Result<Shard> chosen_shard(const std::string& text, const Environment& environment,
                                 base::DiagnosticSink& sink);

/// Whether the case belongs to the shard. It depends on the case's id and on the count alone
/// (FNV-1a of the id, 64 bits, folded), so that new cases move no other.
bool in_shard(std::string_view id, const Shard& shard);

}  // namespace parallax::tools
