// `run --provoke`: events that the model allows and the plan does not perform.

#include <algorithm>
#include <filesystem>
#include <set>

#include "tests/tools/repair/mistaken_world.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

std::set<std::string> events_of(const Json& list) {
  std::set<std::string> out;
  for (const auto& each : list) out.insert(each.at("event"));
  return out;
}

const std::string kFromNearby = "[time] Happens(Grasp(),time) -> HoldsAt(Near(),time).\n";
const std::string kOpensOnce = "[time] !HoldsAt(Held(),time) -> Initiates(Push(),Open(),time).\n";

/// Something that can be grasped from nearby only; the plan goes there first.
struct Grasped : MistakenWorld {
  explicit Grasped(const Mistakes& mistakes)
      : MistakenWorld(
            "fluent Near()\nfluent Held()\nfluent Open()\n"
            "event Go()\nevent Grasp()\nevent Push()\nevent Leave()\n"
            "[time] Initiates(Go(),Near(),time).\n"
            "[time] Terminates(Leave(),Near(),time).\n" +
                kFromNearby + kOpensOnce + "[time] Initiates(Grasp(),Held(),time).\n",
            "!HoldsAt(Near(),0).\n!HoldsAt(Held(),0).\n!HoldsAt(Open(),0).\n",
            {{"Go()", "Near()"}, {"Grasp()", "Held()"}}, mistakes) {}
};

TEST_CASE("a missing precondition that the plan does not provoke") {
  const Grasped cli({{kFromNearby, ""}});
  json_of(cli, {"run", "own.yaml", "--out", "clean"}, 0);
  const auto report = json_of(cli, {"run", "own.yaml", "--provoke", "50", "--out", "out"}, 1);
  CAPTURE(report.dump(1));
  CHECK(report.at("verdict") == "no-discrepancy");
  const auto& provoked = report.at("provoked");
  CHECK(events_of(provoked.at("refused")) == std::set<std::string>{"Grasp()"});
  CHECK(provoked.at("otherwise").empty());
  for (const auto& refused : provoked.at("refused")) {
    CHECK(refused.at("changes_nothing") == false);
    CHECK(refused.at("reason") == "not-possible");
    // The world admits the grasp once the robot has gone there.
    const std::vector<std::string> after = refused.at("after");
    CHECK(std::find(after.begin(), after.end(), "Go()") == after.end());
  }
  CHECK(std::filesystem::exists(cli.folder() / "out/provoked/journal.ndjson"));
}

TEST_CASE("a wrong effect of an event that the plan does not perform") {
  const Grasped cli({{kOpensOnce, "[time] Initiates(Push(),Open(),time).\n"}});
  const auto report = json_of(cli, {"run", "own.yaml", "--provoke", "50", "--out", "out"}, 1);
  CAPTURE(report.dump(1));
  const auto& provoked = report.at("provoked");
  CHECK(provoked.at("refused").empty());
  CHECK(events_of(provoked.at("otherwise")) == std::set<std::string>{"Push()"});
  CHECK(provoked.at("otherwise").at(0).at("after") == Json({"Go()", "Grasp()"}));
}

TEST_CASE("nothing is said of a right model, of events at most as many as asked for") {
  const Grasped cli({});
  const auto report = json_of(cli, {"run", "own.yaml", "--provoke", "50", "--out", "out"}, 0);
  CAPTURE(report.dump(1));
  CHECK(report.at("provoked").at("refused").empty());
  CHECK(report.at("provoked").at("otherwise").empty());
  CHECK(report.at("provoked").at("made") == report.at("provoked").at("allowed"));
  CHECK(report.at("provoked").at("made") > 2);
  const auto two = json_of(cli, {"run", "own.yaml", "--provoke", "2", "--out", "two"}, 0);
  CHECK(two.at("provoked").at("made") == 2);
  CHECK(two.at("provoked").at("allowed") == report.at("provoked").at("allowed"));
  const auto plain = json_of(cli, {"run", "own.yaml", "--out", "plain"}, 0);
  CHECK_FALSE(plain.contains("provoked"));
}

TEST_CASE("the text names the event and what came before it") {
  const Grasped cli({{kFromNearby, ""}});
  const auto ended = cli.parallax({"run", "own.yaml", "--provoke", "50", "--out", "out"});
  CHECK(ended.err.find('\x1b') == std::string::npos);  // no progress, as this is no terminal
  CAPTURE(ended.out);
  CHECK(ended.code == 1);
  CHECK(mentions(ended.out, "the world refuses 1:\n    Grasp() at the start: not-possible"));
}

TEST_CASE("a folder that no earlier call made stays as it is") {
  const Grasped cli({{kFromNearby, ""}});
  std::filesystem::create_directories(cli.folder() / "out/provoked");
  cli.write("out/provoked/mine.txt", "kept\n");
  const auto refused = cli.parallax({"run", "own.yaml", "--provoke", "5", "--out", "out"});
  CHECK(refused.code == 2);
  CHECK(mentions(refused.err, "out/provoked, which an earlier call did not make"));
  CHECK(cli.read("out/provoked/mine.txt") == "kept\n");
  CHECK(std::filesystem::exists(cli.folder() / "out/report.json"));
}

TEST_CASE("bodies: a grasp from afar that the model allows") {
  const CliFixture cli;
  const std::string near = "HoldsAt(RobotIn(region),time) & HoldsAt(BoxIn(region),time)";
  auto domain = cli.read("domain.e");
  for (auto at = domain.find(near); at != std::string::npos; at = domain.find(near)) {
    domain.replace(at, near.size(), "HoldsAt(BoxIn(region),time)");
  }
  const std::vector<std::string> run = {"run", "scenario.yaml", "--provoke", "6", "--max-traces",
                                        "1",   "--out",         "out"};
  const auto right = json_of(cli, run, 0);
  CAPTURE(right.dump(1));
  for (const auto& refused : right.at("provoked").at("refused")) {
    CHECK(refused.at("changes_nothing") == true);
  }
  cli.write("domain.e", domain);
  std::filesystem::remove_all(cli.folder() / "out");
  const auto wrong = json_of(cli, run, 1);
  CAPTURE(wrong.dump(1));
  CHECK(wrong.at("verdict") == "no-discrepancy");
  const auto& refused = wrong.at("provoked").at("refused");
  CHECK(std::any_of(refused.begin(), refused.end(), [](const Json& each) {
    return each.at("event") == "PickUp()" && each.at("after").empty() &&
           each.at("changes_nothing") == false;
  }));
}

}  // namespace
}  // namespace parallax::test
