// `parallax traces --minimize`: best traces, the proof that there are no better ones, and the
// message where that is not known.

#include <doctest/doctest.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Two ways from A to D: by B, two steps that cost 4 each, or by C1 and C2, three that cost 2.
constexpr const char* kWays =
    "range time 0 4\nsort place\nplace A,B,Xa,Xb,D\nsort cost: integer\nrange cost 0 9\n"
    "fluent At(place)\nevent Go(place)\n"
    "function Price(place): cost\n"
    "Price(A)=9.\nPrice(B)=4.\nPrice(Xa)=2.\nPrice(Xb)=2.\nPrice(D)=2.\n"
    "predicate Near(place,place)\n"
    "[place1,place2] Near(place1,place2) <->\n"
    "(place1=A & (place2=B | place2=Xa)) | (place1=B & place2=D) | (place1=Xa & place2=Xb) |\n"
    "(place1=Xb & place2=D).\n"
    "[place,time] Initiates(Go(place),At(place),time).\n"
    "[place1,place2,time] place1!=place2 -> Terminates(Go(place1),At(place2),time).\n"
    "[place,time] Happens(Go(place),time) -> {place1} HoldsAt(At(place1),time) & "
    "Near(place1,place).\n"
    "[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.\n"
    "[place] HoldsAt(At(place),0) <-> place=A.\n";
const std::string kGoal = std::string(kWays) + "HoldsAt(At(D),4).\n";

ProcessResult best(const CliFixture& cli, std::vector<std::string> more) {
  std::vector<std::string> words = {"traces", "m.e"};
  words.insert(words.end(), more.begin(), more.end());
  return cli.parallax(words);
}
Json document(const CliFixture& cli, std::vector<std::string> more) {
  more.emplace_back("--json");
  const auto result = best(cli, std::move(more));
  CAPTURE(result.err);
  return Json::parse(result.out);
}

TEST_CASE("the best traces are listed in canonical order, with their value") {
  const CliFixture cli;
  cli.write("m.e", kGoal);
  // Two steps among four timepoints: six traces.
  const auto fewest = best(cli, {"--minimize", "count Happens(event,time)", "--limit", "0"});
  CHECK(fewest.code == 0);
  CHECK(contains(fewest.out,
                 "\n6 traces, complete (no proof)\n"
                 "optimum 2 (no proof): count Happens(event,time)\n"));
  const auto cheapest =
      document(cli, {"--minimize", "sum Price(place): Happens(Go(place),time)", "--limit", "0"});
  CHECK(cheapest.at("optimum") == 6);
  CHECK(cheapest.at("proved") == true);
  CHECK(cheapest.at("traces") == 10);  // by either way: 2+2+2 in three steps, 4+2 in two
  CHECK(document(cli, {"--minimize", "sum Price(place): Happens(Go(place),time)", "--count"})
            .at("traces") == 10);
}

TEST_CASE("objectives are taken in the order in which they are given") {
  const CliFixture cli;
  cli.write("m.e", kGoal);
  const std::string price = "sum Price(place): Happens(Go(place),time)";
  const auto short_first = document(
      cli, {"--minimize", price, "--minimize", "count Happens(event,time)", "--limit", "0"});
  CHECK(short_first.at("optimum") == Json::parse("[6,2]"));
  CHECK(short_first.at("traces") == 6);
  // A negative weight is a gain; parts are added up.
  const auto long_first =
      document(cli, {"--minimize", price + ", sum -1: Happens(event,time)", "--limit", "0"});
  CHECK(long_first.at("optimum") == 3);
  CHECK(long_first.at("traces") == 4);
}

TEST_CASE("one trace is one of the best, and with a goal a trace of any length") {
  const CliFixture cli;
  cli.write("m.e", kWays);
  const auto price = std::string("sum Price(place): Happens(Go(place),time)");
  const auto one =
      document(cli, {"--minimize", price, "--until", "HoldsAt(At(D),time)", "--limit", "1"});
  CHECK(one.at("optimum") == 6);
  CHECK(one.at("traces") == 1);
  const auto all =
      document(cli, {"--minimize", price, "--until", "HoldsAt(At(D),time)", "--limit", "0"});
  CHECK(all.at("optimum") == 6);
  std::int64_t shortest = 9;
  for (const auto& trace : all.at("list")) {
    shortest = std::min<std::int64_t>(shortest, trace.at("timepoints").size() - 1);
  }
  CHECK(shortest == 2);
  const auto text = best(cli, {"--minimize", price, "--until", "HoldsAt(At(D),time)", "--limit",
                               "1", "--order", "canonical"});
  CHECK(contains(text.out, "> Go(B)"));
  CHECK(contains(text.out, "optimum 6 (no proof)"));
}

TEST_CASE("a compiled model has the objectives that it was compiled with") {
  const CliFixture cli;
  cli.write("m.e", kWays);
  const std::string price = "sum Price(place): Happens(Go(place),time)";
  const std::vector<std::string> objectives = {
      "--minimize", price + ", sum -3: Happens(Go(Xa),time) & HoldsAt(At(A),time)", "--minimize",
      "count Happens(event,time) | HoldsAt(At(B),time)"};
  const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  for (const auto* goal : {"", "HoldsAt(At(D),time)"}) {
    const std::vector<std::string> until =
        *goal == 0 ? std::vector<std::string>{} : std::vector<std::string>{"--until", goal};
    REQUIRE(
        cli.parallax(with(with({"compile", "m.e", "-o", "m.dec.cnf"}, until), objectives)).code ==
        0);
    for (const std::vector<std::string>& asked :
         {std::vector<std::string>{"--limit", "0"}, {"--limit", "1"}, {"--count"}, {"--certify"}}) {
      const auto told = cli.parallax(with(with(with({"traces", "m.e"}, until), objectives), asked));
      const auto read = cli.parallax(with({"traces", "m.dec.cnf", "--best"}, asked));
      CAPTURE(read.err);
      CHECK(told.code == 0);
      CHECK(read.code == 0);
      CHECK(told.out == read.out);
    }
    // Written again, it is the same; without --best the objectives say nothing.
    REQUIRE(cli.parallax({"compile", "m.dec.cnf", "-o", "again.dec.cnf"}).code == 0);
    CHECK(cli.read("again.dec.cnf") == cli.read("m.dec.cnf"));
    CHECK(cli.parallax(with({"traces", "m.e", "--limit", "0"}, until)).out ==
          cli.parallax({"traces", "m.dec.cnf", "--limit", "0"}).out);
  }
  cli.write("says.e", std::string(kWays) + "minimize " + price + "\n");
  REQUIRE(cli.parallax({"compile", "says.e", "--best", "-o", "says.dec.cnf"}).code == 0);
  CHECK(cli.parallax({"traces", "says.dec.cnf", "--best", "--limit", "0"}).out ==
        cli.parallax({"traces", "says.e", "--best", "--limit", "0"}).out);
}

TEST_CASE("objectives of compiled models are asked for where there are some") {
  const CliFixture cli;
  cli.write("m.e", kWays);
  const auto refused = [&](const std::vector<std::string>& words, const std::string& text) {
    const auto result = cli.parallax(words);
    CAPTURE(result.err);
    CHECK(result.code == 2);
    CHECK(contains(result.err, text));
    CHECK(result.out.empty());
  };
  REQUIRE(cli.parallax({"compile", "m.e", "-o", "m.dec.cnf"}).code == 0);
  CHECK(cli.read("m.dec.cnf").starts_with("c dec format 1.0\n"));
  refused({"traces", "m.dec.cnf", "--best"}, "compile it with --best or --minimize");
  refused({"traces", "m.dec.cnf", "--minimize", "count Happens(event,time)"}, "give it to compile");
  refused({"compile", "m.e", "--best"}, "no `minimize` statement");
  refused({"compile", "m.e", "--emit=lp", "--minimize", "count Happens(event,time)"}, "--emit=cnf");
  refused({"compile", "m.dec.cnf", "--best"}, "--emit=cnf");
}

TEST_CASE("the proof refutes that a trace is better, and only where that is true") {
  const CliFixture cli;
  cli.write("m.e", kGoal);
  const std::string price = "sum Price(place): Happens(Go(place),time)";
  // A whole list: there are no others with this value.
  const auto all = best(cli, {"--minimize", price, "--limit", "0", "--certify=a.drat"});
  CHECK(all.code == 0);
  CHECK(contains(all.out, "10 traces, complete (proof checked)\noptimum 6 (proof checked)"));
  // One of them, or some: no trace is better.
  const auto one = document(cli, {"--minimize", price, "--limit", "1", "--certify=b.drat"});
  CHECK(one.at("proved") == true);
  CHECK(one.at("proof") == "checked");
  CHECK(one.at("complete") == false);
  const auto some = document(cli, {"--minimize", price, "--limit", "3", "--certify=c.drat"});
  CHECK(some.at("proof") == "checked");
  CHECK(some.at("traces") == 3);
  const auto counted = document(cli, {"--minimize", price, "--count", "--certify=d.drat"});
  CHECK(counted.at("proof") == "checked");
  for (const auto* name : {"a", "b", "c", "d"}) {
    CHECK(std::filesystem::exists(cli.folder() / (std::string(name) + ".drat.cnf")));
  }
}

TEST_CASE("a model says itself which traces are best") {
  const CliFixture cli;
  cli.write("m.e", kGoal +
                       "minimize sum Price(place): Happens(Go(place),time)  ; less money\n"
                       "minimize count Happens(event,time)\n");
  const auto asked = document(cli, {"--best", "--limit", "0"});
  CHECK(asked.at("optimum") == Json::parse("[6,2]"));
  CHECK(asked.at("traces") == 6);
  // Unasked, they change nothing.
  cli.write("plain.e", kGoal);
  CHECK(best(cli, {"--limit", "0"}).out == cli.parallax({"traces", "plain.e", "--limit", "0"}).out);
  CHECK(best(cli, {"--best", "--minimize", "count Happens(event,time)"}).code == 2);
  CHECK(cli.parallax({"traces", "plain.e", "--best"}).code == 2);
  cli.write("m.e", kGoal + "minimize count Hapens(event,time)\n");
  const auto wrong = best(cli, {"--best"});
  CHECK(wrong.code == 3);
  CHECK(contains(wrong.err, "m.e:24:16-21: error[E2"));
  CHECK(best(cli, {"--limit", "1"}).code == 0);
  cli.write("m.e", kGoal + "minimize\n");
  CHECK(contains(best(cli, {}).err, "error[E1010]"));
}

TEST_CASE("what cannot be an objective is refused at its place") {
  const CliFixture cli;
  cli.write("m.e", kGoal);
  const auto refused = [&](const std::string& objective, const std::string& code) {
    const auto result = best(cli, {"--minimize", objective});
    CAPTURE(objective);
    CAPTURE(result.err);
    CHECK(result.code == 3);
    CHECK(contains(result.err, code));
    CHECK(result.out.empty());
  };
  refused("Happens(event,time)", "--minimize:1:1-7: error[E1024]");
  refused("sum Happens(event,time)", "error[E1024]");
  refused("count Happens(event,time),", "error[E1024]");
  refused("sum Price(place): ", "error[E1003]");
  refused("sum Happens(event,time): Happens(event,time)", "error[E2");
  refused("sum place: Happens(Go(place),time)", "error[E2");
  refused("count Happens(nothing,time)", "error[E2");
  refused("count Initiates(event,fluent,time)", "error[E2302]");
  refused("count HoldsAt(fluent,time) & time>9", "error[E3017]");
  refused("count Happens(event,4)", "error[E3017]");
  refused("count time<3", "error[E3017]");
  refused("sum 4611686018427387904: Happens(event,time)", "error[E3018]");
  refused("sum 1000000000*1000000000: HoldsAt(fluent,time)", "error[E3018]");
  refused("sum 9223372036854775807*(time+2): HoldsAt(fluent,time)", "error[E3006]");
  CHECK(best(cli, {"--minimize", "  "}).code == 2);
  CHECK(best(cli, {"--minimize", "count Happens(event,time)", "--until", "HoldsAt(At(D),time)",
                   "--hits", "all"})
            .code == 2);
  CHECK(cli.parallax({"compile", "m.e", "-o", "m.dec.cnf"}).code == 0);
  CHECK(cli.parallax({"traces", "m.dec.cnf", "--minimize", "count Happens(event,time)"}).code == 2);
}

/// Number of times that an atom is in the lists called `name` of a trace.
std::size_t times_of(const Json& trace, const char* name, const std::string& atom) {
  std::size_t times = 0;
  for (const auto& point : trace.at("timepoints")) {
    if (!point.contains(name)) continue;
    times += static_cast<std::size_t>(
        std::count(point.at(name).begin(), point.at(name).end(), Json(atom)));
  }
  return times;
}

TEST_CASE("the best of a plan's traces are those that counting all of them finds") {
  const CliFixture cli;
  std::size_t compared = 0, differing = 0;
  for (const std::string plan : {"plan1", "plan2", "plan3"}) {
    CAPTURE(plan);
    const auto scenario = std::string(PARALLAX_SOURCE_DIR) + "/scenarios/kitchen/" + plan + ".yaml";
    const auto listed = [&](std::vector<std::string> more) {
      std::vector<std::string> words = {"traces", scenario,          "--limit",
                                        "0",      "--split-initial", "--json"};
      words.insert(words.end(), more.begin(), more.end());
      const auto result = cli.parallax(words);
      CAPTURE(result.err);
      CHECK(result.code == 0);
      return Json::parse(result.out);
    };
    const auto all = listed({}).at("list");
    REQUIRE(all.size() > 1);
    std::set<std::pair<std::string, std::string>> atoms;  // the name of their list, and they
    for (const auto& trace : all) {
      for (const auto& point : trace.at("timepoints")) {
        for (const std::string name : {"happens", "holds"}) {
          if (!point.contains(name)) continue;
          for (const auto& atom : point.at(name)) atoms.emplace(name, atom.get<std::string>());
        }
      }
    }
    std::size_t number = 0;
    for (const auto& [name, atom] : atoms) {
      if (++number % 5 != 0) continue;
      CAPTURE(atom);
      std::size_t least = std::numeric_limits<std::size_t>::max(), most = 0;
      for (const auto& trace : all) {
        least = std::min(least, times_of(trace, name.c_str(), atom));
        most = std::max(most, times_of(trace, name.c_str(), atom));
      }
      Json best_of_all = Json::array();
      for (const auto& trace : all) {
        if (times_of(trace, name.c_str(), atom) == least) {
          best_of_all.push_back(trace.at("timepoints"));
        }
      }
      const auto found =
          listed({"--minimize", std::string("count ") +
                                    (name == "holds" ? "HoldsAt(" : "Happens(") + atom + ",time)"});
      CHECK(found.at("optimum") == least);
      Json given = Json::array();
      for (const auto& trace : found.at("list")) given.push_back(trace.at("timepoints"));
      const bool are_those = given == best_of_all;  // too long to be printed
      CHECK(are_those);
      ++compared;
      if (most > least) ++differing;
    }
  }
  CHECK(compared > 15);
  CHECK(differing > 5);
}

TEST_CASE("a model without traces has no optimum") {
  const CliFixture cli;
  cli.write("m.e", kGoal +
                       "HoldsAt(At(A),4).\n[place1,place2,time] HoldsAt(At(place1),time) & "
                       "HoldsAt(At(place2),time) -> place1=place2.\n");
  const auto none = document(cli, {"--minimize", "count Happens(event,time)", "--certify"});
  CHECK(none.at("traces") == 0);
  CHECK(none.at("complete") == true);
  CHECK(none.at("optimum").is_null());
  CHECK(none.at("proof") == "checked");
}

TEST_CASE("weights may be large") {
  const CliFixture cli;
  cli.write("m.e", kGoal);
  const auto large = document(
      cli, {"--minimize", "sum 100000000000000000+time: Happens(event,time)", "--limit", "0"});
  CHECK(large.at("optimum") == 200000000000000001);
  CHECK(large.at("traces") == 1);
}

TEST_CASE("a limit in the middle leaves the best trace so far and a bound") {
  const CliFixture cli;
  // Fourteen things and 13 places: one is left over, which takes a solver for ever to see.
  std::string text =
      "range time 0 0\nsort thing: integer\nrange thing 1 14\n"
      "sort place: integer\nrange place 1 13\nfluent At(thing,place)\n"
      "[thing1,thing2,place] HoldsAt(At(thing1,place),0) & "
      "HoldsAt(At(thing2,place),0) -> thing1=thing2.\n";
  cli.write("m.e", text);
  const std::string left_over = "sum 3: [place] !HoldsAt(At(thing,place),0)";
  const auto stopped =
      cli.parallax({"traces", "m.e", "--minimize", left_over, "--time-limit", "2", "--json"});
  CAPTURE(stopped.err);
  CHECK(stopped.code == 4);
  const auto told = Json::parse(stopped.out);
  CHECK(told.at("proved") == false);
  CHECK(told.at("complete") == false);
  CHECK(told.at("optimum").is_null());
  CHECK(told.at("at_least") == 0);
  CHECK(told.at("best") >= 3);
  CHECK(told.at("traces") == 1);
  CHECK_FALSE(told.contains("proof_file"));
  const auto lines =
      cli.parallax({"traces", "m.e", "--minimize", left_over, "--time-limit", "2", "--certify"});
  CHECK(lines.code == 4);
  CHECK(contains(lines.out, "1 trace, stopped\noptimum between 0 and "));
  CHECK_FALSE(std::filesystem::exists(cli.folder() / "m.drat"));
}

}  // namespace
}  // namespace parallax::test
