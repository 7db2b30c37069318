// Claims of `run` about several traces together, as users read them.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kThreeWays = R"(fluent Done()
fluent Marked()
event Left()
event Middle()
event Right()
[time] Initiates(Left(),Done(),time).
[time] Initiates(Middle(),Done(),time).
[time] Initiates(Right(),Done(),time).
[time] Happens(Left(),time) | Happens(Middle(),time) | Happens(Right(),time).
[time] Happens(Left(),time) -> !Happens(Middle(),time) & !Happens(Right(),time).
[time] Happens(Middle(),time) -> !Happens(Right(),time).
!HoldsAt(Done(),0).
)";

/// A model with three traces of one event each, and itself for a world.
class ThreeWays : public CliFixture {
 public:
  explicit ThreeWays(const std::string& more = "") {
    write("ways.e", kThreeWays);
    write("ways.yaml",
          "model: ways.e\nhorizon: 1\nsimulator: {model: ways.e}\n"
          "constraints: [\"HoldsAt(Done(),time)\"]\n" +
              more);
  }
};

const std::string kSentence =
    "with 99 % confidence, for each of the 3 traces fewer than 5 % of starts (one of the 2 initial "
    "states that lead to its events, each equally likely and each tried; then drawn uniformly from "
    "its region) give a discrepancy at any step; in each single initial state fewer than 10 % (270 "
    "clean runs of 270), supposing that no run affects another; the solver finds no other trace";

/// Text that was wrapped, in one line.
std::string in_one_line(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool blank = c == ' ' || c == '\n';
    if (!blank || (!out.empty() && out.back() != ' ')) out += blank ? ' ' : c;
  }
  return out;
}

bool has(const std::string& text, const std::string& part) {
  CAPTURE(text);
  CAPTURE(part);
  const bool found = text.find(part) != std::string::npos;
  CHECK(found);
  return found;
}

TEST_CASE("one sentence about all traces: in the summary, both reports and the page") {
  // `Marked` is open at the start, and says nothing about the events.
  const ThreeWays cli("criterion: clean-runs\n");
  const auto plain = cli.parallax({"run", "ways.yaml", "--out", "run"});
  CHECK(plain.code == 0);
  CHECK(has(in_one_line(plain.out), kSentence));
  CHECK(has(in_one_line(cli.read("run/report.txt")), kSentence));
  const auto report = Json::parse(cli.read("run/report.json"));
  CHECK(report.at("simulations") == 270);
  CHECK(report.at("criterion").at("family") == "all-traces");
  CHECK(report.at("criterion").at("may_be_watched") == true);
  CHECK(report.at("family").at("traces") == 3);
  CHECK(has(report.at("family").at("claim"), kSentence));
  for (const auto& trace : report.at("traces")) {
    CHECK(trace.at("certified").at("confidence") == 0.99);
    CHECK(trace.at("certified").at("epsilon") <= 0.05);
    CHECK(trace.at("error_share") == 1.0);
    CHECK(trace.at("initial_states").at("all") == 2);
    CHECK(trace.at("initial_states").at("tried") == 2);
  }
  CHECK(cli.parallax({"report", "run", "-o", "page.html"}).code == 0);
  const auto page = cli.read("page.html");
  CHECK(has(page, kSentence));
  CHECK(has(page, "90 clean runs of each of 3 traces"));

  // The same from workers, and if a run was ended behind its first trace.
  CHECK(cli.parallax({"run", "ways.yaml", "--out", "jobs", "--jobs", "3"}).code == 0);
  CHECK(cli.read("jobs/journal.ndjson") == cli.read("run/journal.ndjson"));
  auto journal = cli.read("run/journal.ndjson");
  std::size_t at = 0;
  for (int line = 0; line < 102; ++line) at = journal.find('\n', at) + 1;
  std::filesystem::create_directory(cli.folder() / "half");
  cli.write("half/journal.ndjson", journal.substr(0, at));
  CHECK(cli.parallax({"run", "ways.yaml", "--out", "half", "--resume"}).code == 0);
  CHECK(cli.read("half/journal.ndjson") == journal);

  const auto other =
      cli.parallax({"run", "ways.yaml", "--out", "run", "--resume", "--family", "per-trace"});
  CHECK(other.code == 3);
  CHECK(has(other.err, "options.criterion.family"));
}

TEST_CASE("initial states that lead to the same events are traces of their own if asked for") {
  const ThreeWays cli;
  const auto report = json_of(cli, {"run", "ways.yaml", "--out", "run", "--split-initial"});
  CHECK(report.at("iterations") == 6);
  CHECK(report.at("simulations") == 6 * 90);
  CHECK(has(report.at("family").at("claim"), "for each of the 6 traces"));
  CHECK(has(report.at("family").at("claim"), "each initial state that leads to the same events"));
}

TEST_CASE("each trace by itself, by the scenario and by the option, which has the last word") {
  const ThreeWays cli("criterion: {kind: clean-runs, family: per-trace}\n");
  const auto apart = json_of(cli, {"run", "ways.yaml", "--out", "run"});
  CHECK(apart.at("simulations") == 270);
  CHECK_FALSE(apart.contains("family"));
  CHECK(has(in_one_line(cli.read("run/report.txt")), "each claim holds for its trace alone"));
  CHECK(json_of(cli, {"run", "ways.yaml", "--out", "together", "--family", "all-traces"})
            .at("simulations") == 270);
}

TEST_CASE("a limit says how many there will be, and what there is beyond it is not claimed") {
  const ThreeWays cli;
  const auto result = json_of(cli, {"run", "ways.yaml", "--out", "run", "--max-traces", "2"}, 4);
  CHECK(result.at("family").at("traces") == 2);
  CHECK(result.at("simulations") == 180);
  CHECK(has(result.at("family").at("claim"), "the model may have other traces"));
}

TEST_CASE("a family that there is not is refused with what there is") {
  const ThreeWays cli("criterion: {kind: clean-runs, family: all-trace}\n");
  const auto result = cli.parallax({"run", "ways.yaml", "--out", "run"});
  CHECK(result.code == 3);
  CHECK(has(result.err, "ways.yaml:5:"));
  CHECK(has(result.err, "`all-traces`"));
  CHECK(cli.parallax({"run", "ways.yaml", "--family", "all"}).code == 2);
}

TEST_CASE("calibrate: the smaller table, through the protocol, and what it refuses") {
  const CliFixture cli;
  const auto run = [&](std::vector<std::string> more, int code = 0) {
    std::vector<std::string> all = {"calibrate", "--confidence", "0.9", "--epsilon", "0.2"};
    all.insert(all.end(), more.begin(), more.end());
    const auto result = cli.parallax(all);
    CAPTURE(result.err);
    CHECK(result.code == code);
    return result.out;
  };
  const auto out =
      run({"--loops", "200", "--protocol-loops", "3", "--criterion", "clean-runs", "--criterion",
           "anytime", "--simulator", "noisy", "--simulator", "two-traces"});
  CHECK(has(out, "| simulator | may be | `clean-runs` | `anytime` |"));
  CHECK(has(out, "| two traces, all-traces | 10 % |"));
  const std::vector<std::string> crash = {"--loops",     "0",           "--protocol-loops",
                                          "2",           "--criterion", "clean-runs",
                                          "--simulator", "crash-first", "--json"};
  const auto json = Json::parse(run(crash));
  const auto& cell = json.at("protocol").at(0);
  CHECK(json.at("protocol").size() == 1);
  CHECK(cell.at("loops") == 2);
  CHECK(cell.at("allowed").get<double>() == doctest::Approx(0.2));
  CHECK(json.at("within") == true);
  CHECK(Json::parse(run(crash)) == json);  // although the simulator takes no seed
  CHECK(run({"--criterion", "p-value"}, 2).empty());
  CHECK(run({"--loops", "-1"}, 2).empty());
  CHECK(run({"--loops", "0", "--protocol-loops", "0"}, 2).empty());
}

}  // namespace
}  // namespace parallax::test
