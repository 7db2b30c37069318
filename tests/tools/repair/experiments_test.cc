// Runs that distinguish proposals, in worlds that are models, so that the right one is known.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

/// A drawer that a robot pulls and pushes; whether it opens is the world's to say.
class Drawer : public CliFixture {
 public:
  explicit Drawer(const std::string& truth, const std::string& execution = "open-loop") {
    write("domain.e",
          "fluent Open()\nfluent Lit()\nfluent Parked()\nfluent Full()\n\n"
          "event Pull()\nevent Push()\n\n[time] Terminates(Push(),Open(),time).\n");
    write("truth.e", "load domain.e\n" + truth);
    write("model.e", "load domain.e\n\n[time] Initiates(Pull(),Open(),time).\n");
    write("start.e", "!HoldsAt(Open(),0).\n");
    write("pull.lisp",
          "(def-cram-function pull ()\n  (perform (an action (type pulling)))\n"
          "  (perform (an action (type pushing))))\n(pull)\n");
    write("robot.bind",
          "action pulling () -> Pull()  ok: Open() | !Open() @t+1 "
          "else manipulation-goal-not-reached\n"
          "action pushing () -> Push()  ok: !Open() @t+1 else manipulation-goal-not-reached\n");
    write("drawer.yaml",
          "model: [model.e, start.e]\nsimulator: {model: truth.e}\nplan: pull.lisp\n"
          "bind: robot.bind\nhorizon: 2\nconstraints: \"Happens(Push(),time-1)\"\nexecution: " +
              execution + "\n" +
              // One start, which cannot tell what is missing.
              (execution == "open-loop" ? "initial: first\n" : ""));
  }
  bool has_experiments() const { return fs::exists(folder() / "out" / "experiments"); }
};

const std::string kLit = "[time] HoldsAt(Lit(),time) -> Initiates(Pull(),Open(),time).\n";

std::string first_words(const nlohmann::json& report) {
  return report.at("proposals").at(0).at("words");
}

/// Those that change the model; behind them stand changes of the plan.
std::size_t of_the_model(const nlohmann::json& report) {
  const auto& all = report.at("proposals");
  return static_cast<std::size_t>(std::count_if(
      all.begin(), all.end(), [](const auto& each) { return each.at("changes") == "model"; }));
}

TEST_CASE("a run cannot tell which condition is missing; further ones from other starts do") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const Drawer cli(kLit, execution);
    // Some start in the dark.
    json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
    const auto before = json_of(cli, {"repair", "out", "--runs", "0", "--limit", "0"}, 1);
    CHECK_FALSE(cli.has_experiments());
    CHECK(before.at("experiments") == 0);
    CHECK(of_the_model(before) > 2);
    CHECK(before.at("why_tied") == "no runs may be made to tell them apart (--runs 0)");
    const auto journal = cli.read("out/journal.ndjson");

    const auto after = json_of(cli, {"repair", "out", "--limit", "0"}, 1);
    CHECK(of_the_model(after) == 1);
    CHECK(first_words(after).find("only if `HoldsAt(Lit(),time)`") != std::string::npos);
    CHECK(after.at("tied") == 1);
    CHECK(after.at("refuted").size() + 1 >= of_the_model(before));
    const int made = after.at("experiments");
    CHECK(made > 0);
    CHECK(made <= 4);  // of 16 starts
    CHECK(after.at("runs") == before.at("runs").get<int>() + made);
    CHECK(after.at("proposals").at(0).at("runs_consistent") == after.at("runs"));
    CHECK(cli.read("out/journal.ndjson") == journal);

    // Not made again; the same for any number of jobs, and in pieces.
    const auto recorded = cli.read("out/experiments/journal.ndjson");
    const auto again = json_of(cli, {"repair", "out", "--limit", "0"}, 1);
    CHECK(again.at("proposals") == after.at("proposals"));
    CHECK(cli.read("out/experiments/journal.ndjson") == recorded);
    fs::remove_all(cli.folder() / "out" / "experiments");
    json_of(cli, {"repair", "out", "--jobs", "3"}, 1);
    CHECK(cli.read("out/experiments/journal.ndjson") == recorded);
    fs::remove_all(cli.folder() / "out" / "experiments");
    for (int budget = 1; budget <= made; ++budget) {
      const auto part = json_of(cli, {"repair", "out", "--runs", std::to_string(budget)}, 1);
      CHECK(part.at("experiments") == budget);
    }
    CHECK(cli.read("out/experiments/journal.ndjson") == recorded);

    // No experiments are run for another model.
    cli.replace("model.e", "load domain.e\n", "load domain.e\n; Changed.\n");
    const auto other = json_of(cli, {"repair", "out", "--other-model"}, 1);
    CHECK(other.at("experiments") == made);
    CHECK(cli.read("out/experiments/journal.ndjson") == recorded);
  }
}

TEST_CASE("a repair in the copy of a project leaves the original alone") {
  const Drawer cli("[time] HoldsAt(Lit(),time) -> Initiates(Pull(),Open(),time).\n");
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  fs::create_directory(cli.folder() / "copy");
  for (const auto& entry : fs::directory_iterator(cli.folder())) {
    if (entry.path().filename() != "copy") {
      fs::copy(entry.path(), cli.folder() / "copy" / entry.path().filename(),
               fs::copy_options::recursive);
    }
  }
  const auto original = files_below(cli.folder());
  const auto in_copy = [&](std::vector<std::string> more) {
    std::vector<std::string> words = {"repair", "out", "--runs", "0", "--apply", "1"};
    words.insert(words.end(), more.begin(), more.end());
    ProcessOptions options;
    options.folder = (cli.folder() / "copy").string();
    return cli.parallax(words, options);
  };
  const auto refused = in_copy({});
  CAPTURE(refused.err);
  CHECK(refused.code == 2);
  CHECK(refused.err.find("error[E0076]") != std::string::npos);
  CHECK(refused.err.find("--scenario") != std::string::npos);
  CHECK(files_below(cli.folder()) == original);
  const auto model = cli.read("model.e");
  const auto named = in_copy({"--scenario", "drawer.yaml"});
  CAPTURE(named.err);
  CHECK(named.code == 0);
  CHECK(cli.read("model.e") == model);
  CHECK(cli.read("copy/model.e") != model);
  cli.write("copy/model.e", model);
  CHECK(in_copy({"--allow-outside"}).code == 0);
  CHECK(cli.read("model.e") != model);
}

TEST_CASE("experiments and rounds are the same where workers elsewhere simulate") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const Drawer cli(kLit, execution);
    cli.write("elsewhere.sh", "echo started >> elsewhere.log\nexec \"$@\"\n");
    cli.write("hosts", "1 sh elsewhere.sh\n2 env\n");
    json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
    const auto here = json_of(cli, {"repair", "out"}, 1);
    const auto recorded = cli.read("out/experiments/journal.ndjson");
    fs::remove_all(cli.folder() / "out" / "experiments");
    CHECK(json_of(cli, {"repair", "out", "--hosts", "hosts"}, 1) == here);
    CHECK(cli.read("out/experiments/journal.ndjson") == recorded);
    CHECK(fs::exists(cli.folder() / "elsewhere.log"));

    const std::vector<std::string> loop = {"repair", "out", "--runs", "0", "--loop", "--out"};
    auto one = loop, other = loop;
    one.emplace_back("one");
    other.insert(other.end(), {"other", "--launcher", "sh elsewhere.sh", "--jobs", "2"});
    const auto expected = cli.parallax(one), found = cli.parallax(other);
    CAPTURE(found.err);
    CHECK(found.code == expected.code);
    CHECK(cli.read("other/repair.patch") == cli.read("one/repair.patch"));
  }
}

TEST_CASE("an experiment that was not drawn for its number is no evidence") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const Drawer cli(kLit, execution);
    json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
    json_of(cli, {"repair", "out", "--runs", "1"}, 1);
    const std::string place = "out/experiments/journal.ndjson";
    auto journal = cli.read(place);
    const auto sample = journal.find("\"phase\":\"certify\",\"seed\":");
    REQUIRE(sample != std::string::npos);
    auto& digit = journal[sample + std::string("\"phase\":\"certify\",\"seed\":").size()];
    digit = digit == '1' ? '2' : '1';
    cli.write(place, journal);
    // Whether or not there may be more of them.
    for (const std::string runs : {"60", "0"}) {
      CAPTURE(runs);
      const auto refused = cli.parallax({"repair", "out", "--runs", runs});
      CAPTURE(refused.err);
      CHECK(refused.code == 3);
      CHECK(refused.err.find("E7103") != std::string::npos);
      CHECK(refused.err.starts_with(place + ":"));
    }
    CHECK(cli.read(place) == journal);
  }
}

TEST_CASE("how many as likely as the first were not compared is told") {
  // It opens only in the light; twelve lamps burn together.
  const Drawer cli(kLit);
  std::string lamps, start = "!HoldsAt(Open(),0).\nHoldsAt(Full(),0).\n!HoldsAt(Parked(),0).\n";
  for (int i = 1; i <= 12; ++i) {
    const auto lamp = "Lamp" + std::to_string(i) + "()";
    lamps += "fluent " + lamp + "\n";
    start += "HoldsAt(Lit(),0) <-> HoldsAt(" + lamp + ",0).\n";
  }
  cli.write("domain.e", lamps + cli.read("domain.e"));
  cli.write("start.e", start);
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  const auto all = json_of(cli, {"repair", "out", "--limit", "0"}, 1);
  const std::size_t tied = all.at("tied");
  CHECK(tied >= 12);
  CHECK(all.at("not_compared") == 0);
  const auto few = json_of(cli, {"repair", "out", "--limit", "2"}, 1);
  const std::size_t hidden = few.at("tied_hidden"), left_out = few.at("not_compared");
  CHECK(left_out > 0);
  CHECK(few.at("tied").get<std::size_t>() + left_out == tied);
  CHECK(hidden == few.at("tied").get<std::size_t>() - 2);
  CHECK(cli.parallax({"repair", "out", "--limit", "2"})
            .out.find(std::to_string(left_out) + " further proposals as likely as the first were "
                                                 "not compared with it") != std::string::npos);
}

TEST_CASE("a tie that --limit hides is told with its number") {
  const Drawer cli(kLit);
  cli.write("start.e",
            "!HoldsAt(Open(),0).\nHoldsAt(Lit(),0) <-> HoldsAt(Parked(),0).\nHoldsAt(Full(),0).\n");
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  const auto all = json_of(cli, {"repair", "out", "--limit", "0"}, 1);
  CHECK(all.at("tied") == 2);
  CHECK(all.at("tied_hidden") == 0);
  const auto one = json_of(cli, {"repair", "out", "--limit", "1"}, 1);
  CHECK(one.at("tied") == 2);
  CHECK(one.at("tied_hidden") == 1);
  const auto text = cli.parallax({"repair", "out", "--limit", "1"}).out;
  CHECK(text.find("not shown (--limit)") != std::string::npos);
}

TEST_CASE("what no run of the plan tells apart is shown as a tie") {
  // The lamp burns if and only if the arm is parked, in every state that the plan can begin in.
  const Drawer cli(kLit);
  cli.write("start.e",
            "!HoldsAt(Open(),0).\nHoldsAt(Lit(),0) <-> HoldsAt(Parked(),0).\nHoldsAt(Full(),0).\n");
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  CHECK(report.at("why_tied") == "no run of this plan tells them apart");
  CHECK(report.at("tied") == 2);
  CHECK(of_the_model(report) == 2);
  const auto text = cli.parallax({"repair", "out"}).out;
  CHECK(
      text.find("A tie: proposals 1 to 2 are of one rank; no run of this plan tells them apart.") !=
      std::string::npos);
}

/// Is there a proposal with this in its words?
bool proposes(const nlohmann::json& report, const std::string& text) {
  const auto& all = report.at("proposals");
  return std::any_of(all.begin(), all.end(), [&](const auto& each) {
    return each.at("words").template get<std::string>().find(text) != std::string::npos;
  });
}

TEST_CASE("what went wrong once may be chance: it is done again where the world releases fluents") {
  for (const std::string execution : {"open-loop", "closed-loop"}) {
    CAPTURE(execution);
    const Drawer cli("[time] Releases(Pull(),Open(),time).\n", execution);
    cli.write("start.e",
              "!HoldsAt(Open(),0).\nHoldsAt(Lit(),0).\nHoldsAt(Full(),0).\n"
              "HoldsAt(Parked(),0).\n");
    // A single run does not tell that it could have opened.
    int seed = 1;
    for (; seed <= 20; ++seed) {
      fs::remove_all(cli.folder() / "out");
      const auto ran =
          json_of(cli, {"run", "drawer.yaml", "--out", "out", "--seed", std::to_string(seed)}, 1);
      if (ran.at("simulations") == 1) break;
    }
    REQUIRE(seed <= 20);
    const auto before = json_of(cli, {"repair", "out", "--runs", "0"}, 1);
    const auto opens = [](const nlohmann::json& report) {
      const std::string patch = report.at("proposals").at(0).at("patch");
      return patch.find("Releases(Pull(),Open(),time)") != std::string::npos;
    };
    CHECK_FALSE(opens(before));
    CHECK_FALSE(cli.has_experiments());

    const auto after = json_of(cli, {"repair", "out"}, 1);
    CHECK(opens(after));
    const int made = after.at("experiments");
    CHECK(made > 0);
    CHECK(made <= 5);
    CHECK(after.at("proposals").at(0).at("runs_consistent") == after.at("runs"));
    const auto recorded = cli.read("out/experiments/journal.ndjson");
    CHECK(json_of(cli, {"repair", "out"}, 1).at("proposals") == after.at("proposals"));
    CHECK(cli.read("out/experiments/journal.ndjson") == recorded);
  }
  // In a world without chance nothing is done twice, though it may define fluents.
  const Drawer cli("");
  cli.write("domain.e", cli.read("domain.e") +
                            "fluent Shut()\nnoninertial Shut\n"
                            "[time] HoldsAt(Shut(),time) <-> !HoldsAt(Open(),time).\n");
  cli.write("start.e",
            "!HoldsAt(Open(),0).\nHoldsAt(Lit(),0).\nHoldsAt(Full(),0).\n"
            "HoldsAt(Parked(),0).\n");
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  CHECK(json_of(cli, {"repair", "out"}, 1).at("experiments") == 0);
  CHECK_FALSE(cli.has_experiments());
}

TEST_CASE("whatever the world is like: experiments never drop what is right") {
  struct World {
    std::string truth, right;
  };
  const std::string opens = "[time] Initiates(Pull(),Open(),time).\n";
  const std::vector<World> worlds = {
      {kLit, "only if `HoldsAt(Lit(),time)`"},
      {"[time] !HoldsAt(Parked(),time) -> Initiates(Pull(),Open(),time).\n",
       "only if `!HoldsAt(Parked(),time)`"},
      {"[time] !HoldsAt(Full(),time) -> Initiates(Pull(),Open(),time).\n",
       "only if `!HoldsAt(Full(),time)`"},
      {opens + "[time] Terminates(Pull(),Parked(),time).\n", "`Terminates(Pull(),Parked(),time)`"},
      {opens + "[time] HoldsAt(Full(),time) -> Terminates(Pull(),Lit(),time).\n",
       "`HoldsAt(Full(),time) -> Terminates(Pull(),Lit(),time)`"},
      {"[time] Initiates(Pull(),Lit(),time).\n", "becomes `Initiates(Pull(),Lit(),time)`"},
      {"", "is dropped"},
  };
  int made = 0, fewer = 0, known = 0;
  for (const auto& world : worlds) {
    for (const std::string seed : {"2", "3"}) {
      CAPTURE(world.truth);
      CAPTURE(seed);
      const Drawer cli(world.truth, "closed-loop");
      cli.write("start.e",
                "!HoldsAt(Open(),0).\n"
                "HoldsAt(Full(),0) | HoldsAt(Lit(),0) | HoldsAt(Parked(),0).\n");
      json_of(cli, {"run", "drawer.yaml", "--out", "out", "--seed", seed}, 1);
      const auto before = json_of(cli, {"repair", "out", "--runs", "0", "--limit", "0"}, 1);
      const auto after = json_of(cli, {"repair", "out", "--limit", "0"}, 1);
      CAPTURE(after.dump());
      // A single run may not be enough to find the right proposal.
      if (proposes(before, world.right)) {
        ++known;
        CHECK(proposes(after, world.right));
      }
      for (const auto& proposal : after.at("proposals")) {
        CHECK(proposal.at("runs_to_the_end") == after.at("runs"));
      }
      made += after.at("experiments").get<int>();
      fewer += after.at("proposals").size() < before.at("proposals").size() ? 1 : 0;
    }
  }
  CHECK(known >= 12);  // of 14
  CHECK(made > 8);
  CHECK(fewer > 5);
}

}  // namespace
}  // namespace parallax::test
