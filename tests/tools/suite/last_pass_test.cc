// Report of a red case on the changes since it passed: the trace that was lost or gained, the
// axioms against it, the edit. As real processes.

#include <doctest/doctest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/suite/case_repository.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// A shop whose till opens for those who have paid; it passes once.
class Shop : public CliFixture {
 public:
  Shop() {
    fs::create_directories(folder() / "shop/parts");
    write("shop/parts/till.e",
          "fluent Paid(guest)\n"
          "fluent Open()\n"
          "event Pay(guest)\n"
          "event Pull()\n"
          "[guest,time] Initiates(Pay(guest),Paid(guest),time).\n"
          "[guest,time] HoldsAt(Paid(guest),time) -> Initiates(Pull(),Open(),time).\n"
          "!HoldsAt(Open(),0).\n"
          "[guest] !HoldsAt(Paid(guest),0).\n");
    write("shop/guests.e", "sort guest\nguest Ann, Bob\n");
    write("shop/calm.e",
          "[guest1,guest2,time] Happens(Pay(guest1),time) & Happens(Pay(guest2),time) ->\n"
          "  guest1=guest2.\n");
    write("shop/all.e", "load guests.e\nload parts/till.e\n");
    write("shop/suite.yaml",
          "cases:\n"
          "  - {id: counted, model: all.e, horizon: 2, constraints: 'HoldsAt(Open(),time)',\n"
          "     expect: {traces: 24}}\n"
          "  - {id: listed, model: [guests.e, parts/till.e, calm.e], horizon: 1,\n"
          "     expect: {golden: expected/listed.txt}}\n"
          "  - {id: apart, model: guests.e, horizon: 0, expect: {traces: 1}}\n");
    REQUIRE(suite({"--update-goldens"}).code == 0);
    REQUIRE(suite({}).code == 0);
  }
  ProcessResult suite(std::vector<std::string> more) const {
    more.insert(more.begin(), {"suite", "shop"});
    return parallax(std::move(more));
  }
  /// Problems reported for the one case.
  std::string problems(const std::string& id, std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--only", id, "--json"});
    const auto result = suite(std::move(more));
    CHECK(result.code == 1);
    const auto document = Json::parse(result.out);
    std::string out;
    for (const auto& one : document["cases"]) {
      for (const auto& problem : one["problems"]) out += problem.get<std::string>() + '\n';
    }
    return out;
  }
};

TEST_CASE("a case with a number of traces names one that was lost, the axiom and the edit") {
  const Shop cli;
  cli.write("shop/parts/till.e",
            cli.read("shop/parts/till.e") + "[time] !Happens(Pay(Bob),time).\n");
  const auto said = cli.problems("counted");
  CAPTURE(said);
  CHECK(holds(said, "traces, expected 24 traces"));
  CHECK(holds(said, "since it passed last, shop/parts/till.e changed; before/... is what it was"));
  CHECK(holds(said, "+ shop/parts/till.e:9  [time] !Happens(Pay(Bob),time)."));
  CHECK(holds(said, "lost: "));
  CHECK(holds(said, "a shortest such trace of before/shop/all.e, ruled out in shop/all.e"));
  CHECK(holds(said, "> Pay(Bob)"));
  CHECK(holds(said, "it contradicts\n      shop/parts/till.e:9  axiom"));
  CHECK(holds(said, "it depends on the edit"));
  CHECK_FALSE(holds(said, cli.folder().string()));
  // Nothing of the comparison is left behind.
  for (const auto& at : fs::directory_iterator(cli.folder() / "out/suite")) {
    CHECK_FALSE(at.path().filename().string().starts_with("since-"));
  }
  // The report contains it; once mended, nothing is reported.
  CHECK(cli.suite({"--junit", "r.xml"}).code == 1);
  CHECK(holds(cli.read("r.xml"), "since it passed last"));
  cli.replace("shop/parts/till.e", "[time] !Happens(Pay(Bob),time).\n", "");
  CHECK(cli.suite({}).out == "3 passed, 0 failed, 3 not run again\n");
}

TEST_CASE("a case of several models with a golden file names one that was gained") {
  const Shop cli;
  cli.write("shop/calm.e", "\n");
  const auto said = cli.problems("listed");
  CAPTURE(said);
  CHECK(holds(said, "the traces are not those of shop/expected/listed.txt"));
  CHECK(holds(said, "since it passed last, shop/calm.e changed"));
  CHECK(holds(said, "lost: none"));
  CHECK(holds(said, "> Pay(Ann)\n          > Pay(Bob)"));
  CHECK(holds(said, "before/shop/calm.e:1  axiom"));
}

TEST_CASE("a golden file alone names a trace that was lost, the axiom, and one that was gained") {
  const Shop cli;
  const auto calm = cli.read("shop/calm.e");
  cli.write("shop/calm.e", calm + "[time] !Happens(Pay(Bob),time).\n");
  const auto lost = cli.problems("listed", {"--no-cache"});
  CAPTURE(lost);
  CHECK(holds(lost, "lost: trace "));
  CHECK(holds(lost,
              " of shop/expected/listed.txt\n  0\n      > Pay(Bob)\n  1\n      + Paid(Bob)\n"
              "ruled out at timepoint 1: axiom: Happens(Pay(Bob),0) is true\n"
              "  shop/calm.e:3"));
  CHECK_FALSE(holds(lost, "gained: "));
  cli.write("shop/calm.e", "\n");
  const auto gained = cli.problems("listed", {"--no-cache"});
  CAPTURE(gained);
  CHECK(holds(gained, "gained: trace "));
  CHECK(holds(gained, "      > Pay(Ann)\n      > Pay(Bob)\n"));
  CHECK_FALSE(holds(gained, "lost: "));
  for (const auto& at : fs::directory_iterator(cli.folder() / "out/suite")) {
    CHECK_FALSE(at.path().extension() == ".jsonl");
  }
}

TEST_CASE("a file that is gone, a case that changed and a new program are named") {
  const Shop cli;
  cli.replace("shop/suite.yaml", "traces: 1}", "traces: 2}");
  CHECK(holds(cli.problems("apart"), "since it passed last, the case in shop/suite.yaml changed"));
  cli.write("shop/all.e", "load parts/till.e\n");
  fs::remove(cli.folder() / "shop/guests.e");
  cli.replace("shop/suite.yaml", "model: guests.e", "model: all.e");
  cli.replace("shop/suite.yaml", "[guests.e, parts/till.e, calm.e]", "all.e");
  const auto said = cli.problems("counted");
  CHECK_MESSAGE(holds(said, "since it passed last, shop/all.e, shop/guests.e (gone) changed"),
                said);
}

TEST_CASE("what passed in another folder, or is not to be kept, is not spoken of") {
  const Shop cli;
  cli.write("shop/calm.e", "\n");
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"--no-cache"}, {"--out", "elsewhere"}}) {
    CHECK_FALSE(holds(cli.problems("listed", other), "since it passed last"));
  }
}

TEST_CASE("a pass that was written over is not believed, and does no harm") {
  const Shop cli;
  cli.write("shop/calm.e", "\n");
  int changed = 0;
  for (const auto& at : fs::recursive_directory_iterator(cli.folder() / "out/suite/cache/passed")) {
    if (!at.is_regular_file()) continue;
    auto json = Json::parse(std::ifstream(at.path()));
    json["entry"]["texts"]["shop/calm.e"] = "[time] !Happens(Pull(),time).\n";
    json["entry"]["texts"]["../../outside.e"] = "boo\n";
    std::ofstream(at.path()) << (changed++ == 0 ? "" : json.dump());
  }
  CHECK(changed == 3);
  CHECK_FALSE(holds(cli.problems("listed"), "since it passed last"));
  CHECK_FALSE(fs::exists(cli.folder().parent_path() / "outside.e"));
  // A folder of that name that is not the suite's own stays as it is.
  cli.replace("shop/suite.yaml", "traces: 1}", "traces: 2}");
  cli.write("shop/calm.e", cli.read("shop/calm.e"));
  CHECK(cli.suite({}).code == 1);
}

TEST_CASE("a pass that had no trace left, and a rate, are held against what they were") {
  const CaseRepository cli;
  REQUIRE(cli.suite({}).code == 0);
  cli.replace("repository/boxes/wrong_domain.e", "[time] Initiates(PickUp(),Holding(),time).\n",
              "[region,time] HoldsAt(RobotIn(region),time) & HoldsAt(BoxIn(region),time) ->\n"
              "  Initiates(PickUp(),Holding(),time).\n");
  const auto result = cli.suite({"--only", "hasty"});
  CHECK(result.code == 1);
  CAPTURE(result.err);
  CHECK(holds(result.out, "since it passed last, repository/boxes/wrong_domain.e changed"));
  CHECK(holds(result.out, "- before/repository/boxes/wrong_domain.e:32"));
  CHECK(holds(result.out, "repository/boxes/wrong_domain.e:10  frame axiom: Holding()"));
}

}  // namespace
}  // namespace parallax::test
