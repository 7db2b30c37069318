// Initial states that no counted run tried, in traces and in executed plans: they are visited, what
// is found there is a discrepancy, and a run that leaves some out is inconclusive.

#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/gates.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

const std::vector<std::string> kRun = {"run", "gates.yaml", "--allow-commands", "--out", "out"};
constexpr int kNever = 99;
constexpr int kCounted = 21;  // runs that exclude 20 % with 99 % confidence

std::vector<std::string> with(std::vector<std::string> words,
                              const std::vector<std::string>& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// The samples of a journal, without repetitions.
std::vector<Json> samples_of(const CliFixture& cli, const std::string& folder) {
  std::vector<Json> out;
  std::istringstream in(cli.read(folder + "/journal.ndjson"));
  for (std::string line; std::getline(in, line);) {
    auto object = Json::parse(line);
    if (object.contains("sample") && object.at("phase") != "confirm") {
      out.push_back(std::move(object));
    }
  }
  return out;
}

std::set<std::int64_t> numbers_of(const std::vector<Json>& samples) {
  std::set<std::int64_t> out;
  for (const auto& sample : samples) out.insert(sample.at("sample").get<std::int64_t>());
  return out;
}

std::int64_t visits_of(const std::vector<Json>& samples) {
  return std::count_if(samples.begin(), samples.end(),
                       [](const auto& sample) { return sample.at("phase") == "visit"; });
}

int lines_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  int lines = 0;
  for (std::string line; std::getline(in, line);) ++lines;
  return lines;
}

/// The same bytes for more jobs, and wherever the journal is cut.
void check_reproducible(const Gates& cli, int code) {
  const auto journal = cli.read("out/journal.ndjson"), report = cli.read("out/report.json");
  CHECK(
      cli.parallax({"run", "gates.yaml", "--allow-commands", "--out", "two", "--jobs", "3"}).code ==
      code);
  CHECK(cli.read("two/journal.ndjson") == journal);
  std::istringstream in(journal);
  std::string line, before;
  for (int number = 1; std::getline(in, line); ++number) {
    before += line + '\n';
    if (number % 29 != 1) continue;
    CAPTURE(number);
    cli.write("out/journal.ndjson", before);
    CHECK(cli.parallax(with(kRun, {"--resume"})).code == code);
    CHECK(cli.read("out/journal.ndjson") == journal);
    CHECK(cli.read("out/report.json") == report);
  }
}

TEST_CASE("each initial state is tried, by runs that count for no claim where none does") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const Gates cli(7);
    cli.simulated("gates.yaml", kNever, kNever, "execution: " + execution + "\n");
    const auto report = json_of(cli, kRun);
    CHECK(report.at("verdict") == "no-discrepancy");
    CHECK(report.at("simulations") == kCounted);
    const auto& trace = report.at("traces").at(0);
    CHECK(trace.at("clean") == kCounted);
    CHECK(trace.at("claim").get<std::string>().find("each tried") != std::string::npos);
    const auto samples = samples_of(cli, "out");
    CHECK(std::ssize(samples) == kCounted + visits_of(samples));
    std::set<Json> starts;
    for (const auto& sample : samples) starts.insert(sample.at("initial"));
    CHECK(starts.size() == 128);
    const auto text = cli.read("out/report.txt");
    CHECK(text.find("128 of 128 initial states tried") != std::string::npos);
    CHECK(text.find("that count for no claim") != std::string::npos);
    check_reproducible(cli, 0);
    const auto visited = std::to_string(kCounted + 5);
    CHECK(cli.parallax({"replay", "out", "--sample", "1." + visited, "--allow-commands"}).code ==
          0);
    CHECK(cli.parallax({"coverage", "out"}).code == 0);
  }
}

TEST_CASE("a discrepancy in a visited state alone is one, and counts in no rate") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const Gates cli(7);
    cli.simulated("gates.yaml", kNever, 7, "execution: " + execution + "\n");
    const auto report = json_of(cli, kRun, 1);
    CHECK(report.at("verdict") == "discrepancy");
    CHECK(report.at("simulations") == kCounted);
    const std::int64_t sample = report.at("discrepancies").at(0).at("sample");
    REQUIRE(sample > kCounted);  // by this seed no counted run begins there
    const auto& trace = report.at("traces").at(0);
    CHECK(trace.at("clean") == kCounted);
    CHECK(trace.at("claim").get<std::string>().find("nothing is claimed about how often") !=
          std::string::npos);
    CHECK(samples_of(cli, "out").back().at("phase") == "visit");
    check_reproducible(cli, 1);
    CHECK(cli.parallax({"replay", "out", "--allow-commands"}).code == 0);
  }
}

TEST_CASE("executions: a cause that only a visited state has is counted in no rate") {
  const Gates cli(7);
  cli.simulated("gates.yaml", kNever, 7, "execution: closed-loop\n");
  const auto report = json_of(cli, with(kRun, {"--keep-going"}), 1);
  const auto& trace = report.at("traces").at(0);
  CHECK(trace.at("causes_runs") == kCounted);
  REQUIRE(trace.at("causes").size() == 1);
  CHECK(trace.at("causes").at(0).at("count") == 0);
  CHECK(trace.at("causes").at(0).at("example") > kCounted);
  // The other states are visited all the same.
  CHECK(trace.at("initial_states_tried") == 128);
}

TEST_CASE("a visit whose simulation is lost is made again, and then its state is not tried") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const Gates cli(7);
    cli.simulated("gates.yaml", 7, kNever, "execution: " + execution + "\n");
    const auto ran = cli.parallax(kRun);
    CAPTURE(ran.out);
    CAPTURE(ran.err);
    CHECK(ran.code == 4);
    CHECK(ran.out.find("no discrepancy found in 127 of 128 initial states") != std::string::npos);
    const auto samples = samples_of(cli, "out");
    std::int64_t lost = 0;
    for (const auto& sample : samples) {
      if (sample.at("status") != "lost") continue;
      ++lost;
      CHECK(sample.at("phase") == "visit");
    }
    CHECK(lost == 2);
    const auto report = Json::parse(cli.read("out/report.json"));
    CHECK(report.at("traces").at(0).at("lost") == 0);
    CHECK(report.at("traces").at(0).at("clean") == kCounted);
    CHECK(report.at("not_everywhere") == "in 127 of 128 initial states");
    CHECK(cli.read("out/report.txt").find("1 of 128 initial states were not tried") !=
          std::string::npos);
  }
}

TEST_CASE("where the limit has no room for the others the run is inconclusive, and goes on") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const Gates cli(7);
    cli.simulated("gates.yaml", kNever, kNever, "execution: " + execution + "\n");
    const auto limited = cli.parallax(with(kRun, {"--max-runs", "60"}));
    CHECK(limited.code == 4);
    CHECK(limited.out.find(" of 128 initial states") != std::string::npos);
    CHECK(visits_of(samples_of(cli, "out")) == 0);
    const auto text = cli.read("out/report.txt");
    const auto at = text.find("--max-runs ");
    REQUIRE(at != std::string::npos);
    const auto most = std::to_string(std::stoi(text.substr(at + 11)));
    CHECK(cli.parallax(with(kRun, {"--resume", "--max-runs", most})).code == 0);
  }
}

TEST_CASE("an initial state that no start can be is named, and keeps the verdict open") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const Gates cli(2);
    cli.simulated("gates.yaml", kNever, kNever, "execution: " + execution + "\n");
    cli.write("wrong.e", cli.read("wrong.e") + "fluent Lit()\n");  // a lamp, off in each start
    cli.replace("gates.yaml", "There(): {", "Lit(): {flag: \"Lit()\"}, There(): {");
    const auto ran = cli.parallax(kRun);
    CAPTURE(ran.out);
    CAPTURE(ran.err);
    CHECK(ran.code == 4);
    CHECK(ran.out.find("no discrepancy found in 4 of 8 initial states") != std::string::npos);
    const auto report = Json::parse(cli.read("out/report.json"));
    const auto& trace = report.at("traces").at(0);
    if (execution == "open-loop") {
      const auto& states = trace.at("initial_states");
      CHECK(states.at("all") == 8);
      CHECK(states.at("tried") == 4);
      CHECK(states.at("unrealisable").size() == 4);
    } else {
      CHECK(trace.at("initial_states") == 4);
      CHECK(trace.at("claim").get<std::string>().find(
                "from 4 initial states that a start can have, each equally likely") !=
            std::string::npos);
      CHECK(trace.at("initial_states_tried") == 4);
      CHECK(trace.at("initial_states_without_start").size() == 4);
    }
    CHECK(cli.read("out/report.txt").find("no start realises the initial state with Lit()") !=
          std::string::npos);
    check_reproducible(cli, 4);
    const auto checked = cli.parallax({"check", "gates.yaml"});
    CAPTURE(checked.err);
    CHECK(checked.code == 0);
    CHECK(checked.err.find("W5311") != std::string::npos);
  }
}

TEST_CASE("executions by weight: each state that has a weight is tried") {
  const Gates cli(6);
  const std::string rare =
      "execution: closed-loop\nstart_weights: [{when: \"HoldsAt(Shut(g0),0)\", weight: 0}, "
      "{when: \"HoldsAt(Shut(g1),0)\", weight: 0.001}]\n";
  cli.scenario("gates.yaml", "wrong.e", "wrong.e", rare);
  const auto report = json_of(cli, {"run", "gates.yaml", "--out", "out"});
  const auto& trace = report.at("traces").at(0);
  CHECK(trace.at("initial_states") == 32);
  CHECK(trace.at("initial_states_tried") == 32);
  CHECK(trace.at("initial_states_visits") >= 16);
}

TEST_CASE("a run that is interrupted while initial states are listed leaves no trace behind") {
  const Gates cli(13);
  REQUIRE(cli.parallax({"run", "gates.yaml", "--out", "whole"}).code == 4);
  const auto journal = cli.folder() / "out" / "journal.ndjson";
  ProcessOptions options;
  options.signal_when = [&] { return lines_of(journal) > 0 ? SIGINT : 0; };
  const auto stopped = cli.parallax({"run", "gates.yaml", "--out", "out"}, options);
  CAPTURE(stopped.out);
  CHECK(stopped.code == 130);
  CHECK(lines_of(journal) == 1);
  CHECK(cli.parallax({"run", "gates.yaml", "--out", "out", "--resume"}).code == 4);
  CHECK(cli.read("out/journal.ndjson") == cli.read("whole/journal.ndjson"));
}

TEST_CASE("further runs draw initial states as the run did, and make none of its own again") {
  std::vector<std::string> more;
  int lost = kNever;
  SUBCASE("in random orders") {}
  SUBCASE("independently") { more = {"--criterion", "clopper-pearson"}; }
  SUBCASE("after a search") { more = {"--search", "4"}; }
  SUBCASE("after a loss") { lost = 0; }
  for (const std::string seed : {"1", "2", "3", "4"}) {
    CAPTURE(seed);
    const Gates cli(2);
    cli.simulated("gates.yaml", lost, 2, "limits: {max_lost_in_a_row: 50}\n");
    const auto ran = cli.parallax(with(with(kRun, more), {"--seed", seed}));
    REQUIRE(ran.code == 1);
    const auto told = cli.parallax({"explain", "out", "--runs", "12", "--allow-commands"});
    CAPTURE(told.err);
    REQUIRE(told.code == 1);
    const auto known = numbers_of(samples_of(cli, "out"));
    const auto made = numbers_of(samples_of(cli, "out/further"));
    CHECK(made.size() >= 10);
    std::vector<std::int64_t> again;
    std::set_intersection(known.begin(), known.end(), made.begin(), made.end(),
                          std::back_inserter(again));
    CHECK(again.empty());
  }
}

}  // namespace
}  // namespace parallax::test
