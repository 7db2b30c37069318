// A condition that is a disjunction: indoor places are fine, and outdoor ones need an open door.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

class Garden : public CliFixture {
 public:
  Garden() {
    write("words.e",
          "sort spot\nspot dock, roses, ferns\npredicate Outside(spot)\n"
          "fluent At(spot)\nfluent DoorOpen()\nevent Drive(spot)\n"
          "[spot] Outside(spot) <-> spot=ferns.\n"
          "[spot1,spot2,time] HoldsAt(At(spot1),time) & HoldsAt(At(spot2),time) -> spot1=spot2.\n"
          "[time] {spot} HoldsAt(At(spot),time).\n");
    write("model.e", "load words.e\n\n" + driving(""));
    write("truth.e", "load words.e\n" + driving("(!Outside(spot1) | HoldsAt(DoorOpen(),time))"));
    write("start.e", "HoldsAt(At(dock),0).\n");
    write("robot.bind",
          "motion driving (:to name ?s) -> Drive(?s)  ok: At(?s) @t+1 "
          "else navigation-pose-unreachable\n");
    write("tour.lisp",
          "(def-cram-function tour ()\n  (dolist (?spot '(:roses :ferns :dock))\n"
          "    (perform (a motion (type driving) (to (an object (name ?spot)))))))\n(tour)\n");
    scenario("own.yaml", "model.e");
    scenario("truth.yaml", "truth.e");
  }

 private:
  static std::string driving(const std::string& condition) {
    const auto also = condition.empty() ? "" : condition + " & ";
    const auto only = condition.empty() ? "" : condition + " -> ";
    return "[spot1,time] " + only + "Initiates(Drive(spot1),At(spot1),time).\n" +
           "[spot1,spot2,time] " + also +
           "spot1!=spot2 -> Terminates(Drive(spot1),At(spot2),time).\n";
  }
  void scenario(const std::string& name, const std::string& model) const {
    write(name, "model: [" + model +
                    ", start.e]\nsimulator: {model: truth.e}\nplan: tour.lisp\nbind: robot.bind\n"
                    "horizon: 4\nexecution: closed-loop\n");
  }
};

TEST_CASE("one of two is enough: proposed before anything is left open, and right") {
  const Garden cli;
  json_of(cli, {"run", "own.yaml", "--keep-going", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  const auto& first = report.at("proposals").at(0);
  CAPTURE(report.dump(1));
  CHECK(first.at("words") ==
        "`Drive(spot)` does what its 2 axioms say only if `!Outside(spot) | "
        "HoldsAt(DoorOpen(),time)`");
  CHECK(first.at("runs_to_the_end") == report.at("runs"));
  CHECK(cli.parallax({"repair", "out", "--apply", "1"}).code == 0);
  // As the world is.
  const auto diff = cli.parallax({"diff", "truth.yaml", "own.yaml", "--json"});
  const auto traces = nlohmann::json::parse(diff.out).at("traces");
  CAPTURE(cli.read("model.e"));
  CHECK(traces.at("lost").at("answer") == "none");
  CHECK(traces.at("gained").at("answer") == "none");
}

TEST_CASE("a definition that is wrong is mended, and explain names it") {
  const Garden cli;
  cli.write("words.e", cli.read("words.e") + "fluent Home()\nnoninertial Home\n");
  const std::string is_home = "[time] HoldsAt(Home(),time) <-> ";
  cli.write("truth.e", cli.read("truth.e") + is_home + "HoldsAt(At(dock),time).\n");
  cli.write("model.e", cli.read("truth.e"));
  cli.replace("model.e", is_home + "HoldsAt(At(dock),time)",
              is_home + "HoldsAt(At(dock),time) | HoldsAt(At(roses),time)");
  json_of(cli, {"run", "own.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  CAPTURE(report.dump(1));
  const std::string words = report.at("proposals").at(0).at("words");
  CHECK(words.ends_with("without `HoldsAt(At(roses),time)`"));
  CHECK(cli.parallax({"explain", "out"}).out.find("HoldsAt(Home(),time) <->") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
