#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Hanks and McDermott's turkey: load, wait, shoot.
constexpr const char* kYale =
    "fluent Loaded()\nfluent Alive()\nevent Load()\nevent Wait()\nevent Shoot()\n"
    "[time] Initiates(Load(),Loaded(),time).\n"
    "[time] HoldsAt(Loaded(),time) -> Terminates(Shoot(),Alive(),time).\n"
    "[time] Terminates(Shoot(),Loaded(),time).\n"
    "!HoldsAt(Loaded(),0).\nHoldsAt(Alive(),0).\n"
    "[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.\n"
    "range time 0 3\n";
const std::string kStory =
    std::string(kYale) + "Happens(Load(),0).\nHappens(Wait(),1).\nHappens(Shoot(),2).\n";

}  // namespace

TEST_CASE("what all traces have in common is told by timepoint") {
  const CliFixture cli;
  cli.write("story.e", kStory);
  const auto told = cli.parallax({"consequences", "story.e"});
  CAPTURE(told.err);
  CHECK(told.code == 0);
  CHECK(told.out ==
        "in all traces\n"
        "  0 holds    Alive()\n  0 happens  Load()\n"
        "  1 holds    Loaded(), Alive()\n  1 happens  Wait()\n"
        "  2 holds    Loaded(), Alive()\n  2 happens  Shoot()\n"
        "in some traces, not in all\n  nothing\n");
  const auto why =
      cli.parallax({"consequences", "story.e", "--always", "--at", "2", "--why", "--json"});
  CHECK(why.code == 0);
  const auto facts = Json::parse(why.out).at("facts");
  for (const auto& fact : facts) {
    if (fact.at("name") != "Loaded()") continue;
    // Loading, its effect and inertia; that nothing else happens at 1 needs the exclusion.
    CHECK(fact.at("in") == "always");
    std::string places;
    for (const auto& axiom : fact.at("because"))
      places += axiom.at("place").get<std::string>() + ' ';
    CHECK(contains(places, "story.e:6"));
    CHECK(contains(places, "story.e:13"));
    CHECK_FALSE(contains(places, "story.e:10"));  // that the turkey lives is no reason
  }
}

TEST_CASE("without a story some things are possible and few are certain") {
  const CliFixture cli;
  cli.write("yale.e", kYale);
  const auto json = Json::parse(cli.parallax({"consequences", "yale.e", "--json"}).out);
  CHECK(json.at("has_traces") == true);
  CHECK(json.at("complete") == true);
  std::map<std::string, std::string> in;
  for (const auto& fact : json.at("facts")) {
    in[fact.at("name").get<std::string>() + std::to_string(fact.at("time").get<int>())] =
        fact.at("in");
  }
  CHECK(in.at("Alive()0") == "always");
  CHECK(in.at("Alive()1") == "always");  // not loaded yet
  CHECK(in.at("Alive()2") == "sometimes");
  CHECK(in.at("Loaded()0") == "never");
  CHECK(in.at("Shoot()2") == "sometimes");
}

TEST_CASE("of traces that reach a goal it is told what they share") {
  const CliFixture cli;
  cli.write("yale.e", kYale);
  const auto told =
      cli.parallax({"consequences", "yale.e", "--always", "--until", "!HoldsAt(Alive(),time)"});
  // A shortest way has two steps; another one waits or loads again in between.
  // The last event of a long one is the shot, and short ones have no event at 2.
  CHECK(told.out ==
        "in all traces\n  0 holds    Alive()\n  1 holds    Alive()\n  2 happens  Shoot()\n");
  const auto shortest = cli.parallax({"consequences", "yale.e", "--always", "--until",
                                      "!HoldsAt(Alive(),time)", "--horizon", "2"});
  CHECK(shortest.out ==
        "in all traces\n  0 holds    Alive()\n  0 happens  Load()\n"
        "  1 holds    Loaded(), Alive()\n  1 happens  Shoot()\n");
  CHECK(
      cli.parallax({"consequences", "yale.e", "--why", "--until", "!HoldsAt(Alive(),time)"}).code ==
      2);
}

TEST_CASE("events explain what was observed") {
  const CliFixture cli;
  cli.write("yale.e", kYale);
  const auto told = cli.parallax({"consequences", "yale.e", "--abduce", "Load", "--abduce", "Shoot",
                                  "--abduce", "Wait", "--observe", "!HoldsAt(Alive(),time)"});
  CAPTURE(told.err);
  CHECK(told.code == 0);
  CHECK(contains(told.out, "explanation 1: Load() at "));
  CHECK(contains(told.out, "3 explanations, complete\n"));
  for (const auto* way :
       {"Load() at 0, Shoot() at 1", "Load() at 0, Shoot() at 2", "Load() at 1, Shoot() at 2"}) {
    CHECK(contains(told.out, way));
  }
  const auto none = cli.parallax(
      {"consequences", "yale.e", "--abduce", "Wait", "--observe", "!HoldsAt(Alive(),time)"});
  CHECK(none.code == 1);
  CHECK(contains(none.out, "0 explanations, complete"));
  CHECK(contains(none.out, "something else is open"));
}

TEST_CASE("consequences: what is asked wrongly is said") {
  const CliFixture cli;
  cli.write("yale.e", kYale);
  const auto unknown = cli.parallax(
      {"consequences", "yale.e", "--abduce", "Shot", "--observe", "!HoldsAt(Alive(),time)"});
  CHECK(unknown.code == 3);
  CHECK(contains(unknown.err, "Shoot"));
  CHECK(cli.parallax({"consequences", "yale.e", "--abduce", "Shoot"}).code == 2);
  CHECK(cli.parallax({"consequences", "yale.e", "--always", "--sometimes"}).code == 2);
  CHECK(cli.parallax({"consequences", "yale.e", "--at", "9"}).code == 2);
  CHECK(cli.parallax({"consequences", "nosuch.e"}).code == 2);
  cli.write("no.e", "range time 0 1\nfluent F()\nHoldsAt(F(),0).\n!HoldsAt(F(),1).\n");
  const auto none = cli.parallax({"consequences", "no.e"});
  CHECK(none.code == 1);
  CHECK(contains(none.out, "there is no trace"));
}

}  // namespace parallax::test
