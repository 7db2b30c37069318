// `parallax prove`: its output, its certificate, and the cases that it refuses.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

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
  CHECK(document["initial_states"] == Json{{"all", 6}, {"proved", 6}});
  REQUIRE(document["states"].size() == 6);
  std::set<std::string> held;
  for (const auto& state : document["states"]) {
    const auto& test = test_of(state, "Drive::is_blocked");
    CHECK(test["safe"] == 1.0);
    CHECK(test["assumed"].empty());
    CHECK(state["simulated"][0]["safe"]["starts"] == 3);
    CHECK(state["simulated"][0]["safe"]["refused"] == 0);
    CHECK(state["simulated"][0]["not_as_assumed"] == 0);
    held.insert(state["initial_state"]["holds"].get<std::string>());
  }
  CHECK(held.size() == 6);
}

TEST_CASE("prove: one initial state, by its number, and a certificate for each") {
  const CliFixture cli;
  const std::vector<std::string> prove = {"prove", kitchen("plan3.yaml"), "--action", "0"};
  const auto with = [&](std::vector<std::string> more) {
    auto all = prove;
    all.insert(all.end(), more.begin(), more.end());
    return cli.parallax(all);
  };
  REQUIRE(with({"--out", "a.proof.json"}).code == 0);
  const auto one = with({"--state", "2", "--json"});
  REQUIRE(one.code == 0);
  const auto document = Json::parse(one.out);
  CHECK(document["initial_states"] == Json{{"all", 6}, {"proved", 1}});
  const auto certificate = Json::parse(cli.read("a.2.proof.json"));
  CHECK(certificate["initial_state"] == document["initial_state"]);
  CHECK(certificate["region"] == document["region"]);
  CHECK(certificate["region"] != Json::parse(cli.read("a.1.proof.json"))["region"]);

  const auto checked = cli.parallax({"prove", kitchen("plan3.yaml"), "--check", "a.2.proof.json"});
  CHECK(checked.code == 0);
  CHECK(says(checked.out, "from " + document["initial_state"]["holds"].get<std::string>() +
                              " (initial state 2 of 6)"));
  const auto refuses = [&](const Json& state) {
    auto forged = certificate;
    forged["initial_state"] = state;
    cli.write("forged.json", forged.dump());
    const auto ran = cli.parallax({"prove", kitchen("plan3.yaml"), "--check", "forged.json"});
    CAPTURE(state.dump());
    CHECK(ran.code == 3);
    CHECK(says(ran.err, "E7127"));
  };
  refuses({{"number", 3}, {"holds", document["initial_state"]["holds"]}});
  refuses({{"number", 7}, {"holds", document["initial_state"]["holds"]}});
  refuses({{"number", 0}, {"holds", ""}});
  refuses("the second");
  // One that names no initial state was made of the first.
  auto older = Json::parse(cli.read("a.1.proof.json"));
  older.erase("initial_state");
  cli.write("older.json", older.dump());
  CHECK(cli.parallax({"prove", kitchen("plan3.yaml"), "--check", "older.json"}).code == 0);
  const auto beyond = with({"--state", "7"});
  CHECK(beyond.code == 2);
  CHECK(says(beyond.err, "trace 1 has 6 initial states"));
}

TEST_CASE("prove: a certificate is written, checked, and noticed when it was changed") {
  const CliFixture cli;
  const std::vector<std::string> prove = {"prove",    kitchen("plan2.yaml"),
                                          "--trace",  "2",
                                          "--state",  "1",
                                          "--action", "10",
                                          "--assume", "dMid.q=0.447:0.452",
                                          "--boxes",  "3000",
                                          "--out",    "proof.json"};
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
  CHECK(says(checked.out, "Drive::is_blocked: confirmed of the start region safe "));
  CHECK(says(checked.out, "given      OpenDrawer(left,dMid): dMid.q is 0.447 to 0.452 m"));
  CHECK(says(checked.out, "dMid.q=0.447:0.452 (not by default)"));
  CHECK(says(checked.out, "by default drift=0.002, "));
  CHECK(checked.err.empty());
  // With --assume the assumptions are the caller's, and not those of the file.
  const std::vector<std::string> granted = {"prove", kitchen("plan2.yaml"), "--check", "proof.json",
                                            "--assume"};
  auto same = granted, other_range = granted;
  same.emplace_back("dMid.q=0.447:0.452");
  other_range.emplace_back("dMid.q=0.44:0.46");
  CHECK(cli.parallax(same).code == 0);
  CHECK(cli.parallax(other_range).code == 3);

  const auto other = cli.parallax({"prove", kitchen("plan3.yaml"), "--check", "proof.json"});
  CHECK(other.code != 0);
  CHECK(other.code != 1);

  auto changed = Json::parse(first);
  auto& test = changed["actions"][0]["tests"][0];
  for (auto& box : test["boxes"]) {
    if (box["verdict"] == "refuted") box["verdict"] = "safe";
  }
  cli.write("changed.json", changed.dump());
  const auto shares = cli.parallax({"prove", kitchen("plan2.yaml"), "--check", "changed.json"});
  CHECK(shares.code == 3);
  CHECK(says(shares.err, "`safe` of `Drive::is_blocked` is "));
  test["safe"] = test["safe"].get<double>() + test["refuted"].get<double>();
  test["refuted"] = 0.0;
  cli.write("changed.json", changed.dump());
  const auto wrong = cli.parallax({"prove", kitchen("plan2.yaml"), "--check", "changed.json"});
  CHECK(wrong.code == 1);

  changed["region"][0][0] = changed["region"][0][0].get<double>() - 0.5;
  cli.write("moved.json", changed.dump());
  const auto moved = cli.parallax({"prove", kitchen("plan2.yaml"), "--check", "moved.json"});
  CHECK(moved.code == 3);
  CHECK(says(moved.err, "E7127"));
}

TEST_CASE("prove: a certificate's own assumptions are not believed") {
  const CliFixture cli;
  REQUIRE(cli.parallax({"prove", kitchen("plan2.yaml"), "--trace", "2", "--state", "1", "--action",
                        "10", "--boxes", "40", "--out", "proof.json"})
              .code == 4);
  const auto proof = Json::parse(cli.read("proof.json"));
  const auto check = [&](const Json& document) {
    cli.write("forged.json", document.dump());
    return cli.parallax({"prove", kitchen("plan2.yaml"), "--check", "forged.json"});
  };
  // Nothing is decided: nothing can be confirmed.
  const auto open = check(proof);
  CHECK(open.code == 4);
  CHECK(says(open.out, "nothing was confirmed"));
  auto all_safe = proof;
  auto& test = all_safe["actions"][0]["tests"][0];
  test.update({{"safe", 1.0}, {"refuted", 0.0}, {"open", 0.0}, {"examined", 1}});
  test["unconfirmed"] = 0;
  test["boxes"] = {{{"verdict", "safe"}, {"bounds", proof["region"]}}};
  const auto believed = check(all_safe);
  CHECK((believed.code == 1 || believed.code == 4));
  for (const auto& value : {Json(-1), Json(-1e-9), Json(11), Json(nullptr), Json("0.002")}) {
    auto forged = all_safe;
    forged["assumptions"]["drift"] = value;
    const auto refused = check(forged);
    CAPTURE(value.dump());
    CHECK(refused.code == 3);
    CHECK(says(refused.err, "E7127"));
  }
  auto impossible = all_safe;
  impossible["assumptions"]["sliders"]["dMid.q"] = {5.0, 6.0};
  CHECK(says(check(impossible).err, "its stops do not let it go there"));
  auto nothing = proof;
  nothing["actions"] = Json::array();
  CHECK(check(nothing).code == 4);
  auto other_texts = proof;
  other_texts["scenario_hash"] = "0123";
  CHECK(says(check(other_texts).err, "W7176"));
}

TEST_CASE("prove: a simulation that contradicts a certificate is told") {
  const KitchenCopy cli;
  // An arm so short that from some starts the handle is out of reach.
  const std::string shoulder = "shoulder_m: [0.05, 0.188, 0.79]\n      ";
  cli.replace("kitchen/world.yaml", shoulder + "reach_m: [0.25, 0.95]",
              shoulder + "reach_m: [0.25, 0.64]");
  const std::string plan = (cli.folder() / "kitchen/plan2.yaml").string();
  REQUIRE(cli.parallax({"prove", plan, "--trace", "2", "--state", "1", "--action", "0", "--boxes",
                        "1", "--out", "proof.json"})
              .code == 4);
  auto proof = Json::parse(cli.read("proof.json"));
  const auto check = [&](const std::string& verdict) {
    auto& test = proof["actions"][0]["tests"][0];
    test["boxes"][0]["verdict"] = verdict;
    for (const char* share : {"safe", "refuted", "open"})
      test[share] = share == verdict ? 1.0 : 0.0;
    test["unconfirmed"] = 0;
    cli.write("one.json", proof.dump());
    return cli.parallax({"prove", plan, "--check", "one.json", "--simulate", "12"});
  };
  // As it is, one open box: nothing can contradict it.
  const auto open = check("open");
  CAPTURE(open.err);
  CHECK(open.code == 4);
  CHECK(says(open.out, "simulated  refused: 0 of 0 safe, 0 of 0 refuted, "));
  // A verdict that the middle of the box contradicts is wrong, whatever simulations say.
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
  const auto ran =
      cli.parallax({"prove", kitchen("plan3.yaml"), "--action", "5", "--boxes", "600", "--json",
                    "--simulate", "3", "--assume", "sliding=0.004", "--state", "1"});
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
                                "dTop.q=2:1", "dTop.q=", "dTop.q=5:6", "="}) {
    const auto bad = cli.parallax({"prove", kitchen("plan3.yaml"), "--assume", given});
    CAPTURE(given);
    CHECK(bad.code == 2);
    CHECK(says(bad.err, "E0007"));
  }
  cli.write("mine.json", "{\"mine\":1}");
  const auto kept = cli.parallax(
      {"prove", kitchen("plan3.yaml"), "--action", "0", "--state", "1", "--out", "mine.json"});
  CHECK(kept.code == 2);
  CHECK(cli.read("mine.json") == "{\"mine\":1}");
  const auto foreign = cli.parallax({"prove", kitchen("plan3.yaml"), "--check", "mine.json"});
  CHECK(foreign.code == 3);
  CHECK(says(foreign.err, "it is no geometry proof of parallax"));
  CHECK(cli.parallax({"prove", kitchen("plan3.yaml"), "--check", "absent.json"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
