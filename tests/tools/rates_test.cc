// `parallax rates` as users run it: counts by cause, their intervals, limits and bad input.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// P(X <= k) for n draws with probability p, term by term.
double binomial_cdf(int k, int n, double p) {
  double sum = 0.0;
  for (int i = 0; i <= k; ++i) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                    i * std::log(p) + (n - i) * std::log1p(-p));
  }
  return sum;
}

/// The p at which a decreasing function of it crosses `level`.
template <typename Function>
double crossing(const Function& decreasing, double level) {
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (decreasing(middle) > level ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// The interval of Clopper and Pearson by its definition: the p under which a count as extreme as
/// this one has half of the error probability.
void check_interval(const Json& rate, int runs, double confidence) {
  const int count = rate["count"];
  CAPTURE(rate.dump());
  CAPTURE(runs);
  const double tail = 0.5 * (1.0 - confidence);
  const double lower =
      count == 0 ? 0.0
                 : crossing([&](double p) { return binomial_cdf(count - 1, runs, p); }, 1.0 - tail);
  const double upper =
      count == runs ? 1.0 : crossing([&](double p) { return binomial_cdf(count, runs, p); }, tail);
  CHECK(rate["rate"].get<double>() == doctest::Approx(static_cast<double>(count) / runs));
  CHECK(rate["lower"].get<double>() == doctest::Approx(lower).epsilon(1e-7));
  CHECK(rate["upper"].get<double>() == doctest::Approx(upper).epsilon(1e-7));
}

TEST_CASE("what the runs were to go on for is told, or that they ended before") {
  const CliFixture cli;
  const auto rates = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {"rates", "edge.yaml", "--json"};
    all.insert(all.end(), more.begin(), more.end());
    const auto ran = cli.parallax(all);
    CAPTURE(ran.err);
    REQUIRE(ran.err.empty());
    return std::pair(ran.code, Json::parse(ran.out)["traces"][0]);
  };
  // About a third of the starts go wrong.
  const auto [known, below] = rates({"--until-below", "0.95", "--runs", "60"});
  CHECK(known == 0);
  CHECK(below["claim"] == Json{{"rate", "below 95 %"}, {"holds", true}});
  CHECK(below["runs"] < 60);
  const auto [refuted, above] = rates({"--until-above", "0.95", "--runs", "60"});
  CHECK(refuted == 0);
  CHECK(above["claim"]["holds"] == false);
  const auto [open, not_known] = rates({"--until-below", "0.9", "--runs", "1"});
  CHECK(open == 4);
  CHECK(not_known["claim"]["holds"].is_null());
  const auto [wide, width] = rates({"--until-width", "0.01", "--runs", "5"});
  CHECK(wide == 4);
  CHECK(width["narrow"] == false);
  const auto text = cli.parallax({"rates", "edge.yaml", "--until-width", "0.01", "--runs", "5"});
  CHECK(text.code == 4);
  CHECK(text.out.find("not as narrow as asked, 1 points; give more --runs") != std::string::npos);
  CHECK(rates({"--until-width", "0.99", "--runs", "60"}).first == 0);
}

TEST_CASE("a sequential test answers beyond its indifference region, or says that it did not") {
  const CliFixture cli;
  const auto rates = [&](std::vector<std::string> more, int code) {
    std::vector<std::string> all = {"rates", "edge.yaml"};
    all.insert(all.end(), more.begin(), more.end());
    return json_of(cli, all, code)["traces"][0];
  };
  // About a third of the starts go wrong.
  const auto below = rates({"--until-below", "0.9", "--indifference", "0.2"}, 0);
  CHECK(below["claim"]["answer"] == "below");
  CHECK(below["claim"]["holds"] == true);
  CHECK(below["claim"]["test"] == "sequential-probability-ratio");
  CHECK(below["claim"]["errors"] == Json{{"below", 0.05}, {"above", 0.05}});
  CHECK(below["claim"]["indifference"][0].get<double>() == doctest::Approx(0.7));
  CHECK(below["claim"]["indifference"][1].get<double>() == doctest::Approx(0.9));
  // The runs end where the likelihood ratio leaves (1/20, 20), and not before.
  const auto log_ratio = [](int failures, int runs) {
    return failures * std::log(0.9 / 0.7) + (runs - failures) * std::log(0.1 / 0.3);
  };
  const int runs = below["runs"], failures = below["any"]["count"];
  CHECK(log_ratio(failures, runs) <= -std::log(20.0));
  CHECK(log_ratio(failures, runs - 1) > -std::log(20.0));  // the last run was clean
  const auto above = rates({"--until-above", "0.02", "--indifference", "0.05"}, 0);
  CHECK(above["claim"]["answer"] == "above");
  CHECK(above["claim"]["holds"] == true);
  const auto not_below = rates({"--until-below", "0.07", "--indifference", "0.05"}, 0);
  CHECK(not_below["claim"]["answer"] == "above");
  CHECK(not_below["claim"]["holds"] == false);
  const auto open = rates({"--until-below", "0.4", "--indifference", "0.1", "--runs", "3"}, 4);
  CHECK(open["claim"]["answer"] == "undecided");
  CHECK(open["claim"]["holds"].is_null());
  const auto text = cli.parallax(
      {"rates", "edge.yaml", "--until-below", "0.4", "--indifference", "0.1", "--runs", "3"});
  CHECK(text.out.find("undecided between below 40 % and above 30 %") != std::string::npos);
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"--indifference", "0.1"},
        {"--until-below", "0.1", "--indifference", "0.1"},
        {"--until-above", "0.95", "--indifference", "0.1"},
        {"--until-below", "0.5", "--until-above", "0.2", "--indifference", "0.1"}}) {
    std::vector<std::string> words = {"rates", "edge.yaml"};
    words.insert(words.end(), wrong.begin(), wrong.end());
    const auto result = cli.parallax(words);
    CHECK(result.code == 2);
    CHECK(result.err.find("--indifference") != std::string::npos);
  }
}

/// The column of a table with these names in its first line.
std::vector<double> column(const std::string& csv, const std::string& name) {
  std::vector<std::vector<std::string>> rows;
  std::size_t at = 0;
  while (at < csv.size()) {
    const auto end = csv.find('\n', at);
    rows.emplace_back();
    for (std::size_t from = at; from <= end;) {
      const auto comma = std::min(csv.find(',', from), end);
      rows.back().push_back(csv.substr(from, comma - from));
      from = comma + 1;
    }
    at = end + 1;
  }
  std::vector<double> out;
  for (std::size_t c = 0; c < rows.front().size(); ++c) {
    if (rows.front()[c] != name) continue;
    for (std::size_t r = 1; r < rows.size(); ++r) out.push_back(std::stod(rows[r][c]));
  }
  return out;
}

TEST_CASE("means, quantiles and outcomes are those of the table of simulations") {
  const CliFixture cli;
  const auto result =
      json_of(cli, {"rates", "edge.yaml", "--runs", "20", "--mean", "duration", "--mean", "0.goal",
                    "--mean", "goal", "--outcomes", "--samples", "edge.csv"});
  const auto csv = cli.read("edge.csv");
  const auto& trace = result["traces"][0];
  REQUIRE(trace["values"].size() == 3);
  const auto check = [&](const Json& value, std::vector<double> expected) {
    CAPTURE(value.dump());
    REQUIRE(expected.size() == 20);
    std::sort(expected.begin(), expected.end());
    double sum = 0.0;
    for (const double one : expected) sum += one;
    CHECK(value["runs"] == 20);
    CHECK(value["without"] == 0);
    CHECK(value["lost"] == 0);
    CHECK(value["mean"]["value"].get<double>() == doctest::Approx(sum / 20));
    CHECK(value["mean"]["interval"] == "student-t");
    CHECK(value["least"] == expected.front());
    CHECK(value["most"] == expected.back());
    const auto& median = value["quantiles"][1];
    CHECK(median["probability"] == 0.5);
    CHECK(median["value"] == expected[9]);
    // P(Bin(20, 1/2) <= 5) = 0.0207 is the largest tail within 0.025: the 6th and 15th values.
    CHECK(binomial_cdf(5, 20, 0.5) <= 0.025);
    CHECK(binomial_cdf(6, 20, 0.5) > 0.025);
    CHECK(median["lower"] == expected[5]);
    CHECK(median["upper"] == expected[14]);
    CHECK(value["quantiles"][0]["lower"].is_null());
  };
  check(trace["values"][0], column(csv, "sim_time_s"));
  const auto first = column(csv, "margin.0.goal"), second = column(csv, "margin.2.goal");
  check(trace["values"][1], first);
  std::vector<double> least;
  for (std::size_t i = 0; i < first.size(); ++i) least.push_back(std::min(first[i], second[i]));
  check(trace["values"][2], least);
  REQUIRE(trace["samples"].size() == 20);
  int failures = 0;
  for (const auto& sample : trace["samples"])
    failures += sample["outcome"] == "discrepancy" ? 1 : 0;
  CHECK(failures == trace["any"]["count"]);
  CHECK(trace["samples"][0]["start"] != trace["samples"][1]["start"]);

  const auto text = cli.parallax({"rates", "edge.yaml", "--runs", "6", "--mean", "duration"});
  CHECK(text.out.find("duration [s] in 6 runs") != std::string::npos);
  CHECK(text.out.find("Student's t, approximate") != std::string::npos);
  const auto none = cli.parallax({"rates", "edge.yaml", "--runs", "2", "--mean", "gaol"});
  CHECK(none.code == 2);
  CHECK(none.out.find("gaol: no run reported it") != std::string::npos);
  CHECK(none.err.find("there is `duration`, and of margins goal, grasp_offset") !=
        std::string::npos);
  CHECK(cli.parallax({"rates", "edge.yaml", "--mean", "goal", "--until-width", "0.2"}).code == 2);
  // Nobody asked: nothing is added.
  const auto plain = json_of(cli, {"rates", "edge.yaml", "--runs", "2"})["traces"][0];
  CHECK_FALSE(plain.contains("values"));
  CHECK_FALSE(plain.contains("samples"));
}

TEST_CASE("counts by cause add up to all discrepancies, the most frequent first") {
  const CliFixture cli;
  // Box and robot are uniform over a metre each, the arm reaches 0.6 m: out of reach in 82 %. The
  // soft grip loses some of the boxes that it reaches.
  cli.replace("wrong_model.yaml", "include: common.yaml",
              "include: common.yaml\nworld: {friction: {box-pad: 0}}");
  const auto result = json_of(cli, {"rates", "wrong_model.yaml", "--runs", "60"});
  CHECK(result["status"] == "ok");
  CHECK(result["complete"] == true);
  REQUIRE(result["traces"].size() == 1);
  const auto& trace = result["traces"][0];
  CHECK(trace["runs"] == 60);
  CHECK(trace["lost"] == 0);
  CHECK(trace["events"] == "PickUp() Go(r1) Place(r1)");
  REQUIRE(trace["causes"].size() == 2);
  int sum = 0, before = 60;
  for (const auto& cause : trace["causes"]) {
    const int count = cause["count"];
    CHECK(count > 0);
    CHECK(count <= before);
    before = count;
    sum += count;
    CHECK(cause["example"].get<int>() >= 1);
    CHECK(cause["start"].contains("robot.x"));
    CHECK(cause["example"].get<int>() <= 60);
    check_interval(cause, 60, 0.95);
  }
  CHECK(trace["any"]["count"] == sum);
  CHECK(sum == 60);  // without friction nothing is ever held
  CHECK(trace["causes"][0]["cause"] == "PickUp(): out of reach");
}

TEST_CASE("a rate that geometry gives lies within its interval") {
  const CliFixture cli;
  const auto result = json_of(
      cli, {"rates", "wrong_model.yaml", "--runs", "80", "--confidence", "0.999", "--jobs", "2"});
  CHECK(result["confidence"] == 0.999);
  const auto& any = result["traces"][0]["any"];
  check_interval(any, 80, 0.999);
  CHECK(any["lower"].get<double>() < 0.82);
  CHECK(any["upper"].get<double>() > 0.82);
}

TEST_CASE("intervals of no and of nothing but discrepancies end at zero and at one") {
  const CliFixture cli;
  const auto clean = json_of(cli, {"rates", "scenario.yaml", "--runs", "6"})["traces"][0];
  CHECK(clean["any"]["count"] == 0);
  CHECK(clean["causes"].empty());
  check_interval(clean["any"], 6, 0.95);
  CHECK(clean["any"]["upper"].get<double>() == doctest::Approx(1 - std::pow(0.025, 1.0 / 6)));
  cli.replace("common.yaml", "include: world.yaml",
              "include: world.yaml\n  friction: {box-pad: 0}");
  const auto failing = json_of(cli, {"rates", "scenario.yaml", "--runs", "6"})["traces"][0];
  CHECK(failing["any"]["count"] == 6);
  check_interval(failing["any"], 6, 0.95);
  CHECK(failing["any"]["upper"] == 1.0);
}

TEST_CASE("nothing that is printed depends on the number of jobs") {
  const CliFixture cli;
  for (const bool json : {false, true}) {
    std::vector<std::string> printed;
    for (const auto* jobs : {"1", "2"}) {
      std::vector<std::string> words = {"rates", "wrong_model.yaml", "--runs",
                                        "10",    "--jobs",           jobs};
      if (json) words.emplace_back("--json");
      printed.push_back(cli.parallax(words).out);
    }
    CHECK(printed[0].size() > 100);
    CHECK(printed[0] == printed[1]);
  }
}

TEST_CASE("sample N is simulation N of a run with the same seed") {
  const CliFixture cli;
  for (const auto* seed : {"1", "5"}) {
    CAPTURE(seed);
    const auto run =
        json_of(cli, {"run", "edge.yaml", "--seed", seed, "--out", std::string("run") + seed}, 1);
    const auto first = run["discrepancies"][0]["sample"];
    const auto counted = json_of(
        cli, {"rates", "edge.yaml", "--seed", seed, "--runs", std::to_string(first.get<int>())});
    CHECK(counted["traces"][0]["any"]["count"] == 1);
    CHECK(counted["traces"][0]["causes"][0]["example"] == first);
  }
}

TEST_CASE("--trace picks one of the traces and changes nothing about it") {
  const CliFixture cli;
  cli.replace("start.e", "HoldsAt(BoxIn(r2),0).\n", "!HoldsAt(Holding(),0).\n");
  cli.replace("wrong_model.yaml", "plan: hasty.lisp", "plan: either.lisp");
  cli.write("either.lisp", R"((defun pose-at (?x)
  (make-pose-stamped "map" 0.0 (make-3d-vector ?x 0 0) (make-identity-rotation)))
(def-cram-function fetch ()
  (when (holds '(box-in r2))
    (let ((?there (pose-at 1.2)))
      (perform (a motion (type going) (pose ?there)))))
  (perform (an action (type picking-up) (object (an object (name box)))))
  (let ((?here (pose-at 0.5)))
    (perform (a motion (type going) (pose ?here)))
    (perform (an action (type placing) (object (an object (name box)))
                        (target (a location (pose ?here)))))))
(fetch)
)");
  const auto all = json_of(cli, {"rates", "wrong_model.yaml", "--runs", "4"});
  REQUIRE(all["traces"].size() == 2);
  for (int number = 1; number <= 2; ++number) {
    const auto one = json_of(
        cli, {"rates", "wrong_model.yaml", "--runs", "4", "--trace", std::to_string(number)});
    REQUIRE(one["traces"].size() == 1);
    CHECK(one["complete"] == true);
    CHECK(one["traces"][0] == all["traces"][static_cast<std::size_t>(number - 1)]);
  }
  const auto none = cli.parallax({"rates", "wrong_model.yaml", "--runs", "4", "--trace", "3"});
  CHECK(none.code == 2);
  CHECK(none.out.empty());
  CHECK(none.err.find("there is no trace 3: the scenario has 2") != std::string::npos);
}

TEST_CASE("starts that interpenetrate are drawn again, and counted") {
  const CliFixture cli;
  // A post over the fifth of the lane, but for the 7 cm of the box.
  cli.replace("common.yaml", "include: world.yaml",
              "include: world.yaml\n  bodies: {post: {size_m: [0.13, 0.07, 0.07], mass_kg: 0, "
              "material: steel, position_m: [1.5, 0, 0.035]}}");
  const auto trace = json_of(cli, {"rates", "wrong_model.yaml", "--runs", "40"})["traces"][0];
  CHECK(trace["runs"] == 40);
  // Negative binomial with p = 0.2: 10 expected, with a standard deviation of 3.5.
  CHECK(trace["rejected"].get<int>() >= 1);
  CHECK(trace["rejected"].get<int>() <= 28);
}

TEST_CASE("a limit or a signal leaves a partial result that says so") {
  const CliFixture cli;
  const auto limited =
      json_of(cli, {"rates", "scenario.yaml", "--runs", "100000", "--time-limit", "5"}, 4);
  CHECK(limited["complete"] == false);
  CHECK(limited["traces"][0]["runs"].get<int>() < 100'000);
  CHECK(limited["traces"][0]["any"]["count"] == 0);

  for (const int signal : {SIGINT, SIGTERM}) {
    ProcessOptions options;
    int looks = 0;
    options.signal_when = [&] { return ++looks > 100 ? signal : 0; };
    const auto stopped = cli.parallax({"rates", "scenario.yaml", "--runs", "100000"}, options);
    CHECK(stopped.code == 128 + signal);
  }
}

TEST_CASE("a search that is stopped does not say that there is no trace") {
  const CliFixture cli;
  const auto plan = std::string(PARALLAX_SOURCE_DIR) + "/scenarios/kitchen/plan1.yaml";
  for (const auto* limit : {"0.001", "0.01", "0.03", "0.1", "0.2"}) {
    for (const std::string command : {"rates", "run"}) {
      CAPTURE(command);
      CAPTURE(limit);
      const auto result = cli.parallax({command, plan, "--time-limit", limit});
      // A fast machine finds the carton that slips in less.
      const bool has_found = command == "run" && result.code == 1;
      CHECK((has_found || result.code == 4));
      if (has_found) CHECK(result.out.find("Holding(left,milk1)") != std::string::npos);
      CHECK(result.err.find("meets the state constraints") == std::string::npos);
    }
  }
}

TEST_CASE("what cannot be estimated is told with its exit code") {
  const CliFixture cli;
  const auto complains = [&](const std::vector<std::string>& words, int code,
                             const std::string& part) {
    auto arguments = words;
    arguments.insert(arguments.begin(), "rates");
    const auto result = cli.parallax(arguments);
    CAPTURE(result.err);
    CHECK(result.code == code);
    CHECK((result.err + result.out).find(part) != std::string::npos);
  };
  complains({"missing.yaml"}, 2, "missing.yaml");
  complains({"scenario.yaml", "--runs", "0"}, 2, "--runs");
  complains({"scenario.yaml", "--runs", "ten"}, 2, "--runs");
  complains({"scenario.yaml", "--confidence", "1"}, 2, "--confidence");
  complains({"scenario.yaml", "--jobs", "0"}, 2, "--jobs");
  complains({"scenario.yaml", "--job", "2"}, 2, "--jobs");

  cli.replace("edge.yaml", "horizon: 6", "horizon: 2");
  complains({"edge.yaml"}, 1, "no trace");
  const auto none = json_of(cli, {"rates", "edge.yaml"}, 1);
  CHECK(none["traces"].empty());

  cli.replace("wrong_model.yaml", "constraints:\n", "limits: {max_runs: 5}\n#");
  cli.replace("wrong_model.yaml", "  - \"{region}", "#");
  complains({"wrong_model.yaml"}, 3, "needs `constraints`");
  cli.write("broken.yaml", "name: [");
  complains({"broken.yaml"}, 3, "broken.yaml:1:");
}

}  // namespace
}  // namespace parallax::test
