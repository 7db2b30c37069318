// Messages of the program to somebody who took the wrong file, or whose model has no trace.

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  CAPTURE(text);
  return text.find(part) != std::string::npos;
}

/// One error, and no other.
void check_only_error(const ProcessResult& result, const std::string& wanted, int code = 3) {
  CAPTURE(result.out);
  CAPTURE(result.err);
  CHECK(result.code == code);
  CHECK(result.err.find(wanted) != std::string::npos);
  CHECK(result.err.find("error[") == result.err.rfind("error["));
}

TEST_CASE("a file of another kind: what it is, and which command takes it") {
  const CliFixture cli;
  std::string binary =
      "\x7f"
      "ELF";
  binary.resize(64, '\0');
  cli.write("program", binary);
  cli.write("cases.yaml", "cases:\n  - model: domain.e\n    expect: {traces: 1}\n");
  for (const auto* command : {"traces", "check", "explain", "fmt", "compile"}) {
    CAPTURE(command);
    const auto plan = cli.parallax({command, "fetch.lisp"});
    check_only_error(plan, "fetch.lisp: error[E0010]: this is a plan, not a model");
    CHECK(contains(plan.err, "--plan fetch.lisp --bind TABLE.bind"));
    check_only_error(cli.parallax({command, "robot.bind"}), "this is a binding table, not a model");
    check_only_error(cli.parallax({command, "program"}), "this is binary data, not a model");
  }
  check_only_error(cli.parallax({"fmt", "scenario.yaml"}), "this is a scenario, not a model");
  check_only_error(cli.parallax({"traces", "domain.e", "scenario.yaml"}),
                   "this is a scenario, not a model");
  check_only_error(
      cli.parallax({"traces", "domain.e", "--plan", "scenario.yaml", "--bind", "robot.bind"}),
      "this is a scenario, not a plan");
  check_only_error(
      cli.parallax({"traces", "domain.e", "--plan", "fetch.lisp", "--bind", "fetch.lisp"}),
      "this is a plan, not a binding table");
  for (const auto* command : {"run", "rates", "draw"}) {
    CAPTURE(command);
    const auto model = cli.parallax({command, "domain.e"});
    check_only_error(model, "domain.e: error[E0010]: this is a model, not a scenario");
    CHECK(contains(model.err, "help: Try `parallax traces domain.e`"));
    check_only_error(cli.parallax({command, "program"}), "this is binary data, not a scenario");
    const auto manifest = cli.parallax({command, "cases.yaml"});
    check_only_error(manifest, "this is a manifest of cases, not a scenario");
    CHECK(contains(manifest.err, "`parallax suite cases.yaml`"));
  }
  check_only_error(cli.parallax({"check", "cases.yaml"}), "this is a manifest of cases");
  check_only_error(cli.parallax({"replay", "scenario.yaml"}),
                   "this is a scenario, not the folder of a run");
  // A file may be called as one likes.
  std::filesystem::copy_file(cli.folder() / "domain.e", cli.folder() / "domain.txt");
  CHECK(cli.parallax({"fmt", "--check", "domain.txt"}).code == 0);
}

TEST_CASE("compile SCENARIO prints every stage that it can print of a model") {
  const CliFixture cli;
  const auto list = cli.parallax({"compile", "--emit=help"}).out;
  std::vector<std::string> stages;
  for (std::size_t at = 0; at < list.size(); at = list.find('\n', at) + 1) {
    stages.push_back(list.substr(at, list.find(' ', at) - at));
  }
  REQUIRE(stages.size() > 15);
  for (const auto& stage : stages) {
    CAPTURE(stage);
    const auto result = cli.parallax({"compile", "scenario.yaml", "--emit=" + stage});
    CAPTURE(result.err);
    CHECK(result.code == 0);
    CHECK_FALSE(result.out.empty());
  }
  // The front end's stages are those of the model that the scenario names, with its horizon.
  const auto own = cli.parallax({"compile", "scenario.yaml", "--emit=lp"});
  const auto named =
      cli.parallax({"compile", "domain.e", "start.e", "--horizon", "6", "--emit=lp"});
  CHECK(own.out == named.out);
  CHECK(contains(own.err, "the model alone, without plan and constraints"));
}

TEST_CASE("an event at the last timepoint: why nothing happens there, and what to do") {
  const CliFixture cli;
  cli.write("m.e",
            "range time 0 2\nfluent F()\nevent Flip()\n[time] Initiates(Flip(),F(),time).\n"
            "Happens(Flip(),2).\n");
  const auto result = cli.parallax({"traces", "m.e"});
  check_only_error(result, "m.e:5:1-17: error[E3004]");
  CHECK(contains(result.err, "help: No event happens at the last timepoint, 2"));
  CHECK(contains(result.err, "`range time 0 3` or --horizon 3"));
  CHECK(cli.parallax({"traces", "m.e", "--horizon", "3"}).code == 0);
}

TEST_CASE("a list without a trace points to the command that explains it") {
  const CliFixture cli;
  cli.write("m.e",
            "range time 0 2\nfluent F()\nevent E()\n[time] Initiates(E(),F(),time).\n"
            "HoldsAt(F(),1) & !HoldsAt(F(),0).\nHoldsAt(F(),0) | !Happens(E(),0).\n");
  for (const auto& arguments :
       {std::vector<std::string>{"traces", "m.e"}, {"traces", "m.e", "--count"}}) {
    const auto result = cli.parallax(arguments);
    CHECK(result.code == 0);
    CHECK(contains(result.err, "no trace: `parallax explain m.e` says which axioms"));
  }
  CHECK(cli.parallax({"explain", "m.e"}).code == 1);
  const auto until = cli.parallax({"traces", "m.e", "--until", "HoldsAt(F(),time)"});
  CHECK(contains(until.err, "parallax explain m.e --until \"HoldsAt(F(),time)\""));
  // There is no advice about the rest of a list, or about a list that has traces.
  cli.write("ok.e", "range time 0 1\nfluent F()\n");
  CHECK_FALSE(contains(cli.parallax({"traces", "ok.e", "--from", "9"}).err, "explain"));
  CHECK_FALSE(contains(cli.parallax({"traces", "ok.e"}).err, "explain"));
}

TEST_CASE("the same advice is printed once") {
  const CliFixture cli;
  cli.write("m.e", "range time 0 1\nfluent F()\nHoldsAt(G(),0).\nHoldsAt(H(),0).\n");
  const auto err = cli.parallax({"check", "m.e"}).err;
  const std::string help = "help: Declare it, or correct the name.";
  CHECK(contains(err, help));
  CHECK(err.find(help) == err.rfind(help));
}

TEST_CASE("the file of --certify behind a blank: the message says how it is written") {
  const CliFixture cli;
  cli.write("old.drat", "");
  for (const char* file : {"p.drat", "old.drat", "proof"}) {
    for (const char* model : {"scenario.yaml", "domain.e"}) {
      CAPTURE(file);
      CAPTURE(model);
      const auto wanted = "write `--certify=" + std::string(file) + "`";
      check_only_error(cli.parallax({"traces", model, "--certify", file}), wanted, 2);
      check_only_error(cli.parallax({"traces", "--certify", file, model}), wanted, 2);
    }
  }
  // A model may stand there.
  CHECK(cli.parallax({"traces", "--horizon", "1", "--certify", "domain.e", "start.e"}).code == 0);
  CHECK(contains(cli.parallax({"traces", "--certify", "none.e"}).err, "none.e: error[E0001]"));
}

TEST_CASE("what stands behind -- is another program's") {
  const CliFixture cli;
  const auto result = cli.parallax({"record", "--", "sim", "--json"});
  CHECK(result.code == 2);
  CHECK(result.out == "");
  check_only_error(result, "error[E0007]: ", 2);
  CHECK(contains(result.err, "--output"));
  // No advice about its options either.
  CHECK_FALSE(contains(cli.parallax({"record", "--", "sim", "--outptu"}).err, "--outptu"));
  CHECK(contains(cli.parallax({"record", "--json", "--", "sim"}).out, "\"status\":\"error\""));
}

TEST_CASE("an event of the binding table with another number of arguments, or no event") {
  const CliFixture cli;
  const auto with = [&](const std::string& from, const std::string& to) {
    const auto table = cli.read("robot.bind");
    cli.replace("robot.bind", from, to);
    auto result = cli.parallax({"check", "scenario.yaml"});
    cli.write("robot.bind", table);
    return result;
  };
  const auto two = with("Go(region(?p))", "Go(region(?p),region(?p))");
  check_only_error(
      two,
      "E3088]: the plan performs `Go` with 2 arguments, and the model declares it with 1 argument");
  CHECK(contains(two.err, "note: `Go(region)` declared here"));
  check_only_error(with("Place(region(?p))", "PickUp(region(?p))"),
                   "E3088]: the plan performs `PickUp` with 1 argument, and the model declares it "
                   "with no arguments");
  check_only_error(with("Place(region(?p))", "Holding()"),
                   "E3089]: the plan performs `Holding`, which is a fluent of the model");
  check_only_error(with("Place(region(?p))", "Plase(region(?p))"),
                   "which is no event of the model");
}

TEST_CASE("a contradiction of many axioms is told in a few notes and a count") {
  const CliFixture cli;
  std::string model = cli.read("start.e");
  for (const char* atom : {"RobotIn(r2)", "BoxIn(r1)", "Holding()"}) {
    model += std::string("[time] time>3 -> !HoldsAt(") + atom + ",time).\n";
  }
  cli.write("start.e", model + "[time] time>4 -> HoldsAt(BoxIn(r1),time).\n");
  const auto result = cli.parallax({"run", "scenario.yaml", "--out", "r"});
  CHECK(contains(result.err, "E7001"));
  std::size_t parts = 0;
  for (auto at = result.err.find("takes part"); at != std::string::npos;
       at = result.err.find("takes part", at + 1)) {
    ++parts;
  }
  CHECK(parts >= 1);
  CHECK(parts <= 6);
}

TEST_CASE("a key that belongs below another says where; no list is promised that is not there") {
  const CliFixture cli;
  const auto scenario = cli.read("scenario.yaml");
  for (const char* key : {"sdf: a.sdf", "urdf: a.urdf", "mjcf: a.xml", "bodies: {}"}) {
    cli.write("moved.yaml", scenario + key + '\n');
    const auto name = std::string(key).substr(0, std::string(key).find(':'));
    const auto result = cli.parallax({"check", "moved.yaml"});
    check_only_error(result, "error[E5102]: `" + name + "` is not a key of the scenario");
    CHECK(contains(result.err, "note: `" + name + "` is a key of `world`"));
    CHECK(contains(result.err, "help: Move it below `world`."));
  }
  cli.write("models.yaml", "include: scenario.yaml\nworld: {models: [.]}\n");
  CHECK(contains(cli.parallax({"check", "models.yaml"}).err, "Name the file to take over"));
}

}  // namespace
}  // namespace parallax::test
