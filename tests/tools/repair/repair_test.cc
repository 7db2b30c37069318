// `parallax repair` against worlds that are models, so that the mistake is known.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"
#include "tests/tools/two_models.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

ProcessOptions in_folder(const CliFixture& cli) {
  ProcessOptions options;
  options.folder = cli.folder().string();
  return options;
}

const std::string kMissing = "Terminates(OpenDrawer(drawer),Parked(),time)";

TEST_CASE("a forgotten effect: the first proposal has it, git applies it, and the run is clean") {
  const TwoModels cli;
  json_of(cli, {"run", "two/unparks.yaml", "--out", "out"}, 1);
  const auto before = files_below(cli.folder());
  const auto report = json_of(cli, {"repair", "out"}, 1);
  CHECK(files_below(cli.folder()) == before);
  const auto& first = report.at("proposals").at(0);
  CHECK(first.at("words").get<std::string>().find(kMissing) != std::string::npos);
  CHECK(first.at("runs_consistent") == first.at("runs"));
  CHECK(first.at("traces_lost") == 1);
  CHECK(first.at("traces_gained") == 1);
  CHECK(first.at("reaches_constraints") == true);
  CHECK(report.at("partings").at(0).at("event") == "OpenDrawer(top)");
  CHECK(report.at("experiments") == 0);

  // The patch of each proposal is accepted by git, and is what --apply writes.
  for (const auto& proposal : report.at("proposals")) {
    cli.write("p.diff", proposal.at("patch").get<std::string>());
    const auto checked = run_process({"git", "apply", "--check", "p.diff"}, in_folder(cli));
    CHECK_MESSAGE(checked.code == 0, checked.err << proposal.at("patch"));
  }
  cli.write("p.diff", first.at("patch").get<std::string>());
  const auto original = cli.read("two/opens.e");
  CHECK(run_process({"git", "apply", "p.diff"}, in_folder(cli)).code == 0);
  const auto patched = cli.read("two/opens.e");
  CHECK(patched == original + "[drawer,time] " + kMissing + ".\n");
  cli.write("two/opens.e", original);
  CHECK(cli.parallax({"repair", "out", "--apply", "1"}).code == 0);
  CHECK(cli.read("two/opens.e") == patched);
  CHECK(json_of(cli, {"run", "two/unparks.yaml", "--epsilon", "0.3", "--out", "again"})
            .at("verdict") == "no-discrepancy");
}

TEST_CASE("runs that explain made to tell the kind of cause are evidence, too") {
  const TwoModels cli;
  // The first run fails; of further ones from the same start half do not.
  json_of(cli, {"run", "two/sticks.yaml", "--out", "out", "--seed", "2"}, 1);
  const auto alone = json_of(cli, {"repair", "out"}, 1);
  const int runs = alone.at("proposals").at(0).at("runs");
  const auto told = json_of(cli, {"explain", "out"}, 1);
  const int further = told.at("evidence").at("further");
  REQUIRE(further > 5);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  const auto& first = report.at("proposals").at(0);
  CHECK(first.at("runs") == runs + further);
  CHECK(first.at("runs_consistent") == runs + further);
  CHECK(first.at("words").get<std::string>().find("Releases") != std::string::npos);
  // Those of another run do not count.
  json_of(cli, {"run", "two/sticks.yaml", "--out", "other", "--seed", "4"}, 1);
  std::filesystem::copy(cli.folder() / "out/further", cli.folder() / "other/further");
  const auto other = cli.parallax({"repair", "other"});
  CHECK(other.err.find("runs of something else, left out") != std::string::npos);
}

TEST_CASE("the text: where they parted, then each proposal with what stands behind it") {
  const TwoModels cli;
  json_of(cli, {"run", "two/unparks.yaml", "--out", "out"}, 1);
  const auto result = cli.parallax({"repair", "out", "--limit", "1"});
  CHECK(result.code == 1);
  for (const auto& wanted : std::vector<std::string>{
           "1 of them not as the model says", "OpenDrawer(top) at 0", "not Parked()",
           "1. an effect is missing: `" + kMissing + "`.", "Consistent with 1 of 1 run",
           "traces lost: 1, gained: 1.", "+++ b/two/opens.e\n@@ -3,3 +3,4 @@\n"}) {
    CAPTURE(result.out);
    CHECK(result.out.find(wanted) != std::string::npos);
  }
}

/// A world and a model that differ in one sentence each.
struct Mistake {
  std::string name, truth, model;
};

TEST_CASE("single mistakes: the first proposal, applied, makes the run clean") {
  const std::string close = "[drawer,time] Terminates(CloseDrawer(drawer),Open(drawer),time).\n";
  const std::string park = "[time] Initiates(Park(),Parked(),time).\n";
  const std::string reach = "[time] Terminates(Reach(),Parked(),time).\n";
  const std::string open = "[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n";
  const std::string unpark = "[drawer,time] Terminates(OpenDrawer(drawer),Parked(),time).\n";
  const std::vector<Mistake> mistakes = {
      {"an axiom was dropped", open + close + park + reach, open + park + reach},
      {"a sign is wrong", open + close + park + reach,
       open + "[drawer,time] Initiates(CloseDrawer(drawer),Open(drawer),time).\n" + park + reach},
      {"a condition is too much", open + close + park + reach,
       "[drawer,time] !HoldsAt(Parked(),time) -> Initiates(OpenDrawer(drawer),Open(drawer),time)."
       "\n" +
           close + park + reach},
      {"a condition was forgotten",
       "[drawer,time] !HoldsAt(Parked(),time) -> Initiates(OpenDrawer(drawer),Open(drawer),time)."
       "\n" +
           close + park + reach,
       open + close + park + reach},
      {"an effect is on the wrong fluent", open + unpark + close + park + reach,
       open + unpark + close + "[time] Initiates(Park(),Open(top),time).\n" + reach},
      {"a precondition was forgotten",
       open + close + park + reach +
           "[drawer,time] Happens(OpenDrawer(drawer),time) -> !HoldsAt(Parked(),time).\n",
       open + close + park + reach},
  };
  for (const auto& mistake : mistakes) {
    CAPTURE(mistake.name);
    const TwoModels cli;
    const auto domain = cli.read("two/domain.e");
    const auto declared = domain.substr(0, domain.find("\n[") + 1);
    cli.write("two/domain.e", declared);
    cli.write("two/world.e", "load domain.e\n" + mistake.truth);
    cli.write("two/opens.e", "load domain.e\n\n; What happens.\n" + mistake.model);
    // Every step of the plan, so that a model that forgets something still has a trace.
    cli.write("two/common.yaml",
              "plan: open_and_close.lisp\nbind: free.bind\nhorizon: 3\n"
              "constraints: \"Happens(Park(),time-1)\"\n");
    cli.write("two/free.bind",
              "action opening (:object ?d) -> OpenDrawer(?d)\n"
              "  ok: Open(?d) | !Open(?d) @t+1 else manipulation-goal-not-reached\n"
              "action closing (:object ?d) -> CloseDrawer(?d)\n"
              "  ok: Open(?d) | !Open(?d) @t+1 else manipulation-goal-not-reached\n"
              "action parking-arms () -> Park()\n"
              "  ok: Parked() | !Parked() @t+1 else manipulation-goal-not-reached\n"
              "action reaching () -> Reach()\n"
              "  ok: Parked() | !Parked() @t+1 else manipulation-goal-not-reached\n");
    cli.write("two/own.yaml",
              "include: common.yaml\nsimulator: {model: world.e}\nmodel: [opens.e, start.e]\n");
    json_of(cli, {"run", "two/own.yaml", "--out", "out"}, 1);
    const auto report = json_of(cli, {"repair", "out"}, 1);
    const auto& first = report.at("proposals").at(0);
    CAPTURE(report.dump(1));
    CHECK(cli.parallax({"repair", "out", "--apply", "1"}).code == 0);
    const auto again =
        cli.parallax({"run", "two/own.yaml", "--epsilon", "0.3", "--out", "again", "--json"});
    // Where the plan has no trace any more it is the plan that is wrong, and it was said.
    if (first.at("reaches_constraints") == false) {
      CHECK(again.out.find("E7001") != std::string::npos);
    } else {
      CHECK(Json::parse(again.out).at("verdict") == "no-discrepancy");
    }
  }
}

TEST_CASE("nothing to repair is said, with what to do instead") {
  const TwoModels cli;
  json_of(cli, {"run", "two/agree.yaml", "--epsilon", "0.3", "--out", "out"});
  const auto result = cli.parallax({"repair", "out"});
  CHECK(result.code == 0);
  CHECK(result.out.find("there is nothing to repair") != std::string::npos);
  CHECK(result.out.find("More runs may find something") != std::string::npos);
  CHECK(json_of(cli, {"repair", "out"}).at("proposals").empty());

  // For a run that came to no verdict this is not said.
  CHECK(cli.parallax({"run", "two/agree.yaml", "--max-runs", "5", "--out", "short"}).code == 4);
  const auto open = cli.parallax({"repair", "short"});
  CHECK(open.code == 4);
  CHECK(open.out.find("nothing to repair") == std::string::npos);
  CHECK(open.out.find("the run came to no verdict") != std::string::npos);
  std::filesystem::remove(cli.folder() / "out" / "report.json");
  CHECK(json_of(cli, {"repair", "out"}, 4).at("finished") == false);
}

TEST_CASE(
    "a refused event that the model forbids as well: the plan is at fault, nothing is proposed") {
  const TwoModels cli;
  const std::string forbidden =
      "load domain.e\n\n[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n"
      "[drawer,time] Happens(OpenDrawer(drawer),time) -> HoldsAt(Parked(),time).\n";
  cli.write("two/opens.e", forbidden);
  cli.write("two/start.e", "[drawer] !HoldsAt(Open(drawer),0).\n!HoldsAt(Parked(),0).\n");
  json_of(cli, {"run", "two/agree.yaml", "--execution", "closed-loop", "--out", "out"}, 1);
  const auto result = cli.parallax({"repair", "out"});
  CAPTURE(result.out);
  CHECK(result.code == 4);
  CHECK(result.out.find("run 1.1: OpenDrawer(top) at 0 failed, and the model says that it cannot "
                        "happen there") != std::string::npos);
}

TEST_CASE("a run that tried twice and saw two outcomes: the outcome is open") {
  const TwoModels cli;
  cli.write("two/retry.lisp", R"((def-cram-function open-it ()
  (with-retry-counters ((tries 2))
    (with-failure-handling ((manipulation-low-level-failure (e) (do-retry tries (retry))))
      (perform (an action (type opening) (object (an object (name top))))))))
(open-it)
)");
  cli.write("two/opens.e", "load domain.e\n");
  cli.write("two/world.e",
            "load domain.e\n\n[drawer,time] Releases(OpenDrawer(drawer),Open(drawer),time).\n");
  cli.write("two/retry.yaml",
            "plan: retry.lisp\nbind: robot.bind\nhorizon: 3\nname: a drawer that opens or not\n"
            "model: [opens.e, start.e]\nexecution: closed-loop\nsimulator: {model: world.e}\n");
  const auto run = json_of(cli, {"run", "two/retry.yaml", "--out", "out", "--seed", "2"}, 1);
  REQUIRE(run.at("simulations") == 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  REQUIRE(report.at("partings").at(0).at("timepoint") > 1);
  const std::string words = report.at("proposals").at(0).at("words");
  CHECK(words.find("Releases(OpenDrawer(") != std::string::npos);
}

TEST_CASE("no condition is proposed that the axiom has, or that leaves nothing of it") {
  const TwoModels cli;
  const std::string open =
      "load domain.e\n\n[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n";
  cli.write("two/world.e", open);
  cli.write("two/opens.e", open +
                               "[drawer,time] !HoldsAt(Open(drawer),time) -> "
                               "Terminates(OpenDrawer(drawer),Parked(),time).\n");
  cli.write("two/idle.yaml",
            "include: common.yaml\nname: an effect too many\nmodel: [opens.e, start.e]\n"
            "simulator: {model: world.e}\n");
  json_of(cli, {"run", "two/idle.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out", "--limit", "0"}, 1);
  bool dropped = false;
  for (const auto& proposal : report.at("proposals")) {
    const std::string words = proposal.at("words");
    CAPTURE(words);
    CHECK(words.find("only if `HoldsAt(Open(drawer),time)`") == std::string::npos);
    CHECK(words.find("only if `!HoldsAt(Open(drawer),time)`") == std::string::npos);
    CHECK(words.find("only if `!HoldsAt(Parked(),time)`") == std::string::npos);
    dropped = dropped || words.find("is dropped") != std::string::npos;
  }
  CHECK(dropped);
}

TEST_CASE("among preconditions that explain a refusal the one comes first that forbids least") {
  const TwoModels cli;
  // Whether the drawer is locked is open. The plan reaches, too, so that it goes on without
  // parking.
  const std::string model =
      "load domain.e\n\nfluent Locked(drawer)\nfluent Bolted()\n\n"
      "[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n";
  cli.write("two/opens.e", model);
  cli.write(
      "two/world.e",
      model + "[drawer,time] Happens(OpenDrawer(drawer),time) -> !HoldsAt(Locked(drawer),time).\n");
  cli.write("two/start.e",
            "[drawer] !HoldsAt(Open(drawer),0).\nHoldsAt(Parked(),0).\nHoldsAt(Bolted(),0).\n");
  cli.write("two/refuses.yaml",
            "include: common.yaml\nname: a locked drawer\nmodel: [opens.e, start.e]\n"
            "simulator: {model: world.e}\n");
  json_of(cli, {"run", "two/refuses.yaml", "--execution", "closed-loop", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out", "--limit", "0"}, 1);
  const auto& all = report.at("proposals");
  CHECK(all.at(0).at("words").get<std::string>().find("Locked") != std::string::npos);
}

TEST_CASE("runs that contradict each other: said first, and the outcome is left open") {
  const TwoModels cli;
  json_of(cli, {"run", "two/sticks.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  CHECK(report.at("contradictions").size() == 1);
  const auto& first = report.at("proposals").at(0);
  CHECK(first.at("patch").get<std::string>().find(
            "+[drawer,time] Releases(OpenDrawer(drawer),Open(drawer),time).") != std::string::npos);
  CHECK(first.at("runs_consistent") == first.at("runs"));
  CHECK(cli.parallax({"repair", "out"}).out.find("go the same way up to 0") != std::string::npos);
}

TEST_CASE("a model that changed since is refused, unless that is said") {
  const TwoModels cli;
  json_of(cli, {"run", "two/unparks.yaml", "--out", "out"}, 1);
  cli.write("two/opens.e", "; Changed.\n" + cli.read("two/opens.e"));
  const auto refused = cli.parallax({"repair", "out"});
  CHECK(refused.code == 3);
  CHECK(refused.err.find("error[E7113]") != std::string::npos);
  const auto report = json_of(cli, {"repair", "out", "--other-model"}, 1);
  CHECK(report.at("proposals").at(0).at("words").get<std::string>().find(kMissing) !=
        std::string::npos);
  // The mended model has nothing to repair left.
  CHECK(cli.parallax({"repair", "out", "--other-model", "--apply", "1"}).code == 0);
  CHECK(cli.parallax({"repair", "out", "--other-model"}).code == 0);
}

TEST_CASE("what cannot be: no such proposal, no run") {
  const TwoModels cli;
  json_of(cli, {"run", "two/unparks.yaml", "--out", "out"}, 1);
  const auto before = cli.read("two/opens.e");
  const auto none = cli.parallax({"repair", "out", "--apply", "9999"});
  CHECK(none.code == 2);
  CHECK(none.err.find("there is no proposal 9999") != std::string::npos);
  CHECK(cli.read("two/opens.e") == before);
  CHECK(cli.parallax({"repair", "two"}).code == 2);
  CHECK(cli.parallax({"repair", "out", "--apply", "0"}).code == 2);
}

TEST_CASE("a run in closed loop is evidence like any other") {
  const TwoModels cli;
  json_of(cli, {"run", "two/unparks.yaml", "--execution", "closed-loop", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  CHECK(report.at("proposals").at(0).at("words").get<std::string>().find(kMissing) !=
        std::string::npos);
}

/// A box in a hand, and a drawer, with the axioms of the world and of the model.
std::string box_world(const TwoModels& cli, const std::string& world, const std::string& model) {
  cli.write("two/domain.e",
            "sort drawer\nsort thing\ndrawer top\nthing box, jar\n"
            "fluent Open(drawer)\nfluent Parked()\nfluent Held(thing)\nfluent Fallen(thing)\n"
            "event OpenDrawer(drawer)\nevent CloseDrawer(drawer)\nevent Park()\nevent Reach()\n"
            "[thing,time] HoldsAt(Held(thing),time) -> !HoldsAt(Fallen(thing),time).\n"
            "[time] !HoldsAt(Held(box),time) -> HoldsAt(Fallen(box),time).\n"
            "[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n"
            "[drawer,time] Terminates(CloseDrawer(drawer),Open(drawer),time).\n"
            "[time] Initiates(Park(),Parked(),time).\n");
  cli.write("two/start.e",
            "[drawer] !HoldsAt(Open(drawer),0).\nHoldsAt(Parked(),0).\nHoldsAt(Held(box),0).\n"
            "!HoldsAt(Held(jar),0).\n[thing] !HoldsAt(Fallen(thing),0).\n");
  cli.write("two/opens.e", "load domain.e\n" + model);
  return cli.world("load domain.e\n" + world);
}

TEST_CASE("effects that only make sense together are one proposal, bound by what ends") {
  const TwoModels cli;
  const std::string slips =
      "[drawer,thing,time] HoldsAt(Held(thing),time) -> "
      "Terminates(OpenDrawer(drawer),Held(thing),time).\n"
      "[drawer,thing,time] HoldsAt(Held(thing),time) -> "
      "Initiates(OpenDrawer(drawer),Fallen(thing),time).\n";
  const auto scenario = box_world(cli, slips, "");
  json_of(cli, {"run", scenario, "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  const auto& first = report.at("proposals").at(0);
  CAPTURE(report.dump(1));
  CHECK(first.at("words").get<std::string>().find(
            "`OpenDrawer(drawer)` ends `Held(thing)` and begins `Fallen(thing)`") !=
        std::string::npos);
  CHECK(first.at("edits") == 1);
  CHECK(first.at("changes") == "model");
  CHECK(first.at("runs_to_the_end") == first.at("runs"));
  CHECK(cli.parallax({"repair", "out", "--apply", "1"}).code == 0);
  CHECK(json_of(cli, {"run", scenario, "--epsilon", "0.3", "--out", "again"}).at("verdict") ==
        "no-discrepancy");
}

TEST_CASE("effects that chance brings together are left open together") {
  const TwoModels cli;
  const std::string may_slip =
      "[drawer,thing,time] HoldsAt(Held(thing),time) -> "
      "Releases(OpenDrawer(drawer),Held(thing),time).\n"
      "[drawer,thing,time] HoldsAt(Held(thing),time) -> "
      "Releases(OpenDrawer(drawer),Fallen(thing),time).\n"
      "[drawer,thing,time] !HoldsAt(Held(thing),time) -> "
      "Terminates(CloseDrawer(drawer),Held(thing),time).\n"
      "[drawer,thing,time] HoldsAt(Held(thing),time) -> "
      "Initiates(CloseDrawer(drawer),Held(thing),time).\n";
  json_of(cli, {"run", box_world(cli, may_slip, ""), "--out", "out"}, 1);
  json_of(cli, {"explain", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  CAPTURE(report.dump(1));
  CHECK(!report.at("contradictions").empty());
  const auto& first = report.at("proposals").at(0);
  CHECK(first.at("words").get<std::string>().find(
            "`OpenDrawer(drawer)` can end `Held(thing)` and begin `Fallen(thing)`") !=
        std::string::npos);
  CHECK(first.at("runs_consistent") == first.at("runs"));
  // Why it is left open stands with it.
  REQUIRE(report.at("causes").size() > 0);
  CHECK(report.at("causes").at(0).at("cause") == "random");
  CHECK(first.at("evidence").at(0) == report.at("causes").at(0).at("words"));
}

/// Checks that tied proposals have equally many ties and the same measures, and that there are
/// some.
void check_ties(const Json& proposals) {
  std::size_t tied = 0;
  for (const auto& proposal : proposals) {
    for (const std::size_t other : proposal.at("tied")) {
      ++tied;
      const auto& twin = proposals.at(other - 1);
      CHECK(twin.at("tied").size() == proposal.at("tied").size());
      for (const auto* field :
           {"edits", "precaution", "runs_to_the_end", "traces_gained", "traces_lost"}) {
        CHECK(twin.at(field) == proposal.at(field));
      }
    }
  }
  CHECK(tied > 0);
}

TEST_CASE("an effect that comes later: the axiom says so, with what happens then") {
  const TwoModels cli;
  const std::string begins =
      "sort drawer\ndrawer top\nfluent Open(drawer)\nfluent Parked()\n"
      "event OpenDrawer(drawer)\nevent Park()\n";
  cli.write("two/domain.e", begins + "[time] Initiates(Park(),Parked(),time).\n");
  cli.write("two/open_and_close.lisp",
            "(def-cram-function open-late ()\n"
            "  (perform (an action (type opening) (object (an object (name top)))))\n"
            "  (perform (an action (type parking-arms))))\n(open-late)\n");
  cli.write("two/robot.bind",
            "action opening (:object ?d) -> OpenDrawer(?d)\n"
            "  ok: Open(?d) | !Open(?d) @t+1 else manipulation-goal-not-reached\n"
            "action parking-arms () -> Park()\n"
            "  ok: Parked() | !Parked() @t+1 else manipulation-goal-not-reached\n");
  cli.write("two/opens.e",
            "load domain.e\n[drawer,time] Initiates(OpenDrawer(drawer),Open(drawer),time).\n");
  const auto scenario = cli.world(
      "load domain.e\nfluent Moving(drawer)\n[drawer] !HoldsAt(Moving(drawer),0).\n"
      "[drawer,time] Initiates(OpenDrawer(drawer),Moving(drawer),time).\n"
      "[drawer,time] HoldsAt(Moving(drawer),time) -> Initiates(Park(),Open(drawer),time).\n");
  json_of(cli, {"run", scenario, "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  CAPTURE(report.dump(1));
  const auto& first = report.at("proposals").at(0);
  CHECK(first.at("patch").get<std::string>().find(
            "Happens(OpenDrawer(drawer),time-1) -> Initiates(Park(),Open(drawer),time).") !=
        std::string::npos);
  CHECK(first.at("runs_to_the_end") == first.at("runs"));
  check_ties(json_of(cli, {"repair", "out", "--limit", "0"}, 1).at("proposals"));
  CHECK(cli.parallax({"repair", "out", "--limit", "0"}).out.find("(tied with ") !=
        std::string::npos);
  CHECK(cli.parallax({"repair", "out", "--apply", "1"}).code == 0);
  CHECK(json_of(cli, {"run", scenario, "--epsilon", "0.3", "--out", "again"}).at("verdict") ==
        "no-discrepancy");
}

TEST_CASE("what the world refused may fail, and the binding table knows the reason") {
  const TwoModels cli;
  std::filesystem::copy(std::filesystem::path(PARALLAX_SOURCE_DIR) / "scenarios" / "warehouse",
                        cli.folder() / "house", std::filesystem::copy_options::recursive);
  json_of(cli, {"run", "house/oily_pads.yaml", "--out", "out"}, 1);
  const auto bound = json_of(cli, {"repair", "out"}, 1).at("proposals").at(0);
  CHECK(bound.at("words") == "what `PickUp(arm,part)` does is open: `Releases` in 2 of its axioms");
  CHECK(bound.at("edits") == 1);
  CHECK(bound.at("changes") == "model");
  CHECK(
      bound.at("evidence")
          .at(0)
          .get<std::string>()
          .starts_with("`PickUp(left,crate)` failed for the reason object-not-held; the plan gets "
                       "`manipulation-pose-unreachable` then (house/robot.bind:"));

  // A table that binds other reasons gets this one, too.
  cli.replace("house/robot.bind", "ok: Holding(?a,?o) @t+1  else manipulation-pose-unreachable",
              "ok: Holding(?a,?o) @t+1  else manipulation-pose-unreachable on too-far "
              "manipulation-pose-unreachable");
  const auto table = cli.read("house/robot.bind");
  json_of(cli, {"run", "house/oily_pads.yaml", "--out", "other"}, 1);
  const auto unbound = json_of(cli, {"repair", "other"}, 1).at("proposals").at(0);
  CHECK(unbound.at("changes") == "binding");
  CHECK(cli.parallax({"repair", "other", "--apply", "1"}).code == 0);
  auto expected = table;
  const std::string last = "on too-far manipulation-pose-unreachable";
  expected.insert(expected.find(last) + last.size(),
                  " on object-not-held manipulation-pose-unreachable");
  CHECK(cli.read("house/robot.bind") == expected);
}

TEST_CASE("a file that cannot be written: said, and it is as it was") {
  const TwoModels cli;
  json_of(cli, {"run", "two/unparks.yaml", "--out", "out"}, 1);
  const auto before = files_below(cli.folder());
  const std::string program = std::string(PARALLAX_BINARY_DIR) + "/parallax";
  // Whoever runs this may write anything; a limit on the size of files holds for everybody.
  const auto result = run_process(
      {"bash", "-c", "trap '' XFSZ; ulimit -f 0; exec '" + program + "' repair out --apply 1"},
      in_folder(cli));
  CHECK(result.code == 2);
  CHECK(result.err.find("error[E0005]: cannot write the file") != std::string::npos);
  CHECK(files_below(cli.folder()) == before);
}

}  // namespace
}  // namespace parallax::test
