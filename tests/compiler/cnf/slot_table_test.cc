#include "compiler/cnf/slot_table.h"

#include <doctest/doctest.h>

#include <set>
#include <string>
#include <vector>

#include "tests/support/random.h"

namespace parallax::test {
namespace {

using compiler::lay_out;

std::vector<std::uint64_t> random_hashes(std::size_t count, std::uint64_t seed) {
  std::vector<std::uint64_t> hashes;
  for (std::size_t i = 0; i < count; ++i) {
    hashes.push_back(compiler::stable_hash("key" + std::to_string(i), seed));
  }
  return hashes;
}

TEST_CASE("every key has a place of its own below the capacity") {
  for (const std::size_t count : {0U, 1U, 2U, 3U, 4U, 5U, 100U, 5000U}) {
    const auto layout = lay_out(random_hashes(count, 1));
    REQUIRE(layout.place.size() == count);
    const std::set<std::uint32_t> places(layout.place.begin(), layout.place.end());
    CHECK(places.size() == count);
    if (count > 0) CHECK(*places.rbegin() < layout.capacity);
    CHECK(layout.capacity <= 2 * count + 8);
  }
}

TEST_CASE("the order in which keys are given does not move them") {
  const auto hashes = random_hashes(200, 2);
  const auto layout = lay_out(hashes);
  const std::vector<std::uint64_t> reversed(hashes.rbegin(), hashes.rend());
  const auto other = lay_out(reversed);
  CHECK(other.capacity == layout.capacity);
  for (std::size_t i = 0; i < hashes.size(); ++i) {
    CHECK(other.place[hashes.size() - 1 - i] == layout.place[i]);
  }
}

TEST_CASE("one key more moves few of the others") {
  Random random(3);
  auto hashes = random_hashes(1000, 3);
  auto before = lay_out(hashes);
  std::size_t moved = 0, rounds = 0;
  for (int round = 0; round < 20; ++round) {
    hashes.push_back(compiler::stable_hash("new" + std::to_string(random.below(1U << 30U))));
    auto after = lay_out(hashes);
    if (after.capacity == before.capacity) {
      ++rounds;
      for (std::size_t i = 0; i < before.place.size(); ++i) {
        if (after.place[i] != before.place[i]) ++moved;
      }
    }
    before = std::move(after);
  }
  REQUIRE(rounds > 10);
  CHECK(moved < rounds * 100);  // a tenth of the keys
}

TEST_CASE("keys of equal hash are told apart by their order") {
  const std::vector<std::uint64_t> same(10, compiler::stable_hash(std::string("twin")));
  const auto layout = lay_out(same);
  for (std::size_t i = 1; i < same.size(); ++i) CHECK(layout.place[i] == layout.place[i - 1] + 1);
}

TEST_CASE("hashes that all begin at the end of the table still find places") {
  std::vector<std::uint64_t> last;
  for (std::uint64_t i = 0; i < 50; ++i) last.push_back(~i);
  const auto layout = lay_out(last);
  const std::set<std::uint32_t> places(layout.place.begin(), layout.place.end());
  CHECK(places.size() == last.size());
  CHECK(*places.rbegin() < layout.capacity);
}

TEST_CASE("hashes are those that artifacts were numbered with") {
  // Artifacts are compared across builds: these values must not change.
  CHECK(compiler::stable_hash(std::string()) == 0xefd01f60ba992926ULL);
  CHECK(compiler::stable_hash(std::string("HoldsAt")) == 0x10d5b58b9aa204c6ULL);
  CHECK(compiler::stable_hash(std::string("HoldsAt")) !=
        compiler::stable_hash(std::string("HoldsAt"), 1));
  CHECK(compiler::combine_hashes(1, 2) != compiler::combine_hashes(2, 1));
}

}  // namespace
}  // namespace parallax::test
