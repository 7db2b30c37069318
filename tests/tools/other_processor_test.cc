// Runs, repetitions and suites that begin on one processor and go on on another one that calculates
// differently. The C library is told not to use what the processor has, as on an older processor.

#include <doctest/doctest.h>

#include <fstream>
#include <regex>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Whether the C library has other functions for an older processor of this kind.
bool can_be_older() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with("flags")) return has(line + ' ', " fma ");
  }
  return false;
}

ProcessResult on_older(const CliFixture& cli, const std::vector<std::string>& arguments) {
  std::vector<std::string> command = {
      "/usr/bin/env", "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-AVX2_Usable,-FMA_Usable",
      CliFixture::program()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  ProcessOptions options;
  options.folder = cli.folder().string();
  return run_process(command, options);
}

TEST_CASE("a run is not continued on a processor that calculates differently") {
  const CliFixture cli;
  if (!can_be_older()) {
    MESSAGE("SKIPPED: this processor has no FMA that the C library could be told not to use");
    return;
  }
  REQUIRE(on_older(cli, {"run", "scenario.yaml", "--max-runs", "2", "--out", "out"}).code == 4);
  const auto journal = cli.read("out/journal.ndjson");
  const auto here =
      cli.parallax({"run", "scenario.yaml", "--max-runs", "3", "--resume", "--out", "out"});
  CHECK(here.code == 3);
  CHECK_MESSAGE(has(here.err, "E7102"), here.err);
  CHECK(has(here.err, "its processor's arithmetic is "));
  CHECK(cli.read("out/journal.ndjson") == journal);
  CHECK(
      on_older(cli, {"run", "scenario.yaml", "--max-runs", "3", "--resume", "--out", "out"}).code ==
      4);
}

TEST_CASE("a journal that says no arithmetic is continued") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "scenario.yaml", "--max-runs", "2", "--out", "out"}).code == 4);
  auto journal = cli.read("out/journal.ndjson");
  const std::regex digits(R"("arithmetic":"[0-9a-f]{16}",)");
  REQUIRE(std::regex_search(journal, digits));
  cli.write("out/journal.ndjson", std::regex_replace(journal, digits, ""));
  const auto on =
      cli.parallax({"run", "scenario.yaml", "--max-runs", "3", "--resume", "--out", "out"});
  CHECK_MESSAGE(on.code == 4, on.err);
}

TEST_CASE("a repetition that differs says that its processor does") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "scenario.yaml", "--max-runs", "1", "--out", "out"}).code == 4);
  const auto journal = cli.read("out/journal.ndjson");
  const std::regex observed(R"("box.x":([0-9]+)\.([0-9]+))");
  std::smatch match;
  const auto begin = journal.find("\"observations\"");
  REQUIRE(begin != std::string::npos);
  const auto tail = journal.substr(begin);
  REQUIRE(std::regex_search(tail, match, observed));
  // Another digit in front of the last one.
  auto altered = tail;
  auto& digit = altered[static_cast<std::size_t>(match.position() + match.length()) - 2];
  digit = digit == '5' ? '6' : '5';
  cli.write("out/journal.ndjson", journal.substr(0, begin) + altered);
  const auto same = cli.parallax({"replay", "out", "--sample", "1.1"});
  CHECK_MESSAGE(same.code == 1, same.err);
  CHECK_FALSE(has(same.out, "processor"));
  const std::regex digits(R"("arithmetic":"[0-9a-f]{16}")");
  cli.write("out/journal.ndjson", std::regex_replace(journal.substr(0, begin), digits,
                                                     R"("arithmetic":"0123456789abcdef")") +
                                      altered);
  const auto other = cli.parallax({"replay", "out", "--sample", "1.1"});
  CHECK(other.code == 1);
  CHECK_MESSAGE(has(other.out, "a processor that calculates differently"), other.out);
  CHECK(has(cli.parallax({"replay", "out", "--sample", "1.1", "--json"}).out,
            "\"other_arithmetic\":true"));
}

TEST_CASE("parts of a suite from processors that calculate differently are not merged") {
  const CliFixture cli;
  if (!can_be_older()) {
    MESSAGE("SKIPPED: this processor has no FMA that the C library could be told not to use");
    return;
  }
  std::filesystem::create_directory(cli.folder() / "small");
  cli.write("small/gun.e",
            "range time 0 1\nfluent Alive()\nfluent Loaded()\nevent Shoot()\nHoldsAt(Alive(),0).\n"
            "[time] HoldsAt(Loaded(),time) -> Terminates(Shoot(),Alive(),time).\n");
  cli.write("small/suite.yaml",
            "cases:\n  - {id: one, model: gun.e, expect: {traces: 4}}\n"
            "  - {id: two, model: gun.e, expect: {traces: 4}}\n");
  const std::vector<std::string> suite = {"suite", "small"};
  const auto part = [&](const std::string& shard, const std::string& out) {
    auto all = suite;
    all.insert(all.end(), {"--shard", shard, "--out", out});
    return all;
  };
  cli.parallax(part("1/2", "one"));
  on_older(cli, part("2/2", "two"));
  const auto merged = cli.parallax({"suite", "--merge", "one", "two", "--out", "all"});
  CHECK(merged.code == 2);
  CHECK_MESSAGE(has(merged.err, "processors that calculate differently"), merged.err);
  cli.parallax(part("2/2", "three"));
  const auto alike = cli.parallax({"suite", "--merge", "one", "three", "--out", "all"});
  CHECK_MESSAGE(alike.code <= 1, alike.err);
}

}  // namespace
}  // namespace parallax::test
