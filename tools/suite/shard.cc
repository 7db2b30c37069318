#include "tools/suite/shard.h"

#include <fmt/format.h>

#include "compiler/base/codes/files.h"
#include "compiler/base/hash.h"
#include "compiler/base/whole_number.h"

namespace parallax::tools {
namespace {

base::Reported refused(const std::string& why, base::DiagnosticSink& sink) {
  return sink.error_about(codes::kUsage, "", "--shard: " + why);
}

std::optional<std::uint32_t> number_in(const Environment& environment, const std::string& name) {
  return base::whole_number<std::uint32_t>(environment(name));
}

/// Shard from two environment variables, index and count; the index counts from `first`.
base::Result<Shard> from_variables(const std::string& index, const std::string& count,
                                   std::uint32_t first, const Environment& environment,
                                   base::DiagnosticSink& sink) {
  const auto i = number_in(environment, index), n = number_in(environment, count);
  if (i && n && *i >= first && *i - first < *n && *n <= kMaxShards) {
    return Shard{*i - first + 1, *n};
  }
  return refused(fmt::format("{} is `{}` and {} is `{}`, which is no part from {} up to {}", index,
                             environment(index), count, environment(count), first, kMaxShards),
                 sink);
}

/// The tasks of an array count from any number, in any steps (`--array=0-9`, `--array=10-40:10`).
base::Result<Shard> from_slurm(const Environment& environment, base::DiagnosticSink& sink) {
  const auto id = number_in(environment, "SLURM_ARRAY_TASK_ID");
  const auto count = number_in(environment, "SLURM_ARRAY_TASK_COUNT");
  const auto lowest = number_in(environment, "SLURM_ARRAY_TASK_MIN").value_or(1);
  const auto highest = number_in(environment, "SLURM_ARRAY_TASK_MAX");
  const auto step = number_in(environment, "SLURM_ARRAY_TASK_STEP").value_or(1);
  const auto wrong = [&](std::string_view why) {
    return refused(
        fmt::format("the job array's task `{}` of `{}`{}", environment("SLURM_ARRAY_TASK_ID"),
                    environment("SLURM_ARRAY_TASK_COUNT"), why),
        sink);
  };
  if (!id || !count || *count < 1 || *count > kMaxShards) return wrong(" is no part of a whole");
  if (step < 1 || *id < lowest || (*id - lowest) % step != 0 || (*id - lowest) / step >= *count) {
    return wrong(" does not lie in its array");
  }
  if (highest && (*highest < lowest || (*highest - lowest) / step + 1 != *count)) {
    return wrong(" belongs to an array with gaps; number the tasks one after the other");
  }
  if (*count == 1 && *id > 1) {
    return wrong(
        " is the only one of its array, so nothing tells of how many parts it is one; say it, as "
        "--shard I/N");
  }
  return Shard{(*id - lowest) / step + 1, *count};
}

}  // namespace

bool operator==(const Shard& a, const Shard& b) { return a.index == b.index && a.count == b.count; }

std::string to_string(const Shard& shard) { return fmt::format("{}/{}", shard.index, shard.count); }

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

base::Result<Shard> chosen_shard(const std::string& text, const Environment& environment,
                                 base::DiagnosticSink& sink) {
  if (text == "slurm") return from_slurm(environment, sink);
  if (text == "env") {
    const auto is_set = [&](const char* name) { return !environment(name).empty(); };
    if (is_set("PARALLAX_SHARD_INDEX") || is_set("PARALLAX_SHARD_TOTAL")) {
      return from_variables("PARALLAX_SHARD_INDEX", "PARALLAX_SHARD_TOTAL", 0, environment, sink);
    }
    if (is_set("SLURM_ARRAY_TASK_ID")) return from_slurm(environment, sink);
    if (is_set("CI_NODE_INDEX")) {
      return from_variables("CI_NODE_INDEX", "CI_NODE_TOTAL", 1, environment, sink);
    }
    return refused(
        "nothing in the environment says which part this is (PARALLAX_SHARD_INDEX and "
        "PARALLAX_SHARD_TOTAL, SLURM_ARRAY_TASK_ID, CI_NODE_INDEX)",
        sink);
  }
  if (const auto shard = parse_shard(text)) return *shard;
  return refused(
      fmt::format("`{}` is not of the form I/N with 1 <= I <= N <= {}", text, kMaxShards), sink);
}

bool in_shard(std::string_view id, const Shard& shard) {
  auto hash = base::fnv1a64(id);
  // The low bits of FNV mix badly; the high half is folded in.
  hash ^= hash >> 32U;
  return hash % shard.count == shard.index - 1;
}

}  // namespace parallax::tools
