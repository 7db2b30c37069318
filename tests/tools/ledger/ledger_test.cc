// The ledger of known discrepancies, as real processes: add, check, status, and its use by `suite`,
// `verify` and `report`.

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"
#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// A run of the model that picks up from anywhere, which fails at once, and its ledger.
class LedgerFixture : public CliFixture {
 public:
  LedgerFixture() {
    REQUIRE(parallax({"run", "wrong_model.yaml", "--out", "w", "--quiet"}).code == 1);
    const auto added = parallax({"ledger", "add", "w", "--revision", "r1"});
    CHECK_MESSAGE(added.code == 0, added.err);
  }
  ProcessResult ledger(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "ledger");
    return parallax(std::move(arguments));
  }
};

TEST_CASE("what a run shows is added once, and known from then on") {
  const LedgerFixture cli;
  const auto text = cli.read("ledger.yaml");
  CHECK_MESSAGE(holds(text,
                      "  - id: wrong_model.pickup\n"
                      "    scenario: wrong_model.yaml\n"
                      "    trace: []\n"
                      "    event: PickUp()\n"
                      "    outcome: out of reach\n"),
                text);
  CHECK(holds(text, "    first_seen: r1\n    status: open\n"));
  CHECK_MESSAGE(holds(text, "    model: wrong_domain.e:"), text);
  const auto again = cli.ledger({"add", "w"});
  CHECK(again.out == "nothing new\n");
  CHECK(cli.read("ledger.yaml") == text);
  const auto checked = cli.ledger({"check", "w"});
  CHECK(checked.code == 0);
  CHECK(holds(checked.out, "wrong_model.pickup: open"));
}

TEST_CASE("it is known again with other seeds, and where model and plan changed elsewhere") {
  const LedgerFixture cli;
  auto model = cli.read("wrong_domain.e");
  cli.write("wrong_domain.e", "; one line\n; more\nsort colour\ncolour red\n" + model);
  cli.write("ledger.yaml", "# ours\n" + cli.read("ledger.yaml"));
  REQUIRE(cli.parallax({"run", "wrong_model.yaml", "--out", "w2", "--seed", "9", "--quiet"}).code ==
          1);
  const auto checked = cli.ledger({"check", "w2", "w"});
  CHECK_MESSAGE(checked.code == 0, checked.out);
  // A copy of the folder elsewhere is the same scenario, if one says so.
  fs::create_directories(cli.folder() / "moved");
  cli.write("moved/ledger.yaml", cli.read("ledger.yaml"));
  CHECK(cli.ledger({"check", "w", "--ledger", "moved/ledger.yaml"}).code == 1);
  cli.write("moved/wrong_model.yaml", "name: x\n");
  CHECK(cli.ledger({"check", "w", "--ledger", "moved/ledger.yaml", "--scenario",
                    "moved/wrong_model.yaml"})
            .code == 0);
}

TEST_CASE("another discrepancy is not known, and the nearest entry says in what") {
  const LedgerFixture cli;
  cli.replace("ledger.yaml", "outcome: out of reach", "outcome: slipped");
  const auto checked = cli.ledger({"check", "w"});
  CHECK(checked.code == 1);
  CHECK_MESSAGE(holds(checked.out, "a discrepancy that the ledger does not know"), checked.out);
  CHECK(holds(checked.out, "`outcome`"));
  CHECK(json_of(cli, {"ledger", "check", "w"}, 1)["findings"][0]["is"] == "unknown");
  // Left out, it stands for any.
  cli.replace("ledger.yaml", "    outcome: slipped\n", "");
  CHECK(cli.ledger({"check", "w"}).code == 0);
}

TEST_CASE("what was decided stands in one line; what was repaired does not come back unseen") {
  const LedgerFixture cli;
  cli.write("ledger.yaml", "# reviewed by Ann\n" + cli.read("ledger.yaml") + "# the end\n");
  const auto before = cli.read("ledger.yaml");
  const std::string open = "status: open", id = "wrong_model.pickup";
  const auto with = [&](const std::string& status) {
    auto text = before;
    return text.replace(text.find(open), open.size(), status);
  };
  CHECK(cli.ledger({"status", id, "accepted", "--because", "it never happens: so"}).code == 0);
  CHECK(cli.read("ledger.yaml") == with("status: \"accepted because it never happens: so\""));
  CHECK(cli.ledger({"check", "w"}).code == 0);
  CHECK(cli.ledger({"status", id, "repaired", "--in", "abc123"}).code == 0);
  CHECK(cli.read("ledger.yaml") == with("status: repaired in abc123"));
  const auto back = cli.ledger({"check", "w"});
  CHECK(back.code == 1);
  CHECK_MESSAGE(holds(back.out, "wrong_model.pickup is repaired in abc123, and comes back"),
                back.out);
  CHECK(cli.ledger({"add", "w"}).code == 1);
  CHECK(cli.ledger({"status", id, "open"}).code == 0);
  CHECK(cli.read("ledger.yaml") == before);
  const auto list = json_of(cli, {"ledger", "list", "--status", "open"});
  CHECK(list["discrepancies"].size() == 1);
  CHECK(cli.ledger({"list", "--status", "accepted"}).out == "no discrepancies\n");
  for (const std::vector<std::string>& wrong : {std::vector<std::string>{"status", id, "accepted"},
                                                {"status", id, "repaired"},
                                                {"status", id, "open", "--because", "x"},
                                                {"status", id},
                                                {"status", "nobody", "open"},
                                                {"status", id, "gone"},
                                                {"check"},
                                                {"add"},
                                                {"list", "w"}}) {
    CHECK(cli.ledger(wrong).code == 2);
  }
  CHECK(cli.read("ledger.yaml") == before);
}

TEST_CASE("an entry that a clean run shows no more is named, and one without its scenario") {
  const CliFixture cli;
  cli.write("clean.yaml", "include: scenario.yaml\ncriterion: {epsilon: 0.5, confidence: 0.9}\n");
  REQUIRE(cli.parallax({"run", "clean.yaml", "--out", "c", "--quiet"}).code == 0);
  cli.write("ledger.yaml",
            "discrepancies:\n"
            "  - {id: here, scenario: clean.yaml, event: Place(r1), status: open}\n"
            "  - {id: done, scenario: clean.yaml, event: Place(r1), status: repaired in 1}\n"
            "  - {id: lost, scenario: gone.yaml, event: Place(r1), status: open}\n");
  const auto answer = json_of(cli, {"ledger", "check", "c"});
  REQUIRE(answer["stale"].size() == 2);
  CHECK(answer["stale"][0]["id"] == "here");
  CHECK(answer["stale"][1]["id"] == "lost");
}

TEST_CASE("a suite fails on what the ledger does not know, also where a discrepancy is expected") {
  const LedgerFixture cli;
  const auto suite = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"suite", "wrong_model.yaml"});
    return cli.parallax(more);
  };
  REQUIRE(suite({}).code == 0);
  const std::vector<std::string> with = {"--ledger", "ledger.yaml"};
  // A pass that was kept without a ledger does not count with one.
  CHECK(suite(with).out == "1 passed, 0 failed\n");
  CHECK(suite(with).out == "1 passed, 0 failed, 1 not run again\n");
  const auto known = cli.read("ledger.yaml");
  cli.write("ledger.yaml", known + "  - {id: x, scenario: edge.yaml, event: E(), status: open}\n");
  CHECK(suite(with).out == "1 passed, 0 failed, 1 not run again\n");  // not of this scenario
  cli.write("ledger.yaml", "discrepancies: []\n");
  const auto unknown = suite(with);
  CHECK(unknown.code == 1);
  CHECK_MESSAGE(holds(unknown.out, "a discrepancy that the ledger does not know: 1.1: PickUp()"),
                unknown.err);
  cli.write("ledger.yaml", known);
  CHECK(suite({"--ledger", "ledger.yaml", "--resume"}).out ==
        "1 passed, 0 failed, 1 not run again\n");
  REQUIRE(cli.ledger({"status", "wrong_model.pickup", "repaired", "--in", "77"}).code == 0);
  const auto back = suite({"--ledger", "ledger.yaml", "--resume"});
  CHECK(back.code == 1);
  CHECK_MESSAGE(holds(back.out, "is repaired in 77, and comes back"), back.err);
}

TEST_CASE("a verified property says which discrepancies it rests on, and which it does not") {
  const CliFixture cli;
  cli.write(
      "ledger.yaml",
      "discrepancies:\n"
      "  - id: edge\n"
      "    scenario: edge.yaml\n"
      "    trace: [Go(r2), PickUp(), Go(r1)]\n"
      "    event: Place(r1)\n"
      "    status: open\n"
      "  - {id: any, scenario: edge.yaml, event: PickUp(), status: accepted because so}\n"
      "  - {id: not-there, scenario: edge.yaml, trace: [PickUp()], event: Go(r1), status: open}\n"
      "  - {id: never, scenario: edge.yaml, event: Fly(), status: open}\n"
      "  - {id: done, scenario: edge.yaml, event: PickUp(), status: repaired in 3}\n"
      "  - {id: other, scenario: scenario.yaml, event: PickUp(), status: open}\n");
  const std::string everywhere = "{region} HoldsAt(RobotIn(region),time)";
  const std::vector<std::string> verify = {"verify", "edge.yaml", "--ledger", "ledger.yaml",
                                           "--property"};
  const auto ask = [&](const std::string& property, int code) {
    auto arguments = verify;
    arguments.push_back(property);
    std::vector<std::string> ids;
    const auto answer = json_of(cli, arguments, code);
    for (const auto& one : answer["rests_on"]) ids.push_back(one["id"]);
    return ids;
  };
  CHECK(ask(everywhere, 0) == std::vector<std::string>{"edge", "any"});
  // Violated before anything is picked up, and after it.
  CHECK(ask("HoldsAt(RobotIn(r1),time)", 1).empty());
  CHECK(ask("!HoldsAt(Holding(),time)", 1) == std::vector<std::string>{"any"});
  auto arguments = verify;
  arguments.push_back(everywhere);
  const auto text = cli.parallax(arguments);
  CHECK(text.code == 0);
  CHECK_MESSAGE(holds(text.out, "it rests on executions through known discrepancies"), text.out);
  CHECK(holds(text.out, "edge (open)"));
  CHECK(holds(text.out, "any (accepted because so)"));
  // Up to a horizon that ends before it, nothing gets there.
  cli.replace("edge.yaml", "horizon: 6", "horizon: 1");
  CHECK(holds(cli.parallax(arguments).out, "rests on no discrepancy"));
  CHECK(cli.parallax({"verify", "domain.e", "--property", everywhere, "--ledger", "ledger.yaml"})
            .code == 2);
}

TEST_CASE("the page says what of a run is known and what properties rest on") {
  const LedgerFixture cli;
  const auto made = cli.parallax({"report", "w", "-o", "w.html", "--ledger", "ledger.yaml",
                                  "--property", "{region} HoldsAt(RobotIn(region),time)"});
  CHECK_MESSAGE(made.code == 0, made.err);
  const auto page = cli.read("w.html");
  CHECK(holds(page, "Known discrepancies"));
  CHECK(holds(page, "wrong_model.pickup"));
  CHECK(holds(page, "to be reviewed by people"));
  CHECK(cli.parallax({"report", "w", "-o", "w.html", "--ledger", "nowhere.yaml"}).code == 2);
  CHECK(cli.parallax({"report", "w", "-o", "w.html", "--property", "x"}).code == 2);
  CHECK(cli.parallax({"report", "w", "-o", "w.html", "--ledger", "ledger.yaml", "--property",
                      "HoldsAt(Nonsense(),time)"})
            .code == 3);
}

TEST_CASE("bad ledgers and bad runs: a message where it stands") {
  const LedgerFixture cli;
  const auto refused = [&](const std::string& text, int code, const std::string& why) {
    cli.write("bad.yaml", text);
    const auto result = cli.ledger({"check", "w", "--ledger", "bad.yaml"});
    CHECK(result.code == code);
    CHECK_MESSAGE(holds(result.err, why), result.err);
  };
  const std::string good = "  - {id: a, scenario: s.yaml, event: E(), status: open}\n";
  const auto with = [](const std::string& entry) {
    return "discrepancies:\n  - {" + entry + "}\n";
  };
  refused("discrepancies:\n" + good + good, 3, "bad.yaml:3:");
  refused("discrepencies:\n" + good, 3, "discrepancies");
  refused("discrepancies: 5\n", 3, "a list of discrepancies");
  refused("", 3, "bad.yaml");
  refused(with("id: a, scenario: s, event: E(), status: accepted because"), 3,
          "accepted because TEXT");
  refused(with("id: a, scenario: s, event: E(), status: shut"), 3, "`shut`");
  refused(with("id: a, scenario: s, status: open"), 3, "event");
  refused(with("id: a, scenario: s, event: E(), status: open, fluent: x"), 3, "fluents");
  refused(with("id: ../a, scenario: s, event: E(), status: open"), 3, "an id");
  refused(with("id: a, scenario: s, event: E(), status: open, trace: E()"), 3, "a list");
  refused("discrepancies: [\n", 3, "bad.yaml");
  CHECK(cli.ledger({"check", "w", "--ledger", "nowhere.yaml"}).code == 2);
  CHECK(cli.ledger({"check", "nowhere"}).code == 2);
  CHECK(cli.ledger({"check", "."}).code == 2);
  fs::create_directories(cli.folder() / "h");
  cli.write("h/report.json", "{\"traces\": 1}");
  CHECK(cli.ledger({"check", "h"}).code == 3);
  cli.write("h/report.json",
            "{\"traces\":[],\"scenario\":\"a\\u001b[2Jb.yaml\",\"discrepancies\":[{\"trace\":1,"
            "\"words\":\"\\u001b]0;x\\u0007 \\u202e\",\"cause\":{\"text\":\"\\u001b: "
            "b\\nc\",\"event\":\"\\u001b\","
            "\"reason\":\"b\\nc\"}}]}");
  const auto odd = cli.ledger({"check", "h"});
  CHECK(odd.code == 1);
  CHECK(odd.out.find('\x1b') == std::string::npos);
  const auto added = cli.ledger({"add", "h", "--ledger", "odd.yaml"});
  CHECK_MESSAGE(added.code == 0, added.err);
  CHECK(added.out.find('\x1b') == std::string::npos);
  CHECK(cli.read("odd.yaml").find('\x1b') == std::string::npos);
  CHECK(cli.ledger({"check", "h", "--ledger", "odd.yaml"}).code == 0);
}

}  // namespace
}  // namespace parallax::test
