#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "tools/suite/suite_case.h"

namespace parallax::tools {
namespace {

std::uint32_t shard_of(const std::string& id, std::uint32_t count) {
  std::uint32_t found = 0;
  for (std::uint32_t i = 1; i <= count; ++i) {
    if (!in_shard(id, {i, count})) continue;
    CHECK_MESSAGE(found == 0, id << " is in two shards");
    found = i;
  }
  return found;
}

TEST_CASE("a shard is written as a part of a whole") {
  REQUIRE(parse_shard("2/5").has_value());
  CHECK(parse_shard("2/5")->index == 2);
  CHECK(parse_shard("2/5")->count == 5);
  CHECK(parse_shard("1/1").has_value());
  for (const auto* bad : {"", "/", "1", "0/5", "6/5", "1/0", "-1/5", "+1/5", "1/5 ", " 1/5",
                          "1/5/5", "a/b", "1.0/5", "1/10001", "1/99999999999"}) {
    CHECK_MESSAGE(!parse_shard(bad).has_value(), bad);
  }
}

TEST_CASE("every case is in exactly one shard, and the shards are of like size") {
  constexpr std::uint32_t kShards = 7;
  std::vector<int> sizes(kShards, 0);
  for (int i = 0; i < 7000; ++i) {
    const auto shard = shard_of("case_" + std::to_string(i), kShards);
    REQUIRE(shard >= 1);
    ++sizes[shard - 1];
  }
  for (const int size : sizes) {
    CHECK(size > 850);
    CHECK(size < 1150);
  }
}

TEST_CASE("a case keeps its shard from version to version") {
  // Computed with an independent FNV-1a: what CI has split once stays split alike.
  CHECK(shard_of("yale_shooting", 5) == 4);
  CHECK(shard_of("stuffy_room", 5) == 5);
  CHECK(shard_of("coin_toss", 5) == 1);
  CHECK(shard_of("", 5) == 1);
}

}  // namespace
}  // namespace parallax::tools
