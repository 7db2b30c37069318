// A repository of forty cases: the cases that a mistake turns red and their reports, a shard that
// was killed, and suites that were killed at random moments.

#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "tests/support/deep.h"
#include "tests/tools/cli_json.h"
#include "tests/tools/suite/case_repository.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
using Names = std::set<std::string>;

/// Problems of each case that did not pass, by the case's name.
std::map<std::string, std::string> red_cases(const Json& document) {
  std::map<std::string, std::string> out;
  for (const auto& one : document["cases"]) {
    if (one["outcome"] == "passed") continue;
    auto& problems = out[one["case"]];
    for (const auto& problem : one["problems"]) problems += problem.get<std::string>() + '\n';
  }
  return out;
}

Names in(const std::string& manifest, const Names& ids) {
  Names out;
  for (const auto& id : ids) out.insert("repository/" + manifest + "/suite.yaml:" + id);
  return out;
}

Names scenarios(const std::string& folder, const Names& names) {
  Names out;
  for (const auto& name : names) out.insert("repository/" + folder + "/" + name + ".yaml");
  return out;
}

/// A mistake in a model, the cases that notice it, and the words in their reports.
struct Mistake {
  std::string file, right, wrong;
  Names red;
  std::vector<std::string> said;
};

TEST_CASE("a mistake in a model turns exactly those cases red that depend on it, and says why") {
  const CaseRepository cli;
  const auto suite = [&](int code) {
    return json_of(cli, {"suite", "repository", "--jobs", "2"}, code);
  };
  const auto first = suite(0);
  CHECK(first["passed"] == CaseRepository::kCases);
  const std::vector<Mistake> mistakes = {
      // Lamps never go dark: which events there are does not change, so numbers of all traces stay.
      {"switches/switch.e",
       "[lamp,time] HoldsAt(On(lamp),time) -> Terminates(Flip(lamp),On(lamp),time).\n",
       "; forgotten\n",
       in("switches", {"dark2", "dark3", "dark4", "list_dark"}),
       {"since it passed last, repository/switches/switch.e changed",
        "  lost: ", "a shortest such trace of before/repository/switches/switch.e",
        "frame axiom: On(lamp)", "- before/repository/switches/switch.e:6"}},
      // Two axioms that contradict each other: no trace is left, but where none is expected.
      {"switches/switch.e",
       "[lamp] !HoldsAt(On(lamp),0).\n",
       "[lamp] !HoldsAt(On(lamp),0).\nHoldsAt(On(Desk),0).\n",
       in("switches", {"all0", "all1", "all2", "all3", "all4", "lit1", "lit2", "lit3", "lit4",
                       "dark2", "dark3", "dark4", "more_than_ten", "list1", "list_dark"}),
       {"repository/switches/switch.e:8  axiom: HoldsAt(On(Desk),0) (edited)",
        "+ repository/switches/switch.e:8"}},
      // Nobody goes to the kitchen. The first way to the study is still the only one.
      {"errands/errand.e",
       "HoldsAt(At(Hall),0).\n",
       "HoldsAt(At(Hall),0).\n[time] !Happens(Go(Kitchen),time).\n",
       in("errands", {"all1", "all2", "all3", "all4", "kitchen1", "kitchen2", "kitchen3",
                      "kitchen4", "study2", "study3", "study4"}),
       {"traces, expected", "> Go(Kitchen)",
        "repository/errands/errand.e:11  axiom: [time] !Happens(Go(Kitchen),time) (edited)"}},
      // An effect too many, which is made good before the end.
      {"drawers/opens.e",
       "load domain.e\n",
       "load domain.e\n[drawer,time] Terminates(CloseDrawer(drawer),Parked(),time).\n",
       scenarios("drawers",
                 {"agree", "agree_loosely", "agree_always", "sticks", "sticks_by_chance"}),
       {"CloseDrawer(top)", "Parked()", "+ repository/drawers/opens.e:4"}},
      // The model's mistake is mended: the failure that a case expects cannot occur any more.
      {"boxes/wrong_domain.e",
       "[time] Initiates(PickUp(),Holding(),time).\n",
       "[region,time] HoldsAt(RobotIn(region),time) & HoldsAt(BoxIn(region),time) ->\n"
       "  Initiates(PickUp(),Holding(),time).\n",
       scenarios("boxes", {"hasty", "hasty_reach", "hasty_mostly"}),
       {"- before/repository/boxes/wrong_domain.e:32"}}};
  for (const auto& mistake : mistakes) {
    CAPTURE(mistake.wrong);
    cli.replace("repository/" + mistake.file, mistake.right, mistake.wrong);
    const auto found = red_cases(suite(1));
    Names red;
    for (const auto& [name, problems] : found) {
      red.insert(name);
      for (const auto& said : mistake.said) CHECK_MESSAGE(holds(problems, said), name << problems);
    }
    CHECK(red == mistake.red);
    cli.replace("repository/" + mistake.file, mistake.wrong, mistake.right);
  }
  // Mended, everything is as it was, and nothing is run again.
  CHECK(suite(0)["reused"] == CaseRepository::kCases);
}

TEST_CASE("what is to blame is named with its line") {
  const CaseRepository cli;
  const auto problems = [&](const std::string& only) {
    const auto document = json_of(cli, {"suite", "repository", "--only", only, "--no-cache"}, 1);
    return red_cases(document).begin()->second;
  };
  cli.replace("repository/switches/switch.e", "[lamp] !HoldsAt(On(lamp),0).\n",
              "[lamp] !HoldsAt(On(lamp),0).\nHoldsAt(On(Desk),0).\n");
  const auto contradiction = problems("all2");
  CHECK(holds(contradiction, "0 traces, expected 16 traces"));
  CHECK(holds(contradiction, "these contradict each other"));
  CHECK(holds(contradiction, "repository/switches/switch.e:7  axiom: [lamp] !HoldsAt(On(lamp),0)"));
  CHECK(holds(contradiction, "repository/switches/switch.e:8  axiom: HoldsAt(On(Desk),0)"));

  cli.replace("repository/drawers/opens.e", "load domain.e\n",
              "load domain.e\n[drawer,time] Terminates(CloseDrawer(drawer),Parked(),time).\n");
  const auto effect = problems("drawers/agree.yaml");
  CAPTURE(effect);
  CHECK(holds(effect, "verdict discrepancy, expected no-discrepancy"));
  CHECK(holds(
      effect,
      "repository/drawers/opens.e:4  effect axiom: [drawer,time] Terminates(CloseDrawer(drawer)"));
  CHECK_FALSE(holds(effect, "start.e"));
  const auto rate = problems("drawers/agree_always");
  CHECK(holds(rate, "discrepancies in 180 of 180 runs"));
  CHECK(holds(rate, "180 times: CloseDrawer(top): Parked()"));
}

/// Ends a suite by SIGKILL after the given number of looks, a few milliseconds apart.
ProcessOptions killed_after(int looks) {
  ProcessOptions options;
  options.signal_when = [looks]() mutable { return looks-- == 0 ? SIGKILL : 0; };
  return options;
}

Names unfinished_of(const Json& cases) {
  Names out;
  for (const auto& [name, one] : cases.items()) {
    if (one["outcome"] == "not finished") out.insert(name);
  }
  return out;
}

/// The cases on disk of a shard, by name; none while nothing is there.
Json results_of(const CaseRepository& cli, int shard) {
  const auto file = "o" + std::to_string(shard) + "/results.json";
  if (!std::filesystem::exists(cli.folder() / file)) return Json::object();
  return Json::parse(cli.read(file))["cases"];
}

TEST_CASE("of four shards, one of which was killed, exactly its unfinished cases are named") {
  const CaseRepository cli;
  const auto shard = [&](int i, std::vector<std::string> more, ProcessOptions options = {}) {
    const auto n = std::to_string(i);
    more.insert(more.begin(), {"--shard", n + "/4", "--out", "o" + n, "--no-cache"});
    return cli.suite(std::move(more), std::move(options));
  };
  // The one that takes longest is killed once it has some cases on disk and before it has all.
  int longest = 1;
  double most_s = 0.0;
  for (int i = 1; i <= 4; ++i) {
    CHECK(shard(i, {}).code == 0);
    double sum_s = 0.0;
    for (const auto& one : results_of(cli, i)) sum_s += one["wall_s"].get<double>();
    if (sum_s > most_s) longest = i;
    most_s = std::max(most_s, sum_s);
  }
  const auto n = std::to_string(longest);
  std::filesystem::remove_all(cli.folder() / ("o" + n));
  ProcessOptions killed;
  killed.signal_when = [&] {
    const auto cases = results_of(cli, longest);
    const auto count = [&](const char* outcome) {
      return std::count_if(cases.begin(), cases.end(),
                           [&](const Json& one) { return one["outcome"] == outcome; });
    };
    return count("passed") > 0 && count("not finished") > 0 ? SIGKILL : 0;
  };
  CHECK(shard(longest, {}, killed).code == 128 + SIGKILL);
  const auto open = unfinished_of(results_of(cli, longest));
  REQUIRE_FALSE(open.empty());
  const std::vector<std::string> merge = {"suite", "--merge", "o1",  "o2",      "o3",
                                          "o4",    "--out",   "all", "--junit", "all.xml"};
  const auto partial = json_of(cli, merge, 4);
  CHECK(partial["not_run"] == open.size());
  Names named;
  for (const auto& [name, problems] : red_cases(partial)) named.insert(name);
  CHECK(named == open);
  const auto rerun = shard(longest, {"--resume", "--json"});
  CHECK(rerun.code == 0);
  CHECK(Json::parse(rerun.out)["reused"].get<int>() > 0);
  CHECK(json_of(cli, merge)["passed"] == CaseRepository::kCases);
  REQUIRE(cli.suite({"--out", "whole", "--no-cache", "--junit", "whole.xml"}).code == 0);
  CHECK(without_times(cli.read("all.xml")) == without_times(cli.read("whole.xml")));
}

TEST_CASE("a suite killed at random moments and resumed gives the report of one that was not") {
  const CaseRepository cli;
  // Passes, failures with their blame, and a refused input.
  cli.replace("repository/drawers/opens.e", "load domain.e\n",
              "load domain.e\n[drawer,time] Terminates(CloseDrawer(drawer),Parked(),time).\n");
  cli.replace("repository/switches/suite.yaml", "id: all3, model: switch.e",
              "id: all3, model: bad.e");
  cli.write("repository/switches/bad.e", "fluent On(\n");
  // Problems name files below --out, so it is the same folder each time.
  const std::vector<std::string> begin = {"--junit", "r.xml", "--jobs", "2", "--no-cache"};
  const auto results = cli.folder() / "out/suite/results.json";
  REQUIRE(cli.suite(begin).code == 1);
  const auto expected = without_times(cli.read("r.xml"));
  std::mt19937 random(11);
  int kills = 0;
  const int wanted = is_deep() ? 20 : 7;
  for (int round = 0; kills < wanted && round < wanted; ++round) {
    std::filesystem::remove_all(cli.folder() / "out");
    const auto arguments = [&](const char* more) {
      auto out = begin;
      if (std::filesystem::exists(results)) out.emplace_back("--resume");
      if (more != nullptr) out.emplace_back(more);
      return out;
    };
    for (int attempt = 0; attempt < 6; ++attempt) {
      const auto looks = static_cast<int>(random() % 120);
      kills += cli.suite(arguments(nullptr), killed_after(looks)).code == 128 + SIGKILL ? 1 : 0;
    }
    const auto last = cli.suite(arguments(nullptr));
    CHECK(last.code == 1);
    CHECK_MESSAGE(without_times(cli.read("r.xml")) == expected, last.err);
    // A further one has nothing left to do.
    CHECK(Json::parse(cli.suite(arguments("--json")).out)["reused"] == CaseRepository::kCases);
  }
  CHECK(kills >= wanted);
}

}  // namespace
}  // namespace parallax::test
