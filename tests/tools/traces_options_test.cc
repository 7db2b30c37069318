#include <doctest/doctest.h>

#include <set>
#include <sstream>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

// Two switches, each pressed or not at each of four timepoints: 4^4 traces.
constexpr const char* kSwitches =
    "sort s\ns A, B\nfluent On(s)\nevent Press(s)\n[s,time] Initiates(Press(s),On(s),time).\n"
    "[s] !HoldsAt(On(s),0).\nrange time 0 4\n";

std::string before_timing(const std::string& text) { return text.substr(0, text.find("timing")); }

}  // namespace

TEST_CASE("a forced strategy lists and counts the same") {
  const CliFixture cli;
  cli.write("m.e", kSwitches);
  const auto wanted = cli.parallax({"traces", "m.e", "--limit", "0", "--format", "jsonl"});
  CHECK(wanted.code == 0);
  CHECK(wanted.out.find("\"traces\":256,\"complete\":true") != std::string::npos);
  for (const auto* strategy : {"blocking", "guarded", "tree", "graph"}) {
    const auto listed = cli.parallax(
        {"traces", "m.e", "--limit", "0", "--format", "jsonl", "--strategy", strategy});
    CHECK(before_timing(listed.out) == before_timing(wanted.out));
    CHECK(cli.parallax({"traces", "m.e", "--count", "--strategy", strategy}).out == "256\n");
  }
  const auto stats = cli.parallax({"traces", "m.e", "--count", "--stats"});
  CHECK(stats.err.find("strategy search; ") != std::string::npos);
}

TEST_CASE("the graph counts with predicates that are tied to those that tie timepoints") {
  const CliFixture cli;
  cli.write("m.e",
            "range time 0 3\nfluent F()\nevent E()\npredicate P()\npredicate Q()\npredicate R()\n"
            "[time] Happens(E(),time) -> P().\n!P() | !Q().\n!P() | !R().\nQ() | R().\n"
            "[time] Initiates(E(),F(),time).\n");
  // P() cannot be, so nothing happens.
  for (const auto* strategy : {"auto", "blocking", "graph"}) {
    CAPTURE(strategy);
    CHECK(cli.parallax({"traces", "m.e", "--count", "--strategy", strategy}).out == "2\n");
  }
}

TEST_CASE("in any order the traces are the same") {
  const CliFixture cli;
  cli.write("m.e", kSwitches);
  const auto traces = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {"traces", "m.e", "--format", "jsonl"};
    all.insert(all.end(), more.begin(), more.end());
    const auto result = cli.parallax(all);
    CAPTURE(result.err);
    CHECK(result.code == 0);
    std::multiset<std::string> found;
    std::istringstream lines(result.out);
    for (std::string line; std::getline(lines, line);) {
      const auto points = line.find("\"timepoints\"");
      if (points != std::string::npos && line.find("\"summary\"") == std::string::npos)
        found.insert(line.substr(points));
    }
    return found;
  };
  const auto listed = traces({"--limit", "0"});
  CHECK(listed.size() == 256);
  CHECK(traces({"--limit", "0", "--strategy", "blocking", "--order", "any"}) == listed);
  const std::vector<std::string> goal = {"--until", "HoldsAt(On(A),time) & HoldsAt(On(B),time)"};
  const auto reach = [&](std::vector<std::string> more) {
    more.insert(more.end(), goal.begin(), goal.end());
    return traces(std::move(more));
  };
  const auto ways = reach({"--limit", "0"});
  CHECK(ways.size() > 3);
  CHECK(reach({"--limit", "0", "--order", "any"}) == ways);
  const auto one = reach({"--limit", "1"});
  REQUIRE(one.size() == 1);
  CHECK(ways.count(*one.begin()) == 1);
  CHECK(one == reach({"--limit", "1", "--order", "any"}));
  CHECK(one.begin()->find("Press(A)") != std::string::npos);
}

TEST_CASE("any order is refused where the canonical one is needed") {
  const CliFixture cli;
  cli.write("m.e", kSwitches);
  for (const auto* needs : {"--certify", "--from=3", "--sample=2"}) {
    CHECK(cli.parallax({"traces", "m.e", "--order", "any", needs}).code == 2);
  }
  CHECK(cli.parallax({"traces", "m.e", "--order", "every"}).code == 2);
}

TEST_CASE("--from goes on where an earlier list ended") {
  const CliFixture cli;
  cli.write("m.e", kSwitches);
  const auto all = cli.parallax({"traces", "m.e", "--limit", "0"}).out;
  const auto from = cli.parallax({"traces", "m.e", "--limit", "0", "--from", "200"}).out;
  const auto begin = all.find("trace 200\n");
  REQUIRE(begin != std::string::npos);
  const auto end = all.find("256 traces");
  CHECK(from.starts_with(all.substr(begin, end - begin)));
  CHECK(from.find("57 traces, complete from there on") != std::string::npos);
  CHECK(cli.parallax({"traces", "m.e", "--from", "257"}).out.starts_with("0 traces"));
}

TEST_CASE("--sample draws traces of the list, the same for the same seed") {
  const CliFixture cli;
  cli.write("m.e", kSwitches);
  const auto drawn = cli.parallax({"traces", "m.e", "--sample", "3", "--seed", "9"});
  CHECK(drawn.code == 0);
  CHECK(drawn.out.find("3 traces, drawn from 256 with seed 9") != std::string::npos);
  CHECK(cli.parallax({"traces", "m.e", "--sample", "3", "--seed", "9"}).out == drawn.out);
  CHECK(cli.parallax({"traces", "m.e", "--sample", "3", "--seed", "8"}).out != drawn.out);
}

TEST_CASE("--distinct all tells traces apart by what is hidden") {
  const CliFixture cli;
  cli.write("m.e",
            "fluent F()\nevent E()\npredicate P()\nrange time 0 1\nHoldsAt(F(),0).\n"
            "P() | !P().\n[time] Releases(E(),F(),time).\nP() -> Happens(E(),0).\n");
  CHECK(cli.parallax({"traces", "m.e", "--count"}).out == "3\n");
  CHECK(cli.parallax({"traces", "m.e", "--count", "--distinct", "all"}).out == "5\n");
}

TEST_CASE("models may follow an option that can be given several times") {
  const CliFixture cli;
  cli.write("m.e", kSwitches);
  const auto before = cli.parallax({"traces", "--until", "HoldsAt(On(A),time)", "--until",
                                    "HoldsAt(On(B),time)", "-I", ".", "m.e"});
  const auto after = cli.parallax({"traces", "m.e", "-I", ".", "--until", "HoldsAt(On(A),time)",
                                   "--until", "HoldsAt(On(B),time)"});
  CHECK(before.code == 0);
  CHECK(before.out == after.out);
}

TEST_CASE("options that do not go together, and a strategy that cannot be had, are told") {
  const CliFixture cli;
  cli.write("m.e", kSwitches);
  CHECK(cli.parallax({"traces", "m.e", "--sample", "2", "--count"}).code == 2);
  CHECK(cli.parallax({"traces", "m.e", "--from", "2", "--count"}).code == 2);
  CHECK(cli.parallax({"traces", "m.e", "--from", "0"}).code == 2);
  CHECK(cli.parallax({"traces", "m.e", "--sample", "0"}).code == 2);
  CHECK(cli.parallax({"traces", "m.e", "--distinct", "all", "--certify"}).code == 2);
  CHECK(cli.parallax({"traces", "m.e", "--until", "HoldsAt(On(A),time)", "--sample", "2"}).code ==
        2);
  cli.write("far.e", std::string(kSwitches) + "Happens(Press(A),0) | Happens(Press(A),3).\n");
  // Counted by the graph; as a state hides what will have happened, the graph does not list.
  const auto refused = cli.parallax({"traces", "far.e", "--quiet", "--strategy", "graph"});
  CHECK(refused.code == 2);
  CHECK(refused.out.empty());
  CHECK(refused.err.find("E7203") != std::string::npos);
  CHECK(cli.parallax({"traces", "far.e", "--count", "--strategy", "graph"}).out == "192\n");
  CHECK(cli.parallax({"traces", "far.e", "--count"}).out == "192\n");
}

TEST_CASE("a goal that holds at timepoint 0 is reached by a trace of length 0") {
  const CliFixture cli;
  cli.write("m.e", kSwitches);
  const std::vector<std::string> until = {"traces", "m.e", "--until", "!HoldsAt(On(A),time)"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), until.begin(), until.end());
    return cli.parallax(more);
  };
  const auto list = with({"--limit", "0", "--format", "jsonl"}).out;
  CHECK(list.find("\"timepoints\":[{\"time\":0,\"happens\":[],\"holds\":[],\"released\":[]}]") !=
        std::string::npos);
  CHECK(list.find("\"traces\":1,\"complete\":true") != std::string::npos);
  cli.write("list.jsonl", list);
  CHECK(with({"--replay", "list.jsonl"}).code == 0);
  CHECK(with({"--limit", "0", "--certify=list.proof"}).out.find("proof checked") !=
        std::string::npos);
  // Elsewhere it is the first time all the same.
  CHECK(cli.parallax({"traces", "m.e", "--until", "HoldsAt(On(A),time)", "--limit", "1"})
            .out.find("  1\n") != std::string::npos);
}

TEST_CASE(
    "with --compat decreasoner an event of the last timepoint is listed, counted and proved") {
  const CliFixture cli;
  cli.write("m.e",
            "range time 0 1\nfluent F()\nevent E()\nHoldsAt(F(),0) | Happens(E(),1).\n"
            "!HoldsAt(F(),0) | !Happens(E(),1).\n");
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"traces", "m.e", "--compat", "decreasoner"});
    return cli.parallax(more).out;
  };
  const auto listed = with({"--limit", "0"});
  CHECK(listed.find("trace 1\n  0\n  1\n      > E()\n") == 0);
  CHECK(listed.find("2 traces, complete") != std::string::npos);
  CHECK(with({"--count"}) == "2\n");
  CHECK(with({"--limit", "0", "--certify=m.proof"}).find("2 traces, complete (proof checked)") !=
        std::string::npos);
  CHECK(with({"--format", "decreasoner"}).find("1\nHappens(E(), 1).\nP\n") != std::string::npos);
  CHECK(cli.parallax({"compile", "m.e", "--compat", "decreasoner", "-o", "m.dec.cnf"}).code == 0);
  CHECK(cli.parallax({"traces", "m.dec.cnf", "--limit", "0"}).out == listed);
}

}  // namespace parallax::test
