// `parallax prove`: what it prints, its certificate, and what it refuses.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/cli_fixture.h"
#include "tests/tools/kitchen_copy.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

std::string kitchen(const std::string& name) {
  return std::string(PARALLAX_SOURCE_DIR) + "/scenarios/kitchen/" + name;
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

const Json& test_of(const Json& document, const std::string& function) {
  static const Json kNone;
  for (const auto& action : document["actions"]) {
    for (const auto& test : action["tests"]) {
      if (test["function"] == function) return test;
    }
  }
  return kNone;
}

TEST_CASE("prove: the first drive of a plan is decided from the start alone") {
  const CliFixture cli;
  const auto ran =
      cli.parallax({"prove", kitchen("plan3.yaml"), "--action", "0", "--json", "--simulate", "3"});
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  const auto document = Json::parse(ran.out);
  const auto& test = test_of(document, "Drive::is_blocked");
  CHECK(test["safe"] == 1.0);
  CHECK(test["assumed"].empty());
  CHECK(document["simulated"][0]["safe"]["starts"] == 3);
  CHECK(document["simulated"][0]["safe"]["refused"] == 0);
  CHECK(document["simulated"][0]["not_as_assumed"] == 0);
}

TEST_CASE("prove: a certificate is written, checked, and noticed when it was changed") {
  const CliFixture cli;
  const std::vector<std::string> prove = {
      "prove",    kitchen("plan2.yaml"), "--trace", "2",    "--action", "10",
      "--assume", "dMid.q=0.447:0.452",  "--boxes", "3000", "--out",    "proof.json"};
  const auto ran = cli.parallax(prove);
  CAPTURE(ran.err);
  CAPTURE(ran.out);
  REQUIRE(ran.code == 1);
  CHECK(says(ran.out, "Drive::is_blocked (harness/robot/mobile_drive.cc)"));
  CHECK(says(ran.out, "`base` would meet `drawer_mid`"));
  CHECK(says(ran.out, "given      OpenDrawer(left,dMid): dMid.q is 0.447 to 0.452 m"));
  const std::string first = cli.read("proof.json");
  REQUIRE(cli.parallax(prove).code == 1);  // its own output is replaced
  CHECK(cli.read("proof.json") == first);

  const auto checked = cli.parallax({"prove", kitchen("plan2.yaml"), "--check", "proof.json"});
  CAPTURE(checked.out);
  CHECK(checked.code == 0);
  CHECK(says(checked.out, ", 0 not confirmed, 0 wrong"));

  const auto other = cli.parallax({"prove", kitchen("plan3.yaml"), "--check", "proof.json"});
  CHECK(other.code != 0);
  CHECK(other.code != 1);

  auto changed = Json::parse(first);
  for (auto& box : changed["actions"][0]["tests"][0]["boxes"]) {
    if (box["verdict"] == "refuted") box["verdict"] = "safe";
  }
  cli.write("changed.json", changed.dump());
  const auto wrong = cli.parallax({"prove", kitchen("plan2.yaml"), "--check", "changed.json"});
  CHECK(wrong.code == 1);

  changed["region"][0][0] = changed["region"][0][0].get<double>() - 0.5;
  cli.write("moved.json", changed.dump());
  const auto moved = cli.parallax({"prove", kitchen("plan2.yaml"), "--check", "moved.json"});
  CHECK(moved.code == 3);
  CHECK(says(moved.err, "E7127"));
}

TEST_CASE("prove: a simulation that contradicts a certificate is told") {
  const KitchenCopy cli;
  // An arm so short that from some starts the handle is out of reach.
  const std::string shoulder = "shoulder_m: [0.05, 0.188, 0.79]\n      ";
  cli.replace("kitchen/world.yaml", shoulder + "reach_m: [0.25, 0.95]",
              shoulder + "reach_m: [0.25, 0.64]");
  const std::string plan = (cli.folder() / "kitchen/plan2.yaml").string();
  REQUIRE(cli.parallax({"prove", plan, "--trace", "2", "--action", "0", "--boxes", "1", "--out",
                        "proof.json"})
              .code == 4);
  auto proof = Json::parse(cli.read("proof.json"));
  const auto check = [&](const char* verdict) {
    proof["actions"][0]["tests"][0]["boxes"][0]["verdict"] = verdict;
    cli.write("one.json", proof.dump());
    return cli.parallax({"prove", plan, "--check", "one.json", "--simulate", "12"});
  };
  // As it is, one open box: nothing can contradict it.
  const auto open = check("open");
  CAPTURE(open.err);
  CHECK(open.code == 0);
  CHECK(says(open.out, "simulated  refused: 0 of 0 safe, 0 of 0 refuted, "));
  // What the middle of the box contradicts is wrong, whatever simulations say.
  const auto refuted = check("refuted");
  CHECK(says(refuted.out, "0 boxes confirmed, 0 not confirmed, 1 wrong"));
  CHECK(refuted.code == 1);
  const auto safe = check("safe");
  CAPTURE(safe.out);
  CHECK(says(safe.out, "0 boxes confirmed, 1 not confirmed, 0 wrong"));
  CHECK(says(safe.err, "E7128"));
  CHECK(safe.code == 5);
}

TEST_CASE("prove: the hand's way down into a drawer, against what simulations show") {
  const CliFixture cli;
  const auto ran = cli.parallax({"prove", kitchen("plan3.yaml"), "--action", "5", "--boxes", "600",
                                 "--json", "--simulate", "3", "--assume", "sliding=0.004"});
  CAPTURE(ran.err);
  REQUIRE((ran.code == 1 || ran.code == 4));  // no simulation contradicts it
  const auto document = Json::parse(ran.out);
  const auto& test = test_of(document, "PickUp::check_last_stretch");
  const double all =
      test["safe"].get<double>() + test["refuted"].get<double>() + test["open"].get<double>();
  CHECK(all == doctest::Approx(1.0));
  std::int64_t seen = document["simulated"][0]["not_as_assumed"].get<std::int64_t>();
  for (const char* verdict : {"safe", "refuted", "open"}) {
    seen += document["simulated"][0][verdict]["starts"].get<std::int64_t>();
  }
  CHECK(seen == 3);
}

TEST_CASE("prove: what cannot be proved is refused with its reason") {
  const CliFixture cli;
  const auto line = cli.parallax({"prove", "edge.yaml"});
  CHECK(line.code == 3);
  CHECK(says(line.err, "E7126"));
  CHECK(says(line.err, "its world has no mobile robot"));
  const auto none = cli.parallax({"prove", kitchen("plan3.yaml"), "--trace", "99"});
  CHECK(none.code == 2);
  CHECK(says(none.err, "E7304"));
  const auto beyond = cli.parallax({"prove", kitchen("plan3.yaml"), "--action", "99"});
  CHECK(beyond.code == 2);
  CHECK(says(beyond.err, "trace 1 has events 0 to 5"));
  for (const std::string& given :
       std::vector<std::string>{"drift", "drift=-1", "drift=nan", "drift=1x", "nothing=1",
                                "dTop.q=2:1", "dTop.q=", "="}) {
    const auto bad = cli.parallax({"prove", kitchen("plan3.yaml"), "--assume", given});
    CAPTURE(given);
    CHECK(bad.code == 2);
    CHECK(says(bad.err, "E0007"));
  }
  cli.write("mine.json", "{\"mine\":1}");
  const auto kept =
      cli.parallax({"prove", kitchen("plan3.yaml"), "--action", "0", "--out", "mine.json"});
  CHECK(kept.code == 2);
  CHECK(cli.read("mine.json") == "{\"mine\":1}");
  const auto foreign = cli.parallax({"prove", kitchen("plan3.yaml"), "--check", "mine.json"});
  CHECK(foreign.code == 3);
  CHECK(says(foreign.err, "it is no geometry proof of parallax"));
  CHECK(cli.parallax({"prove", kitchen("plan3.yaml"), "--check", "absent.json"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
