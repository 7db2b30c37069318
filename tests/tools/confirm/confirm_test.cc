// `parallax confirm` and `parallax threshold`: with a simulator behind the protocol whose failures
// are known, and in physics.

#include "tools/confirm/confirm.h"

#include <sys/stat.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>

#include "tests/support/random.h"
#include "tests/tools/cli_json.h"
#include "tests/tools/confirm/border_world.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

Json parameter_of(const Json& told, const std::string& name) {
  for (const auto& parameter : told.at("parameters")) {
    if (parameter.at("parameter") == name) return parameter;
  }
  FAIL("no such parameter");
  return {};
}

/// Between its values, the border lies.
void check_holds(const Json& border, double value, double tolerance) {
  const double fails = border.at("fails_at"), other = border.at("not_at");
  CHECK(std::min(fails, other) <= value);
  CHECK(value <= std::max(fails, other));
  CHECK(std::abs(fails - other) <= tolerance);
}

TEST_CASE("thresholds that are known: who decides, and brackets that hold them") {
  const BorderWorld cli({"fails:cup.a>0.7,cup.b<3,box.x<3.4"});
  const auto told = cli.confirm(1);
  CAPTURE(told.dump());
  CHECK(told.at("verdict") == "confirmed");
  CHECK(told.at("again").at("bit_equal") == true);
  CHECK(told.at("other_seeds") == Json{{"runs", 5}, {"failures", 5}, {"share", 1.0}});
  CHECK(told.at("half_step").is_null());  // whose step is not ours
  CHECK(told.at("middle") == "clean");
  CHECK(parameter_of(told, "cup.a").at("role") == "decides");
  CHECK(parameter_of(told, "box.x").at("role") == "decides");
  CHECK(parameter_of(told, "cup.b").at("role") == "indifferent");  // 0 is below 3, too
  CHECK(parameter_of(told, "cup.c").at("role") == "indifferent");
  CHECK(std::abs(parameter_of(told, "cup.c").at("shrunk").get<double>() - 0.5) < 1e-9);
  CHECK(told.at("parameters").size() == 4);  // cup.d has one value
  check_holds(parameter_of(told, "cup.a").at("border"), 0.7, 0.01);
  check_holds(parameter_of(told, "box.x").at("border"), 3.4, 0.01);
  // On the line through the recorded start there is another border, which confirm has no word for.
  const auto line = cli.threshold("cup.b", 0, {"--tolerance", "1e-5"});
  REQUIRE(line.at("borders").size() == 1);
  check_holds(line.at("borders").at(0), 3.0, 1e-5);
  CHECK(cli.threshold("cup.c").at("borders").empty());
}

TEST_CASE("random worlds: what is told is what the rule says") {
  Random random(7);
  const Words names = {"box.x", "cup.a", "cup.b", "cup.c"};
  const double lower[] = {3.0, 0.0, -10.0, 0.0}, upper[] = {4.0, 1.0, 10.0, 1.0};
  for (int round = 0; round < 8; ++round) {
    std::string rule;
    double threshold[4] = {};
    int side[4] = {};
    for (std::size_t p = 0; p < 4; ++p) {
      side[p] = round == 0 ? 0 : static_cast<int>(random.below(3)) - 1;
      const double share = 0.2 + 0.6 * (random.below(1000) / 1000.0);
      threshold[p] = lower[p] + share * (upper[p] - lower[p]);
      if (side[p] == 0) continue;
      rule += (rule.empty() ? "" : ",") + names[p] + (side[p] > 0 ? ">" : "<") +
              std::to_string(threshold[p]);
    }
    if (rule.empty()) rule = "always";
    CAPTURE(rule);
    const BorderWorld cli({"fails:" + rule}, 1, {"--epsilon", "0.005"});
    const auto told = cli.confirm(1, {"--jobs", std::to_string(1 + round % 3)});
    for (std::size_t p = 0; p < 4; ++p) {
      const double middle = 0.5 * (lower[p] + upper[p]);
      const bool decides =
          (side[p] > 0 && middle <= threshold[p]) || (side[p] < 0 && middle >= threshold[p]);
      const auto parameter = parameter_of(told, names[p]);
      CHECK(parameter.at("role") == (decides ? "decides" : "indifferent"));
      if (decides) check_holds(parameter.at("border"), threshold[p], 0.011 * (upper[p] - lower[p]));
    }
  }
}

TEST_CASE("the number of jobs shows nowhere; what is on record is not simulated again") {
  const BorderWorld cli({"fails:cup.a>0.7,box.x<3.4"});
  const auto journal = cli.read("out/journal.ndjson");
  const auto told = cli.confirm(1);
  const auto line = cli.threshold("cup.a");
  const auto files = files_below(cli.folder() / "out");
  CHECK(cli.read("out/journal.ndjson") == journal);
  const auto runs = cli.runs();
  CHECK(cli.confirm(1) == told);
  CHECK(cli.threshold("cup.a") == line);
  CHECK(cli.runs() == runs);
  CHECK(files_below(cli.folder() / "out") == files);
  for (const auto* name : {"confirm", "same_start"}) fs::remove_all(cli.folder() / "out" / name);
  CHECK(cli.confirm(1, {"--jobs", "3"}) == told);
  CHECK(cli.threshold("cup.a", 0, {"--jobs", "3"}) == line);
  CHECK(files_below(cli.folder() / "out") == files);
  // The run goes on as if nothing had been.
  CHECK(cli.parallax({"run", "s.yaml", "--out", "out", "--resume"}).code == 1);
  CHECK(cli.read("out/journal.ndjson") == journal);
  CHECK(cli.parallax({"explain", "out", "--runs", "0"}).code == 1);
}

TEST_CASE("a budget that is too small: the best bracket so far, and exit code 4; then it goes on") {
  const BorderWorld cli({"fails:cup.a>0.7"});
  const auto whole = cli.threshold("cup.a", 0, {"--tolerance", "1e-4"});
  fs::remove_all(cli.folder() / "out" / "confirm");
  const auto needed = whole.at("simulations").get<int>();
  for (const int runs : {1, 3, 7, 10}) {
    const auto told =
        cli.threshold("cup.a", 4, {"--tolerance", "1e-4", "--runs", std::to_string(runs)});
    CHECK(told.at("finished") == false);
    CHECK(told.at("ended_by") == "runs");
    CHECK(told.at("simulations") == runs);
    if (runs < 6) continue;
    REQUIRE(told.at("borders").size() == 1);
    check_holds(told.at("borders").at(0), 0.7, 1.0);
    CHECK(told.at("borders").at(0).at("narrow") == false);
  }
  const auto before = cli.runs();
  CHECK(cli.threshold("cup.a", 0, {"--tolerance", "1e-4"}) == whole);
  CHECK(cli.runs() == before + needed - 10);
  const auto few = cli.parallax({"confirm", "out", "--runs", "4", "--allow-commands"});
  CHECK(few.code == 4);
  CHECK(has(few.out, "It ended at 4 starts (--runs)"));
}

TEST_CASE("what a seed decides is in doubt, and so is what does not repeat") {
  const BorderWorld seeded({"fails:seed%3"});
  auto told = seeded.confirm(4, {"--repeats", "40"});
  // With three seeds of four it is confirmed in part, and moved, as the simulator repeats itself.
  const BorderWorld often({"fails:cup.a>0.7,seed%2", "fails:cup.a>0.7,seed%3",
                           "fails:cup.a>0.7,seed%5", "fails:cup.a>0.7,seed%7"});
  auto part = often.confirm(1, {"--repeats", "40"});
  CHECK(part.at("verdict") == "partly");
  CHECK(part.at("again").at("bit_equal") == true);
  check_holds(parameter_of(part, "cup.a").at("border"), 0.7, 0.01);
  CHECK(has(part.dump(), "Not every repetition shows it"));
  CHECK(json_of(often, {"explain", "out", "--runs", "0"}, 1).count("borders") == 0);
  CHECK(told.at("verdict") == "seed");
  CHECK(told.at("again").at("bit_equal") == true);
  CHECK(told.at("other_seeds").at("runs") == 40);
  CHECK(told.at("other_seeds").at("failures") < 20);
  CHECK(told.at("middle").is_null());  // nothing was moved
  CHECK(has(told.at("sentences").at(0), "It is in doubt: with most seeds it does not happen"));

  // It takes no seed, and every second run goes wrong.
  const BorderWorld noisy({"fails:run%2", "unseeded"});
  told = noisy.confirm(1, {"--repeats", "10", "--jobs", "1"});
  CHECK(told.at("again").at("verdict") == "fails");  // the fourth run, as it happens
  CHECK(told.at("other_seeds").at("failures") == 5);
  CHECK(told.at("verdict") == "partly");
  CHECK(told.at("middle").is_null());  // else chance would be taken for a parameter
  const auto text = noisy.parallax({"confirm", "out", "--allow-commands"});
  CHECK(text.code == 4);
  CHECK(has(text.out, "the simulator takes no seeds"));
  // Not bit for bit the same, but the same discrepancy.
  const BorderWorld drifting({"fails:cup.a>0.7", "drifts:always", "loose"});
  told = drifting.confirm(1);
  CHECK(told.at("again").at("verdict") == "fails");
  CHECK(told.at("again").at("bit_equal") == false);
  CHECK(told.at("again").at("difference").at("variable") == "box.x");
  CHECK(has(told.dump(), "Not every repetition shows it"));
  check_holds(parameter_of(told, "cup.a").at("border"), 0.7, 0.01);
  CHECK(has(drifting.threshold("cup.a").dump(), "does not promise to repeat itself"));
}

TEST_CASE("repetitions of which none tells confirm nothing") {
  tools::Confirmation told;
  told.repeats = 5;
  told.repeated = harness::StartVerdict::kFails;
  told.other_seeds = harness::Persistence{5, 5};
  told.half_step = harness::Persistence{5, 5};
  CHECK(told.verdict() == tools::ConfirmVerdict::kConfirmed);
  told.half_step = harness::Persistence{5, 1};
  CHECK(tools::standing_of(told).is == harness::Standing::kInDoubt);
  CHECK(tools::standing_of(told).words ==
        "in doubt: it happens in 5 of 5 runs with other seeds and in 1 of 5 with half the step");
  told.half_step = harness::Persistence{0, 0};  // each was lost
  CHECK(tools::standing_of(told).words == "confirmed: it happens in 5 of 5 runs with other seeds");
  CHECK(told.verdict() == tools::ConfirmVerdict::kPartly);
  CHECK(!told.may_move());
  CHECK(has(tools::confirm_text(told, "out"),
            "It repeats; of repetitions with half the step nothing is known."));
  told.repeats_itself = true;
  CHECK(told.may_move());
  told.other_seeds = harness::Persistence{0, 0};
  CHECK(tools::standing_of(told).is == harness::Standing::kNotAsked);
  told.half_step.reset();
  CHECK(told.verdict() == tools::ConfirmVerdict::kPartly);
  CHECK(has(tools::confirm_text(told, "out"), "of repetitions with other seeds nothing is known"));
}

TEST_CASE("starts that are refused, simulators that are lost, and other things that go wrong") {
  const BorderWorld refusing({"fails:cup.a>0.7", "refuses:cup.a>0.6,cup.a<0.65"});
  auto told = refusing.threshold("cup.a", 4);
  CHECK(told.at("borders").at(0).contains("no_start_at"));
  check_holds(told.at("borders").at(0), 0.7, 1.0);
  told = refusing.threshold("cup.a", 0, {"--points", "40"});  // no midpoint is in the gap
  check_holds(told.at("borders").at(0), 0.7, 0.01);

  const BorderWorld walled({"fails:cup.a>0.9", "refuses:cup.a<0.8"});
  told = walled.confirm(1);
  CHECK(told.at("middle") == "no-start");
  CHECK(parameter_of(told, "cup.a").at("role") == "no-start");
  CHECK(parameter_of(told, "cup.b").at("role") == "indifferent");

  const BorderWorld lost({"fails:cup.a>0.7", "loses:cup.a<0.55,cup.a>0.45"});
  told = lost.confirm(1);
  CHECK(told.at("middle") == "no-start");

  const BorderWorld other({"fails:cup.a>0.7", "otherwise:cup.a<0.6"}, 1, {"--seed", "6"});
  told =
      other.parallax({"run", "s.yaml", "--out", "all", "--keep-going", "--max-runs", "40"}).code ==
              1
          ? Json::parse(other.read("all/report.json"))
          : Json();
  // One that goes wrong in the push; beyond its border another thing goes wrong.
  for (const auto& found : told.at("discrepancies")) {
    if (found.at("first_divergence") != 2) continue;
    const auto id = "1." + std::to_string(found.at("sample").get<int>());
    const auto border = json_of(other, {"threshold", "all", "--parameter", "cup.a", "--sample", id,
                                        "--points", "2", "--allow-commands"})
                            .at("borders");
    REQUIRE(border.size() == 1);
    check_holds(border.at(0), 0.7, 0.01);
    break;
  }
}

TEST_CASE("two borders on one line are both found where the values lie close enough") {
  const BorderWorld cli({"fails:cup.a>0.2,cup.a<0.3", "fails:cup.a>0.8"}, 1, {"--seed", "3"});
  const auto told = cli.threshold("cup.a", 0, {"--points", "21", "--tolerance", "0.001"});
  REQUIRE(told.at("borders").size() == 3);
  check_holds(told.at("borders").at(0), 0.2, 0.001);
  check_holds(told.at("borders").at(1), 0.3, 0.001);
  check_holds(told.at("borders").at(2), 0.8, 0.001);
}

TEST_CASE("what is asked wrongly is said, and nothing is simulated") {
  const BorderWorld cli({"fails:cup.a>0.7"});
  const auto runs = cli.runs();
  const auto refused = [&](Words words, int code, const char* part) {
    const auto result = cli.parallax(std::move(words));
    CAPTURE(result.err);
    CHECK(result.code == code);
    CHECK(has(result.err, part));
  };
  const std::string allow = "--allow-commands";
  refused({"threshold", "out", "--parameter", "cup.q", allow}, 2, "replace `cup.q` with `cup.a`");
  refused({"threshold", "out", "--parameter", "cup.d", allow}, 2, "has one value in every start");
  refused({"threshold", "out", "--parameter", "cup.a", "--tolerance", "0", allow}, 2,
          "--tolerance");
  refused({"threshold", "out", "--parameter", "cup.a", "--tolerance", "nan", allow}, 2,
          "--tolerance");
  refused({"threshold", "out", "--parameter", "cup.a", "--points", "1", allow}, 2, "--points");
  refused({"threshold", "out", allow}, 2, "--parameter");
  refused({"confirm", "out", "--runs", "0", allow}, 2, "--runs");
  refused({"confirm", "out"}, 2, "--allow-commands");
  refused({"confirm", "out", "--sample", "9.9", allow}, 2, "9.9");
  refused({"confirm", "nowhere", allow}, 2, "nowhere");
  refused({"confirm", "s.yaml", allow}, 3, "s.yaml");
  CHECK(cli.runs() == runs);
  cli.write("domain.e", cli.read("domain.e") + "; changed\n");
  std::filesystem::remove(cli.folder() / "out/inputs.json");
  refused({"confirm", "out", allow}, 3, "has changed: its hash was");
  CHECK(cli.runs() == runs);

  const BorderWorld clean({"fails:cup.a>5"}, 0);
  const auto nothing = clean.parallax({"confirm", "out", allow});
  CHECK(nothing.code == 0);
  CHECK(has(nothing.out, "found no discrepancy"));
  CHECK(clean.threshold("cup.a").at("verdict") == "no-discrepancy");
}

TEST_CASE("a folder that says what was not simulated is not believed") {
  const BorderWorld cli({"fails:cup.a>0.7"});
  const auto told = cli.confirm(1);
  const auto journal = cli.read("out/confirm/journal.ndjson");
  // Damaged findings are as none; a foreign line of the journal has its place.
  for (const auto* text : {"", "{", "[]", "{\"sentences\": 3}"}) {
    cli.write("out/confirm/confirm.json", text);
    CHECK(cli.parallax({"report", "out"}).code == 0);
    CHECK_FALSE(has(cli.read("out/report.html"), "repeated, and its start moved"));
    CHECK(json_of(cli, {"explain", "out", "--runs", "0"}, 1).count("borders") == 0);
  }
  CHECK(cli.confirm(1) == told);
  cli.write("out/confirm/journal.ndjson", journal + "{}\n");
  const auto foreign = cli.parallax({"confirm", "out", "--allow-commands"});
  CHECK(foreign.code == 3);
  CHECK(has(foreign.err, "confirm/journal.ndjson:"));
  // An incomplete last line, as of a killed process, is simulated again.
  cli.write("out/confirm/journal.ndjson", journal.substr(0, journal.size() - 40));
  CHECK(cli.parallax({"confirm", "out", "--allow-commands", "--json"}).code == 1);
  CHECK(cli.confirm(1) == told);
  CHECK(cli.read("out/confirm/journal.ndjson") == journal);
}

TEST_CASE("a folder that cannot be written, or leads elsewhere, and a run that is interrupted") {
  const BorderWorld cli({"fails:cup.a>0.7"});
  const auto confirm = [&] { return cli.parallax({"confirm", "out", "--allow-commands"}); };
  fs::create_directory(cli.folder() / "elsewhere");
  fs::create_directory_symlink("../elsewhere", cli.folder() / "out" / "confirm");
  CHECK(confirm().code == 2);
  CHECK(fs::is_empty(cli.folder() / "elsewhere"));
  fs::remove(cli.folder() / "out" / "confirm");
  cli.write("out/confirm", "a file\n");
  CHECK(confirm().code == 2);
  fs::remove(cli.folder() / "out" / "confirm");

  // A signal in the middle: finished simulations are found the next time.
  const BorderWorld whole({"fails:cup.a>0.7"});
  const auto told = whole.threshold("cup.a", 0, {"--tolerance", "1e-9"});
  ProcessOptions options;
  options.signal_when = [&] { return cli.runs() > 15 ? SIGTERM : 0; };
  const auto stopped = cli.parallax(
      {"threshold", "out", "--parameter", "cup.a", "--tolerance", "1e-9", "--allow-commands"},
      options);
  CHECK((stopped.code == 143 || stopped.code == 0));  // it may have been faster
  CHECK(cli.threshold("cup.a", 0, {"--tolerance", "1e-9"}) == told);
}

TEST_CASE("executions of a plan begin elsewhere, and the plan goes on from there") {
  const TwoModels cli;
  // A world that is a model: its starts have no width, and its open outcomes are distinguished.
  REQUIRE(cli.parallax({"run", "two/unparks.yaml", "--out", "out"}).code == 1);
  auto told = json_of(cli, {"confirm", "out"}, 1);
  CHECK(told.at("verdict") == "confirmed");
  CHECK(told.at("parameters").empty());
  REQUIRE(cli.parallax({"run", "two/sticks.yaml", "--out", "sticks", "--seed", "5"}).code == 1);
  told = json_of(cli, {"confirm", "sticks", "--repeats", "30"}, 4);
  CHECK(told.at("other_seeds").at("failures") < 15);
  CHECK(told.at("verdict") == "seed");
  CHECK(has(told.at("sentences").at(0), "the world's model leaves the outcome open"));
}

TEST_CASE(
    "in physics: the border of a box that is put down at the edge, for traces and executions") {
  const CliFixture cli;
  for (const auto* execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const std::string out = execution;
    REQUIRE(cli.parallax({"run", "edge.yaml", "--execution", execution, "--out", out}).code == 1);
    CHECK(json_of(cli, {"explain", out, "--runs", "0"}, 1).at("cause") == "unknown");
    const auto told = json_of(cli, {"confirm", out, "--jobs", "2", "--repeats", "2"}, 1);
    CAPTURE(told.dump());
    CHECK(told.at("verdict") == "confirmed");
    CHECK(told.at("again").at("bit_equal") == true);
    CHECK(told.at("half_step").at("runs") == 2);
    CHECK(parameter_of(told, "box.x").at("role") == "decides");
    CHECK(parameter_of(told, "robot.x").at("role") == "indifferent");
    // Both ends, simulated by `threshold` from another start: on their sides as well.
    const auto border = parameter_of(told, "box.x").at("border");
    CHECK(border.at("fails_at") > border.at("not_at"));
    CHECK(border.at("narrow") == true);
    const auto line = json_of(cli, {"threshold", out, "--parameter", "box.x", "--jobs", "2"});
    REQUIRE(line.at("borders").size() == 1);
    const double a = border.at("fails_at"), b = line.at("borders").at(0).at("fails_at");
    CHECK(std::abs(a - b) < 0.05);
    // One discrepancy, and the results of moving it, are enough for the kind of cause.
    const auto why = json_of(cli, {"explain", out}, 1);
    CHECK(why.at("cause") == "region");
    CHECK(why.at("borders").at(0).at("parameter") == "box.x");
    CHECK(why.at("evidence").at("further") == 0);
    CHECK(has(why.at("cause_words"), "From a failing start it takes `box.x`"));
    REQUIRE(cli.parallax({"report", out}).code == 0);
    CHECK(has(cli.read(out + "/report.html"), "repeated, and its start moved"));
  }
}

}  // namespace
}  // namespace parallax::test
