// Uses of interchangeable constants: `traces --up-to-symmetry`, and claims that rest on symmetry,
// which say so.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

std::string numbered(const std::string& letter, int count) {
  std::string out = letter + "1";
  for (int i = 2; i <= count; ++i) out += ", " + letter + std::to_string(i);
  return out;
}

/// A model with at most one bird in a hole, and no bird in two.
std::string holes(int birds, int holes, const std::string& more = "") {
  return "range time 0 1\nsort bird\nsort hole\nbird " + numbered("B", birds) + "\nhole " +
         numbered("H", holes) +
         "\nfluent In(bird,hole)\nevent Fly(bird,hole)\n"
         "[bird,hole,time] Initiates(Fly(bird,hole),In(bird,hole),time).\n"
         "[bird,hole1,hole2,time] HoldsAt(In(bird,hole1),time) & HoldsAt(In(bird,hole2),time) "
         "-> hole1=hole2.\n"
         "[bird1,bird2,hole,time] HoldsAt(In(bird1,hole),time) & HoldsAt(In(bird2,hole),time) -> "
         "bird1=bird2.\n[bird,hole] !HoldsAt(In(bird,hole),0).\n" +
         more;
}

const std::string kAllIn = "[bird] {hole} HoldsAt(In(bird,hole),1).\n";

const std::string kThings =
    "range time 0 1\nsort thing\nthing A, B, C\nfluent Held(thing)\nevent Take(thing)\n"
    "[thing,time] Initiates(Take(thing),Held(thing),time).\n[thing] !HoldsAt(Held(thing),0).\n";

TEST_CASE("no trace: what rests on symmetry says so, and a proof does without") {
  const CliFixture cli;
  cli.write("many.e", holes(14, 13, kAllIn));
  for (const auto& arguments : std::vector<std::vector<std::string>>{
           {"traces", "many.e"}, {"traces", "many.e", "--limit", "1", "--order", "any"}}) {
    const auto found = cli.parallax(arguments);
    CHECK(found.code == 0);
    CHECK(found.out == "0 traces, complete (symmetry, not proof checked)\n");
  }
  CHECK(cli.parallax({"traces", "many.e", "--count"}).out == "0\n");
  const auto counted = json_of(cli, {"traces", "many.e", "--count"}, 0);
  CHECK(counted["traces"] == 0);
  CHECK(counted["proof"] == "none");
  CHECK(counted["symmetry"] == true);
  cli.write("few.e", holes(5, 4, kAllIn));
  CHECK(cli.parallax({"traces", "few.e", "--certify"}).out ==
        "0 traces, complete (proof checked)\n");
}

TEST_CASE("no trace that reaches a goal, and a property that holds") {
  const CliFixture cli;
  cli.write("many.e", holes(13, 12));
  const auto none = cli.parallax(
      {"traces", "many.e", "--limit", "1", "--until", "[bird] {hole} HoldsAt(In(bird,hole),time)"});
  CHECK(none.out == "0 traces, complete up to bound (symmetry, not proof checked)\n");
  const std::string property = "!([bird] {hole} HoldsAt(In(bird,hole),time))";
  CHECK(cli.parallax({"verify", "many.e", "--property", property}).out ==
        "holds up to horizon 1 (symmetry, not proof checked)\n");
  const auto answer = json_of(cli, {"verify", "many.e", "--property", property}, 0);
  CHECK(answer["proof"] == "none");
  CHECK(answer["symmetry"] == true);
  // An easy property is proved.
  cli.write("few.e", holes(4, 3));
  CHECK(cli.parallax({"verify", "few.e", "--property", property}).out ==
        "holds up to horizon 1 (proof checked)\n");
}

TEST_CASE("a goal or a property that names a constant is not lost") {
  const CliFixture cli;
  cli.write("things.e", kThings);
  for (const std::string name : {"A", "B", "C"}) {
    const auto held = "HoldsAt(Held(" + name + "),time)";
    CHECK(cli.parallax({"verify", "things.e", "--property", "!" + held}).code == 1);
    const auto only = held + " & ({thing} !HoldsAt(Held(thing),time))";
    CHECK(cli.parallax({"verify", "things.e", "--property", "!(" + only + ")"}).code == 1);
    CHECK(cli.parallax({"traces", "things.e", "--limit", "1", "--until", only})
              .out.find("+ Held(" + name + ")") != std::string::npos);
    // Two of the four sets of events with this one are exchanged.
    const auto orbits = cli.parallax(
        {"traces", "things.e", "--limit", "0", "--up-to-symmetry", "--until", held, "--count"});
    CHECK(orbits.out == "3 up to symmetry, 4 in all\n");
    CHECK(cli.parallax({"traces", "things.e", "--limit", "0", "--until", held, "--count"}).out ==
          "4\n");
  }
}

TEST_CASE("--up-to-symmetry: one trace of each orbit, and the sizes add up") {
  const CliFixture cli;
  cli.write("things.e", kThings);
  const auto listed = cli.parallax({"traces", "things.e", "--limit", "0", "--up-to-symmetry"});
  CHECK(listed.code == 0);
  CHECK(listed.out.starts_with("trace 1, stands for 1\n"));
  CHECK(listed.out.find("trace 2, stands for 3\n  0\n      > Take(C)\n") != std::string::npos);
  CHECK(listed.out.ends_with(
      "4 traces up to symmetry, 8 in all, complete (symmetry, not proof checked)\n"));
  CHECK(cli.parallax({"traces", "things.e", "--count"}).out == "8\n");
  const auto lines =
      cli.parallax({"traces", "things.e", "--limit", "0", "--up-to-symmetry", "--format", "jsonl"});
  cli.write("orbits.jsonl", lines.out);
  CHECK(cli.parallax({"traces", "things.e", "--replay", "orbits.jsonl"}).code == 0);
  std::istringstream in(lines.out);
  std::string line;
  int sum = 0;
  while (std::getline(in, line)) {
    const auto one = nlohmann::json::parse(line);
    if (one.contains("orbit")) sum += one["orbit"].get<int>();
    if (one.contains("summary")) CHECK(one["in_all"] == sum);
  }
  CHECK(sum == 8);
  // The limit stops in the middle.
  const auto some = cli.parallax({"traces", "things.e", "--limit", "2", "--up-to-symmetry"});
  CHECK(some.out.ends_with("2 traces up to symmetry, 4 in all so far, stopped\n"));
  // The compiled file gives the same list.
  CHECK(cli.parallax({"compile", "things.e", "-o", "things.cnf"}).code == 0);
  CHECK(cli.parallax({"traces", "things.cnf", "--limit", "0", "--up-to-symmetry"}).out ==
        listed.out);
}

TEST_CASE("a plan tells apart what it names, and start states have orbits as well") {
  const CliFixture cli;
  cli.write("domain.e",
            cli.read("domain.e") + "\nsort thing\nthing A, B, C\nfluent Dirty(thing)\n");
  const auto count = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {"traces",
                                          "domain.e",
                                          "start.e",
                                          "--plan",
                                          "fetch.lisp",
                                          "--bind",
                                          "robot.bind",
                                          "--regions",
                                          "scenario.yaml",
                                          "--horizon",
                                          "6",
                                          "--until",
                                          "HoldsAt(BoxIn(r1),time)",
                                          "--count",
                                          "--split-initial"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return cli.parallax(arguments).out;
  };
  CHECK(count({}) == "8\n");
  CHECK(count({"--up-to-symmetry"}) == "4 up to symmetry, 8 in all\n");
  cli.write("domain.e", cli.read("domain.e") + "HoldsAt(Dirty(A),0) -> HoldsAt(Dirty(B),0).\n");
  CHECK(count({"--up-to-symmetry"}) == "6 up to symmetry, 6 in all\n");
}

TEST_CASE("--up-to-symmetry without interchangeable constants is the whole list") {
  const CliFixture cli;
  cli.write("things.e", kThings + "Happens(Take(A),0).\n!Happens(Take(B),0).\n");
  CHECK(cli.parallax({"traces", "things.e", "--up-to-symmetry", "--count"}).out ==
        "2 up to symmetry, 2 in all\n");
  const auto listed =
      cli.parallax({"traces", "things.e", "--up-to-symmetry", "--limit", "0", "--stats"});
  CHECK(listed.out.ends_with("2 traces up to symmetry, 2 in all, complete (no proof)\n"));
  CHECK(listed.err.find("interchangeable: no constants") != std::string::npos);
}

TEST_CASE(
    "lists up to a goal: that there is nothing is found by symmetry, and lists are the same") {
  const CliFixture cli;
  const std::string goal = "[bird] {hole} HoldsAt(In(bird,hole),time)";
  cli.write("many.e", holes(13, 12));
  CHECK(cli.parallax({"traces", "many.e", "--limit", "0", "--until", goal}).out ==
        "0 traces, complete up to bound (symmetry, not proof checked)\n");
  cli.write("suite.yaml", "cases:\n  - id: full\n    model: many.e\n    constraints: [\"" + goal +
                              "\"]\n    expect: {traces: 0}\n");
  CHECK(cli.parallax({"suite", "suite.yaml"}).code == 0);
  cli.write("few.e", holes(5, 5, "[bird] !HoldsAt(In(bird,H1),1).\n"));
  const std::vector<std::string> list = {
      "traces", "few.e",   "--limit",
      "3",      "--until", "[bird] bird=B1 | ({hole} HoldsAt(In(bird,hole),time))"};
  auto certified = list;
  certified.insert(certified.end(), {"--certify", "--format", "jsonl"});
  auto plain = list;
  plain.insert(plain.end(), {"--format", "jsonl"});
  const auto traces_in = [](const std::string& text) {
    return text.substr(0, text.find("{\"summary\""));
  };
  const auto with = cli.parallax(plain), without = cli.parallax(certified);
  CHECK(traces_in(with.out) == traces_in(without.out));
  CHECK(with.out.find("In(B2,H") != std::string::npos);
}

TEST_CASE("constants that belong together are exchanged together") {
  const CliFixture cli;
  std::string text = "range time 0 1\nsort animal\nsort cage\nanimal " + numbered("A", 4) +
                     "\ncage " + numbered("C", 4) +
                     "\nfluent Shut(cage)\nfluent Fed(animal)\nevent Feed(animal)\n"
                     "[animal,time] Initiates(Feed(animal),Fed(animal),time).\n"
                     "[animal] !HoldsAt(Fed(animal),0).\n";
  for (const std::string n : {"1", "2", "3", "4"}) {
    text += "[time] Happens(Feed(A" + n + "),time) -> !HoldsAt(Shut(C" + n + "),time).\n";
  }
  cli.write("zoo.e", text);
  // Each animal: fed or not, and its cage shut or not, but not both: multisets of four of three.
  const auto listed =
      cli.parallax({"traces", "zoo.e", "--up-to-symmetry", "--limit", "0", "--stats"});
  CHECK(listed.out.ends_with(
      "15 traces up to symmetry, 81 in all, complete (symmetry, not proof checked)\n"));
  CHECK(listed.err.find("C1 with C2 and A1 with A2 together") != std::string::npos);
  CHECK(cli.parallax({"traces", "zoo.e", "--count"}).out == "81\n");
  // One that is named is alone with its cage.
  const std::string goal = "HoldsAt(Fed(A2),time)";
  CHECK(cli.parallax({"traces", "zoo.e", "--count", "--until", goal}).out == "8\n");
  CHECK(cli.parallax({"traces", "zoo.e", "--count", "--until", goal, "--up-to-symmetry"}).out ==
        "4 up to symmetry, 8 in all\n");
}

TEST_CASE("what does not go with --up-to-symmetry is refused") {
  const CliFixture cli;
  cli.write("things.e", kThings);
  for (const auto& more : std::vector<std::vector<std::string>>{
           {"--certify"}, {"--sample", "2"}, {"--from", "2"}, {"--format", "csv"}}) {
    std::vector<std::string> arguments = {"traces", "things.e", "--up-to-symmetry"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto refused = cli.parallax(arguments);
    CHECK(refused.code == 2);
    CHECK(refused.err.find("--up-to-symmetry") != std::string::npos);
  }
}

}  // namespace
}  // namespace parallax::test
