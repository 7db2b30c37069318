#include "tools/suite/shard.h"

#include <doctest/doctest.h>

#include <map>
#include <string>
#include <vector>

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
  // Computed with an independent FNV-1a: once CI has split a suite, it is always split alike.
  CHECK(shard_of("yale_shooting", 5) == 4);
  CHECK(shard_of("stuffy_room", 5) == 5);
  CHECK(shard_of("coin_toss", 5) == 1);
  CHECK(shard_of("", 5) == 1);
}

/// The part that --shard TEXT names under these variables; "" if it is refused.
std::string chosen(const std::string& text, const std::map<std::string, std::string>& variables) {
  base::DiagnosticSink sink;
  const auto shard = chosen_shard(
      text,
      [&](const std::string& name) {
        const auto at = variables.find(name);
        return at == variables.end() ? std::string() : at->second;
      },
      sink);
  CHECK(sink.has_errors() == !shard.has_value());
  return shard ? to_string(*shard) : "";
}

TEST_CASE("the environment says which part this is") {
  CHECK(chosen("2/5", {{"CI_NODE_INDEX", "1"}, {"CI_NODE_TOTAL", "9"}}) == "2/5");
  // GitLab counts from 1, a matrix of GitHub from 0.
  CHECK(chosen("env", {{"CI_NODE_INDEX", "3"}, {"CI_NODE_TOTAL", "3"}}) == "3/3");
  CHECK(chosen("env", {{"PARALLAX_SHARD_INDEX", "0"}, {"PARALLAX_SHARD_TOTAL", "4"}}) == "1/4");
  CHECK(chosen("env", {{"PARALLAX_SHARD_INDEX", "4"}, {"PARALLAX_SHARD_TOTAL", "4"}}).empty());
  CHECK(chosen("env", {{"CI_NODE_INDEX", "0"}, {"CI_NODE_TOTAL", "3"}}).empty());
  CHECK(chosen("env", {{"CI_NODE_INDEX", "x"}, {"CI_NODE_TOTAL", "3"}}).empty());
  CHECK(chosen("env", {{"CI_NODE_INDEX", "1"}}).empty());
  CHECK(chosen("env", {}).empty());
  // The job's own variables come first, then those of the cluster it runs on.
  CHECK(chosen("env", {{"PARALLAX_SHARD_INDEX", "1"},
                       {"PARALLAX_SHARD_TOTAL", "2"},
                       {"SLURM_ARRAY_TASK_ID", "7"},
                       {"CI_NODE_INDEX", "1"}}) == "2/2");
}

TEST_CASE("a job array may count from any number in any steps, but without gaps") {
  const auto task = [](const std::string& id, const std::string& count, const std::string& lowest,
                       const std::string& highest, const std::string& step) {
    return chosen("slurm", {{"SLURM_ARRAY_TASK_ID", id},
                            {"SLURM_ARRAY_TASK_COUNT", count},
                            {"SLURM_ARRAY_TASK_MIN", lowest},
                            {"SLURM_ARRAY_TASK_MAX", highest},
                            {"SLURM_ARRAY_TASK_STEP", step}});
  };
  CHECK(task("1", "4", "1", "4", "1") == "1/4");
  CHECK(task("0", "4", "0", "3", "1") == "1/4");
  CHECK(task("3", "4", "0", "3", "1") == "4/4");
  CHECK(task("30", "4", "10", "40", "10") == "3/4");
  CHECK(task("5", "3", "1", "9", "1").empty());  // --array=1,5,9
  CHECK(task("11", "4", "10", "40", "10").empty());
  CHECK(task("1", "0", "1", "4", "1").empty());
  CHECK(task("", "", "", "", "").empty());
  // A single task of a larger array that was submitted again is not a whole array.
  CHECK(task("3", "1", "3", "3", "1").empty());
  CHECK(task("2", "1", "2", "2", "1").empty());
  CHECK(chosen("env", {{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "1"}}).empty());
  CHECK(task("0", "1", "0", "0", "1") == "1/1");
  CHECK(task("1", "1", "1", "1", "1") == "1/1");
  // A system that tells only these two counts from 1.
  CHECK(chosen("slurm", {{"SLURM_ARRAY_TASK_ID", "2"}, {"SLURM_ARRAY_TASK_COUNT", "2"}}) == "2/2");
  CHECK(chosen("slurm", {{"SLURM_ARRAY_TASK_ID", "3"}, {"SLURM_ARRAY_TASK_COUNT", "2"}}).empty());
}

}  // namespace
}  // namespace parallax::tools
