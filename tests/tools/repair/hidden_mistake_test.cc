// Mistakes that do not show in the differing fluents: the worlds of tools/bench/worlds, with one
// mistake each.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

/// One of those worlds, with a model that has another line in the place of one.
struct Mistaken : CliFixture {
  Mistaken(const std::string& world, const std::string& right, const std::string& wrong) {
    const auto from = fs::path(PARALLAX_SOURCE_DIR) / "tools" / "bench" / "worlds" / world;
    for (const auto& entry : fs::directory_iterator(from)) {
      fs::copy_file(entry, folder() / entry.path().filename(),
                    fs::copy_options::overwrite_existing);
    }
    write("truth.e", read("domain.e"));
    replace("domain.e", right, wrong);
    write("own.yaml",
          "include: bench.yaml\nmodel: [domain.e, start.e]\nsimulator: {model: truth.e}\n"
          "execution: closed-loop\n");
  }
  /// Is the change to that line among the first `most` proposals?
  bool proposes(const std::string& line, std::size_t most) const {
    json_of(*this, {"run", "own.yaml", "--out", "out"}, 1);
    const auto report = json_of(*this, {"repair", "out", "--limit", std::to_string(most)}, 1);
    const auto& all = report.at("proposals");
    const bool found = std::any_of(all.begin(), all.end(), [&](const auto& each) {
      return each.at("patch").template get<std::string>().find("\n+" + line + "\n") !=
             std::string::npos;
    });
    if (!found) MESSAGE(report.dump(1));
    return found;
  }
};

TEST_CASE("an effect on the wrong fluent, where the right one is open in the model") {
  // After Spin the model lets Loaded be anything, so that the effect of Shoot on it is no
  // difference.
  const std::string right = "[time] Terminates(Shoot(),Loaded(),time).";
  for (const std::string wrong : {"Aimed", "Alive"}) {
    CAPTURE(wrong);
    const Mistaken cli("hunter", right, "[time] Terminates(Shoot()," + wrong + "(),time).");
    CHECK(cli.proposes(right, 3));
  }
}

TEST_CASE("an effect on the wrong fluent, where the right one changes only behind the parting") {
  const std::string right = "[time] Terminates(Load(),Aimed(),time).";
  const Mistaken cli("hunter", right, "[time] Terminates(Load(),Alive(),time).");
  CHECK(cli.proposes(right, 3));
}

TEST_CASE("an effect with a condition between its variables is asked for beside one of constants") {
  const std::string right =
      "[place1,place2,time] place1!=place2 -> Terminates(WalkTo(place1),At(place2),time).";
  const Mistaken cli("reader", right + "\n", "");
  CHECK(cli.proposes(right, 3));
}

TEST_CASE("a precondition about a fluent that is seen at the start and at the end alone") {
  const CliFixture cli;
  const std::string domain =
      "fluent Open()\nfluent Stuck()\n\nevent Pull()\nevent Push()\n\n"
      "[time] Initiates(Pull(),Open(),time).\n[time] Terminates(Push(),Open(),time).\n";
  cli.write("model.e", domain);
  cli.write("truth.e", domain + "[time] Happens(Push(),time) -> !HoldsAt(Stuck(),time).\n");
  cli.write("start.e", "!HoldsAt(Open(),0).\n");
  cli.write("pull.lisp",
            "(perform (an action (type pulling)))\n(perform (an action (type pushing)))\n");
  cli.write("robot.bind",
            "action pulling () -> Pull()  ok: Open() @t+1 else manipulation-goal-not-reached\n"
            "action pushing () -> Push()  ok: !Open() @t+1 else manipulation-goal-not-reached\n");
  cli.write("drawer.yaml",
            "model: [model.e, start.e]\nsimulator: {model: truth.e}\nplan: pull.lisp\n"
            "bind: robot.bind\nhorizon: 2\nconstraints: \"Happens(Push(),time-1)\"\n"
            "mapping: {Stuck(): {flag: \"Stuck()\", drawn: true, compare: final}}\n");
  json_of(cli, {"run", "drawer.yaml", "--out", "out"}, 1);
  const auto report = json_of(cli, {"repair", "out"}, 1);
  CAPTURE(report.dump(1));
  CHECK(report.at("proposals").at(0).at("words") ==
        "`Push()` can happen only if `!HoldsAt(Stuck(),time)`");
}

}  // namespace
}  // namespace parallax::test
