// Mistakes in what a model says of timepoint 0: the world excludes its starts.

#include <filesystem>

#include "tests/tools/repair/mistaken_world.h"

namespace parallax::test {
namespace {

constexpr const char* kStart =
    "[door] HoldsAt(Shut(door),0).\n[door] HoldsAt(Locked(door),0) <-> door=left.\n"
    "!HoldsAt(Lit(),0).\n";

/// Two doors, of which one is locked, and a way that is dark: the light is off.
struct Doors : CliFixture {
  Doors(const std::string& right, const std::string& wrong, const std::string& world = kStart,
        const std::string& law = "") {
    const std::string truth =
        "sort door\ndoor left, right\n"
        "fluent Shut(door)\nfluent Locked(door)\nfluent Lit()\nfluent Way()\nnoninertial Way\n"
        "event Open(door)\nevent Unlock(door)\nevent Press()\n\n"
        "[door,time] !HoldsAt(Locked(door),time) -> Terminates(Open(door),Shut(door),time).\n"
        "[door,time] Terminates(Unlock(door),Locked(door),time).\n"
        "[time] Initiates(Press(),Lit(),time).\n"
        "[time] HoldsAt(Way(),time) <-> !HoldsAt(Shut(right),time) & !HoldsAt(Lit(),time).\n" +
        law;
    write("truth.e", truth);
    write("model.e", truth);
    write("truth_start.e", world);
    write("start.e", kStart);
    const bool in_start = std::string(kStart).find(right) != std::string::npos;
    replace(in_start ? "start.e" : "model.e", right, wrong);
    write("plan.lisp",
          "(perform (an action (type opening) (door :right)))\n"
          "(perform (an action (type pressing)))\n"
          "(perform (an action (type unlocking) (door :left)))\n");
    write("robot.bind",
          "action opening (:door ?d) -> Open(?d) ok: !Shut(?d) @t+1 else "
          "navigation-low-level-failure\n"
          "action pressing () -> Press() ok: Lit() @t+1 else manipulation-goal-not-reached\n"
          "action unlocking (:door ?d) -> Unlock(?d) ok: !Locked(?d) @t+1 else "
          "manipulation-goal-not-reached\n");
    write("own.yaml",
          "plan: plan.lisp\nbind: robot.bind\nhorizon: 3\nmodel: [model.e, start.e]\n"
          "simulator: {model: [truth.e, truth_start.e]}\nconstraints: \"time=3\"\n"
          "execution: closed-loop\n");
  }

  ProcessResult run() const { return parallax({"run", "own.yaml", "--out", "out"}); }

  /// Repairs the start; afterwards model and world have the same traces, of any plan.
  nlohmann::json first() const {
    const auto ended = run();
    CAPTURE(ended.err);
    CHECK(ended.code == 3);
    CHECK(ended.err.find("E7105") != std::string::npos);
    const auto report = json_of(*this, {"repair", "out"}, 1);
    CAPTURE(report.dump(1));
    CHECK(report.at("partings").size() == 1);
    CHECK(report.at("partings").at(0).at("timepoint") == 0);
    CHECK(report.at("proposals").at(0).at("only_begins") == false);
    CHECK(parallax({"repair", "out", "--apply", "1"}).code == 0);
    CAPTURE(read("start.e"));
    CAPTURE(read("model.e"));
    write("all_model.e", "load model.e\nload start.e\n");
    write("all_truth.e", "load truth.e\nload truth_start.e\n");
    const auto differs =
        parallax({"diff", "all_model.e", "all_truth.e", "--horizon", "2", "--traces-only"});
    CAPTURE(differs.out);
    CHECK(differs.code == 0);
    std::filesystem::remove_all(folder() / "out");
    CHECK(run().code == 0);
    return report;
  }
};

TEST_CASE("a constraint that contradicts the start, so that the model has no execution") {
  const std::string right = "HoldsAt(Lit(),time) -> !HoldsAt(Shut(right),time)";
  for (const std::string wrong : {"!HoldsAt(Lit(),time) -> !HoldsAt(Shut(right),time)",
                                  "!HoldsAt(Lit(),time) & !HoldsAt(Shut(right),time)"}) {
    CAPTURE(wrong);
    const Doors cli(right, wrong, kStart, "[time] " + right + ".\n");
    CHECK(cli.run().err.find("E7001") != std::string::npos);
    const auto report = json_of(cli, {"repair", "out"}, 1);
    CAPTURE(report.dump(1));
    // Only the constraint is changed or dropped, as all else is right.
    for (const auto& each : report.at("proposals")) {
      CHECK(mentions(each.at("words"), "(model.e:16)"));
    }
    CHECK(mentions(report.at("proposals").at(1).at("words"), "in the place of"));
    CHECK(cli.parallax({"repair", "out", "--apply", "2"}).code == 0);
    std::filesystem::remove_all(cli.folder() / "out");
    CHECK(cli.run().code == 0);
  }
}

TEST_CASE("the start says the opposite of what the world has") {
  const Doors cli("!HoldsAt(Lit(),0)", "HoldsAt(Lit(),0)");
  const auto report = cli.first();
  CHECK(report.at("partings").at(0).at("fluents").at(0).at("fluent") == "Lit()");
  CHECK(report.at("partings").at(0).at("fluents").at(0).at("observed") == false);
}

TEST_CASE("the start names another constant") {
  const auto words =
      Doors("door=left", "door=right").first().at("proposals").at(0).at("words").get<std::string>();
  CHECK(mentions(words, "with `left` in the place of `right`"));
}

TEST_CASE("the start leaves open what the world determines") {
  const Doors cli("[door] HoldsAt(Shut(door),0).", "[door] door!=left -> HoldsAt(Shut(door),0).");
  CHECK(cli.run().code == 3);
  CHECK(mentions(cli.parallax({"repair", "out"}).out, "of 2 starts of the model"));
  std::filesystem::remove_all(cli.folder() / "out");
  const auto report = cli.first();
  CHECK(mentions(report.at("proposals").at(0).at("words"), "also without the condition"));
}

TEST_CASE("a start that is one of several of the world is not wrong") {
  const Doors cli("!HoldsAt(Lit(),0)", "HoldsAt(Lit(),0)",
                  "[door] HoldsAt(Shut(door),0).\n[door] HoldsAt(Locked(door),0) <-> door=left.\n");
  CHECK(cli.run().code == 0);
  CHECK(cli.parallax({"repair", "out"}).code == 0);
}

const std::string kWay =
    "[time] HoldsAt(Way(),time) <-> !HoldsAt(Shut(right),time) & !HoldsAt(Lit(),time).\n";

TEST_CASE("a definition that is missing is found, and facts that leave the fluent open say so") {
  const Doors cli(kWay, "");
  CHECK(cli.run().code == 3);
  const auto proposals = json_of(cli, {"repair", "out"}, 1).at("proposals");
  CAPTURE(proposals.dump(1));
  CHECK(mentions(proposals.at(0).at("words"), "a definition is missing: "));
  CHECK(proposals.at(0).at("leaves_open") == "");
  int facts = 0, right = 0;
  for (const auto& proposal : proposals) {
    const bool is_fact = mentions(proposal.at("words"), "a fact of the start is missing");
    facts += is_fact ? 1 : 0;
    CHECK(proposal.at("leaves_open") == (is_fact ? "Way()" : ""));
    right += mentions(proposal.at("patch"), "+" + kWay) ? 1 : 0;
  }
  CHECK(facts > 0);
  CHECK(right == 1);
}

TEST_CASE("a definition that is wrong at the start is told from wrong facts by a run of the plan") {
  const std::string body = "!HoldsAt(Shut(right),time) & !HoldsAt(Lit(),time)";
  for (const std::string wrong :
       {"HoldsAt(Shut(right),time) & !HoldsAt(Lit(),time)", "!HoldsAt(Lit(),time)"}) {
    CAPTURE(wrong);
    const auto report = Doors(body, wrong).first();
    CHECK(report.at("proposals").at(0).at("leaves_open") == "");
    CHECK(report.at("sequences_choosing") >= 1);
  }
}

TEST_CASE("the text names what the world has at the start") {
  const Doors cli("!HoldsAt(Lit(),0)", "HoldsAt(Lit(),0)");
  cli.run();
  const auto text = cli.parallax({"repair", "out"}).out;
  CHECK(mentions(text, "the start: at 0 the world has, and the model cannot have: not Lit()"));
}

}  // namespace
}  // namespace parallax::test
