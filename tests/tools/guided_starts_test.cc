// Closed loop with starts that the solver chooses: they lead where drawn ones hardly come, no claim
// is about them, and nothing depends on the number of workers.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

#include "tests/tools/cli_fixture.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

/// Eight lamps; only where all are on something is done. One start of 256.
class Lamps : public CliFixture {
 public:
  Lamps() {
    write("lamps.e",
          "sort lamp\nlamp a, b, c, d, e, f, g, h\nfluent On(lamp)\nfluent Parked()\n"
          "event Park()\n[time] Initiates(Park(),Parked(),time).\n!HoldsAt(Parked(),0).\n");
    std::string guards, ends;
    for (const char lamp : std::string("abcdefgh")) {
      guards += std::string("  (when (holds (list 'on '") + lamp + "))\n";
      ends += ")";
    }
    write("lamps.lisp", "(def-cram-function look ()\n" + guards +
                            "  (perform (an action (type parking-arms)))" + ends + ")\n(look)\n");
    write("lamps.bind",
          "action parking-arms -> Park() ok: Parked() @t+1 else plan-failure\n"
          "query on (?l) ok: On(?l) @t\n");
    write("lamps.yaml",
          "model: lamps.e\nplan: lamps.lisp\nbind: lamps.bind\nhorizon: 2\n"
          "execution: closed-loop\nsimulator: {model: lamps.e}\n"
          "mapping: {On(l): {flag: \"On({l})\", drawn: true}}\n");
  }
};

std::vector<Json> samples_of(const std::string& journal) {
  std::vector<Json> out;
  std::istringstream in(journal);
  std::string line;
  while (std::getline(in, line)) {
    auto object = Json::parse(line);
    if (object.contains("sample")) out.push_back(std::move(object));
  }
  return out;
}

TEST_CASE("guided starts come where drawn ones hardly do, and no claim is about them") {
  const Lamps cli;
  const std::vector<std::string> run = {"run", "lamps.yaml", "--starts", "guided", "--out", "out"};
  const auto report = json_of(cli, run);
  const auto& stream = report.at("traces").at(0);
  const int guided = stream.at("chosen_starts"), all = stream.at("simulations");
  CHECK(stream.at("initial_states") == 256);
  // The one start with the deepest branch, and one for each branch that is not taken there; those
  // that drawn starts took meanwhile need none.
  CHECK(guided >= 2);
  CHECK(guided <= 9);
  CHECK(all - guided == 90);
  CHECK(stream.at("certified").at("epsilon") <= 0.05);
  const auto caveats = stream.at("caveats").dump();
  CHECK(caveats.find(std::to_string(guided) + " of the executions began in states that were "
                                              "chosen") != std::string::npos);
  CHECK(stream.at("claim").get<std::string>().find("90 clean runs of 90") != std::string::npos);
  const auto samples = samples_of(cli.read("out/journal.ndjson"));
  CHECK(samples.front().at("path").size() == 1);
  CHECK(samples.front().at("target").get<std::string>().find("lamps.lisp:") == 0);
  CHECK(std::count_if(samples.begin(), samples.end(),
                      [](const Json& sample) { return sample.contains("target"); }) == guided);
  const auto coverage = json_of(cli, {"coverage", "out"});
  for (const auto& item : coverage.at("branches")) {
    // Parking cannot fail.
    CHECK((item.at("hits") > 0) == (item.at("id") != "Park fails"));
  }
  // Drawn starts: with probability (255/256)^90, or 0.7, none is the one. Here none is.
  // The limit has no room for visits of the states that no drawn start has.
  const auto uniform =
      json_of(cli, {"run", "lamps.yaml", "--out", "uniform", "--seed", "1", "--max-runs", "90"}, 4);
  CHECK_FALSE(uniform.at("traces").at(0).contains("chosen_starts"));
  CHECK(json_of(cli, {"coverage", "uniform"}).at("performs").at(0).at("hits") == 0);
  // The bounds are about drawn starts: chosen starts do not count.
  for (const auto& never : coverage.at("never_shown")) CHECK(never.at("executions") == 90);

  // The same bytes for any number of workers, and for a run that was ended half-way.
  const auto journal = cli.read("out/journal.ndjson");
  fs::rename(cli.folder() / "out", cli.folder() / "first");
  auto more = run;
  more.insert(more.end(), {"--jobs", "3"});
  json_of(cli, more);
  CHECK(cli.read("out/journal.ndjson") == journal);
  CHECK(cli.read("out/report.json") == cli.read("first/report.json"));
  auto cut = journal.find('\n');
  for (int i = 0; i < 7; ++i) cut = journal.find('\n', cut + 1);
  fs::create_directory(cli.folder() / "half");
  cli.write("half/journal.ndjson", journal.substr(0, cut + 1));
  auto resume = run;
  resume.back() = "half";
  resume.emplace_back("--resume");
  json_of(cli, resume);
  CHECK(cli.read("half/journal.ndjson") == journal);
  // Not with drawn ones, and not from another state than the one that is chosen.
  CHECK(cli.parallax({"run", "lamps.yaml", "--out", "half", "--resume"}).code == 3);
  auto wrong = journal.substr(0, cut + 1);
  const auto target = wrong.find("\"target\":\"lamps.lisp");
  wrong.replace(target, 10, "\"target\":\"x");
  fs::remove_all(cli.folder() / "half");
  fs::create_directory(cli.folder() / "half");
  cli.write("half/journal.ndjson", wrong);
  const auto refused = cli.parallax(resume);
  CHECK(refused.code == 3);
  CHECK(refused.err.find("error[E7103]") != std::string::npos);
  CHECK(refused.err.find("not the one that was chosen") != std::string::npos);
}

TEST_CASE("guided starts: a discrepancy that one leads to is found at once") {
  const Lamps cli;
  // In the world parking puts a lamp out.
  cli.write("world.e",
            "load lamps.e\n[time] HoldsAt(On(a),time) -> Terminates(Park(),On(h),time).\n");
  cli.replace("lamps.yaml", "simulator: {model: lamps.e}",
              "simulator: {model: world.e}\nstarts: guided");
  const auto report = json_of(cli, {"run", "lamps.yaml", "--out", "out"}, 1);
  CHECK(report.at("simulations") == 1);
  CHECK(report.at("traces").at(0).at("chosen_starts") == 1);
  CHECK(cli.parallax({"replay", "out"}).code == 0);
}

TEST_CASE("guided starts: rates are counted in drawn starts alone") {
  const Lamps cli;
  // In the world parking does nothing. It is done from one start of 256, which is chosen.
  cli.write("still.e",
            "sort lamp\nlamp a, b, c, d, e, f, g, h\nfluent On(lamp)\nfluent Parked()\n"
            "event Park()\n!HoldsAt(Parked(),0).\n");
  cli.replace("lamps.yaml", "simulator: {model: lamps.e}",
              "simulator: {model: still.e}\nstarts: guided");
  const std::vector<std::string> run = {"run", "lamps.yaml", "--keep-going", "--out", "out"};
  const auto report = json_of(cli, run, 1);
  const auto& stream = report.at("traces").at(0);
  CHECK(report.at("discrepancies").at(0).at("sample") == 1);
  REQUIRE(stream.at("causes").size() == 1);
  const auto& cause = stream.at("causes").at(0);
  CHECK(cause.at("count") == 0);
  CHECK(cause.at("example") == 1);
  CHECK(cause.at("lower") == 0.0);
  // Ninety drawn ones, of which none is the one.
  CHECK(stream.at("causes_runs") == 90);
  CHECK(stream.at("simulations").get<int>() == 90 + stream.at("chosen_starts").get<int>());
  CHECK(std::pow(1.0 - cause.at("upper").get<double>(), 90) == doctest::Approx(0.025));
  CHECK(stream.at("caveats").dump().find("first 90 executions with a drawn start") !=
        std::string::npos);
  const auto journal = cli.read("out/journal.ndjson");
  auto more = run;
  more.back() = "jobs";
  more.insert(more.end(), {"--jobs", "3"});
  json_of(cli, more, 1);
  CHECK(cli.read("jobs/journal.ndjson") == journal);
}

TEST_CASE("guided starts: open loop has no use for them") {
  const Lamps cli;
  const auto open =
      cli.parallax({"run", "lamps.yaml", "--execution", "open-loop", "--starts", "guided"});
  CHECK(open.code == 2);
  CHECK(open.err.find("--execution closed-loop") != std::string::npos);
  cli.replace("lamps.yaml", "horizon: 2", "horizon: 2\nstarts: gided");
  const auto misspelt = cli.parallax({"run", "lamps.yaml"});
  CHECK(misspelt.code == 3);
  CHECK(misspelt.err.find("`guided`") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
