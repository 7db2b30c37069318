// Campaigns and suites on a Slurm that tools/cluster-test has started for this program: two nodes
// on one machine. The scripts are those of docs/guide/slurm.

#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/slurm_fixture.h"
#include "tests/tools/suite/case_repository.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

Json results_of(const CliFixture& cli, int part) {
  std::ifstream in(cli.folder() / ("out/" + std::to_string(part) + "/results.json"));
  const auto json = Json::parse(in, nullptr, false);
  return json.is_object() ? json.at("cases") : Json::object();
}

std::size_t count(const Json& cases, const char* outcome) {
  return static_cast<std::size_t>(std::count_if(
      cases.begin(), cases.end(), [&](const Json& one) { return one.at("outcome") == outcome; }));
}

TEST_CASE("forty cases in four array tasks, one of them killed, are completed and merged") {
  const CaseRepository cli;
  std::filesystem::create_directories(cli.folder() / "out");
  cli.write("array.sh", script_of_page("array.sh"));
  // The names of the page: its suite is called `scenarios`.
  std::filesystem::rename(cli.folder() / "repository", cli.folder() / "scenarios");
  const std::vector<std::string> merge = {"suite",   "--merge", "out/1", "out/2",
                                          "out/3",   "out/4",   "--out", "out/all",
                                          "--junit", "all.xml", "--json"};
  int killed = 0;
  std::size_t open = 0;
  // A task may be done before the signal comes; then all of it is tried again.
  for (int attempt = 0; attempt < 10 && open == 0; ++attempt) {
    for (int part = 1; part <= 4; ++part) {
      std::filesystem::remove_all(cli.folder() / "out" / std::to_string(part));
    }
    const auto array = submit(cli, {"array.sh"});
    killed = 0;
    while (killed == 0 && !jobs(cli, "%i").empty()) {
      for (int part = 1; part <= 4 && killed == 0; ++part) {
        const auto cases = results_of(cli, part);
        if (count(cases, "passed") > 0 && count(cases, "not finished") > 2) killed = part;
      }
    }
    if (killed != 0) {
      slurm(cli, {"scancel", "--signal=KILL", "--full", array + "_" + std::to_string(killed)});
    }
    wait_for_no_job(cli);
    if (killed != 0) open = count(results_of(cli, killed), "not finished");
  }
  REQUIRE(open > 0);
  const auto partial = cli.parallax(merge);
  CAPTURE(partial.err);
  CHECK(partial.code == 4);
  CHECK(Json::parse(partial.out).at("not_run") == open);

  submit(cli, {"--array=" + std::to_string(killed), "array.sh"});
  wait_for_no_job(cli);
  const auto all = cli.parallax(merge);
  CAPTURE(all.err);
  CHECK(all.code == 0);
  CHECK(Json::parse(all.out).at("passed") == CaseRepository::kCases);
  REQUIRE(cli.parallax({"suite", "scenarios", "--jobs", "2", "--no-cache", "--out", "whole",
                        "--junit", "whole.xml"})
              .code == 0);
  CHECK(without_times(cli.read("all.xml")) == without_times(cli.read("whole.xml")));
}

TEST_CASE("a sweep over seeds in one array is the suites of these seeds") {
  const TwoModels cli;
  std::filesystem::create_directories(cli.folder() / "out");
  std::filesystem::rename(cli.folder() / "two", cli.folder() / "scenarios");
  cli.write("sweep.sh", script_of_page("sweep.sh"));
  submit(cli, {"sweep.sh"});
  wait_for_no_job(cli);
  for (const std::string seed : {"1", "2"}) {
    const auto parts = "out/seed-" + seed;
    std::vector<std::string> merge = {"suite",      "--merge", "--out",
                                      "all" + seed, "--junit", "all" + seed + ".xml"};
    for (const auto* part : {"/1", "/2", "/3", "/4"}) merge.insert(merge.begin() + 2, parts + part);
    CHECK(cli.parallax(merge).code == 0);
    CHECK(cli.parallax({"suite", "scenarios", "--seed", seed, "--no-cache", "--out", "one" + seed,
                        "--junit", "one" + seed + ".xml"})
              .code == 0);
    CHECK(without_times(cli.read("all" + seed + ".xml")) ==
          without_times(cli.read("one" + seed + ".xml")));
  }
}

TEST_CASE("a campaign whose workers srun starts is that of one machine, also if one is cancelled") {
  const CliFixture here, there;
  CHECK(here.parallax(kRun).code == 0);
  bool cancelled = false;
  ProcessOptions options;
  options.signal_when = [&] {
    if (cancelled) return 0;
    // Some simulations are done, so that there are workers at others.
    if (journal_lines(there) < 10) return 0;
    const auto running = jobs(there, "%i", {"-t", "R"});
    if (running.empty()) return 0;
    cancelled = slurm(there, {"scancel", running.front()}).code == 0;
    return 0;
  };
  const auto found = there.parallax(
      with(kRun, {"--launcher", "srun --quiet -n1 -c1", "--jobs", "4", "--worker-silence", "60"}),
      options);
  CAPTURE(found.err);
  CHECK(found.code == 0);
  CHECK(cancelled);
  CHECK(found.err.find("a worker was lost") != std::string::npos);
  CHECK(differing_files(here, there, "run") == "");
  wait_for_no_job(there);
}

TEST_CASE("so is one that is a job itself, with its workers on the nodes of the job") {
  const CliFixture here, there;
  CHECK(here.parallax(kRun).code == 0);
  there.write("campaign.sh", script_of_page("campaign.sh"));
  there.replace("campaign.sh", "cases/drawer.yaml", "scenario.yaml");
  there.replace("campaign.sh", "--out out/drawer", "--record all --out run");
  submit(there, {"campaign.sh"});
  wait_for_no_job(there);
  CAPTURE(there.read("campaign.txt"));
  CHECK(differing_files(here, there, "run") == "");
}

TEST_CASE("no job is left where the campaign is killed") {
  for (const int signal : {SIGTERM, SIGKILL}) {
    const CliFixture cli;
    ProcessOptions options;
    options.signal_when = [&] { return journal_lines(cli) > 5 ? signal : 0; };
    const auto ended =
        cli.parallax(with(kRun, {"--launcher", "srun --quiet -n1 -c1", "--jobs", "3"}), options);
    CHECK(ended.code == 128 + signal);
    wait_for_no_job(cli);
  }
}

}  // namespace
}  // namespace parallax::test
