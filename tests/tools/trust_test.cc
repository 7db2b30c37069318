// Files of unknown origin: the limits on the files and programs that they can make Parallax read,
// overwrite and start (docs/reference/trust.md).

#include <sys/stat.h>
#include <unistd.h>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The two regions in `inner`, and beside that folder a secret that is no model, plan or scenario.
class Stranger : public CliFixture {
 public:
  Stranger() {
    fs::create_directory(folder() / "inner");
    for (const auto& entry : fs::directory_iterator(folder())) {
      if (entry.is_regular_file()) {
        fs::rename(entry.path(), folder() / "inner" / entry.path().filename());
      }
    }
    write("secret", "password: [hunter2\n");
  }
  /// A variant of the scenario that names something else.
  void variant(const std::string& text) const {
    write("inner/s.yaml", "include: edge.yaml\n" + text);
  }
  void check_refused(const std::vector<std::string>& command) const {
    CAPTURE(command.front());
    const auto result = parallax(command);
    CAPTURE(result.err);
    CHECK(result.code == 3);
    CHECK(holds(result.err, "E1016"));
    CHECK_FALSE(holds(result.err, "hunter2"));
  }
};

TEST_CASE("no path of a scenario leaves its folder") {
  const Stranger cli;
  SUBCASE("model") { cli.variant("model: ../secret\n"); }
  SUBCASE("model, whole") { cli.variant("model: " + (cli.folder() / "secret").string() + "\n"); }
  SUBCASE("plan") { cli.variant("plan: ../secret\n"); }
  SUBCASE("bind") { cli.variant("bind: ../secret\n"); }
  SUBCASE("include") { cli.write("inner/s.yaml", "include: [edge.yaml, ../secret]\n"); }
  SUBCASE("world") { cli.variant("world: {include: ../secret}\n"); }
  SUBCASE("a link to a file") {
    fs::create_symlink("../secret", cli.folder() / "inner/link.e");
    cli.variant("model: link.e\n");
  }
  SUBCASE("a link to a folder") {
    fs::create_symlink("..", cli.folder() / "inner/up");
    cli.variant("model: up/secret\n");
  }
  for (const auto* command : {"check", "run", "rates", "draw", "traces", "compile"}) {
    cli.check_refused({command, "inner/s.yaml"});
    CHECK_FALSE(holds(cli.parallax({command, "inner/s.yaml", "--allow-outside"}).err, "E1016"));
  }
}

TEST_CASE("it is not told whether a file outside exists") {
  const Stranger cli;
  cli.variant("model: ../nothing\n");
  const auto result = cli.parallax({"check", "inner/s.yaml"});
  CHECK(result.code == 3);
  CHECK(holds(result.err, "inner/s.yaml:2:8-17: error[E1016]"));
  CHECK_FALSE(holds(result.err, "E0001"));
}

TEST_CASE("a marker, or the option, lets a scenario use what lies beside its folder") {
  const Stranger cli;
  fs::rename(cli.folder() / "inner/domain.e", cli.folder() / "domain.e");
  cli.variant("model: [../domain.e, start.e]\n");
  const std::vector<std::string> rates = {"rates", "inner/s.yaml", "--runs", "2"};
  CHECK(cli.parallax(rates).code == 3);
  auto allowed = rates;
  allowed.emplace_back("--allow-outside");
  CHECK(cli.parallax(allowed).code == 0);  // the worker reads the scenario, too
  cli.write(".parallax-root", "");
  CHECK(cli.parallax(rates).code == 0);
}

TEST_CASE("a run of a scenario that reads what lies beside its folder: what repeats it is named") {
  const Stranger cli;
  fs::rename(cli.folder() / "inner/domain.e", cli.folder() / "domain.e");
  cli.variant("model: [../domain.e, start.e]\n");
  const auto run = cli.parallax({"run", "inner/s.yaml", "--out", "out", "--allow-outside"});
  CAPTURE(run.err);
  REQUIRE(run.code == 1);
  for (const auto* command : {"replay", "explain", "repair"}) {
    CAPTURE(command);
    const auto refused = cli.parallax({command, "out"});
    CHECK(refused.code == 3);
    CHECK(holds(refused.err, "E7113"));
    CHECK(holds(refused.err, "outside of its folder, which --allow-outside permits"));
  }
  CHECK(cli.parallax({"replay", "out", "--allow-outside"}).code == 0);
}

TEST_CASE("a model of a scenario loads from the scenario's folder, from wherever one stands") {
  const CliFixture cli;
  fs::create_directory(cli.folder() / "models");
  fs::rename(cli.folder() / "domain.e", cli.folder() / "models/domain.e");
  fs::copy(cli.folder() / "start.e", cli.folder() / "rest.e");
  cli.write("models/start.e", "load ../rest.e\n");
  cli.write("s.yaml", "include: edge.yaml\nmodel: [models/domain.e, models/start.e]\n");
  ProcessOptions options;
  options.folder = "/";
  CHECK(cli.parallax({"check", (cli.folder() / "s.yaml").string()}, options).code == 0);
}

TEST_CASE("the current folder is no root for load where it is a home folder") {
  const CliFixture cli;
  fs::create_directory(cli.folder() / "models");
  cli.write("secret.e", "sort hunter\n");
  cli.write("models/m.e", "load ../secret.e\nrange time 0 1\n");
  const auto check = [&](const std::string& home) {
    ProcessOptions options;
    options.folder = cli.folder().string();
    return run_process({"/usr/bin/env", "HOME=" + home,
                        std::string(PARALLAX_BINARY_DIR) + "/parallax", "check", "models/m.e"},
                       options);
  };
  CHECK(check("/nowhere").code == 0);
  const auto refused = check(cli.folder().string());
  CHECK(refused.code == 3);
  CHECK(holds(refused.err, "models/m.e:1:6-16: error[E1016]"));
  CHECK_FALSE(holds(refused.err, "hunter"));
}

TEST_CASE("a run folder's journal, report and pictures lie in it") {
  const Stranger cli;
  REQUIRE(cli.parallax({"run", "inner/edge.yaml", "--out", "r"}).code == 1);
  const auto link = [&](const std::string& name) {
    fs::remove_all(cli.folder() / "r" / name);
    fs::create_symlink("../secret", cli.folder() / "r" / name);
  };
  SUBCASE("journal") {
    link("journal.ndjson");
    for (const auto* command : {"replay", "draw", "explain"}) cli.check_refused({command, "r"});
    const auto resumed = cli.parallax({"run", "inner/edge.yaml", "--out", "r", "--resume"});
    CHECK(resumed.code == 3);
    CHECK_FALSE(holds(resumed.err, "hunter2"));
  }
  SUBCASE("report") {
    link("report.json");
    cli.check_refused({"explain", "r"});
    cli.check_refused({"diff", "r", "r"});
  }
  SUBCASE("pictures") {
    fs::create_directory(cli.folder() / "victim");
    fs::create_symlink("../victim", cli.folder() / "r/pictures");
    CHECK(cli.parallax({"draw", "r"}).code == 3);
    CHECK(fs::is_empty(cli.folder() / "victim"));
  }
  CHECK(cli.read("secret") == "password: [hunter2\n");
}

TEST_CASE("an output that nobody named is not written through a link out of the folder") {
  const CliFixture cli;
  cli.write("case.yaml", "include: edge.yaml\nexpect: {verdict: discrepancy, fast: true}\n");
  fs::create_directory(cli.folder() / "away");
  fs::create_directory(cli.folder() / "here");
  for (const auto& entry : fs::directory_iterator(cli.folder())) {
    if (entry.is_regular_file()) {
      fs::rename(entry.path(), cli.folder() / "here" / entry.path().filename());
    }
  }
  ProcessOptions options;
  options.folder = (cli.folder() / "here").string();
  const auto refused = [&](const std::vector<std::string>& command) {
    CAPTURE(command.front());
    const auto result = cli.parallax(command, options);
    CAPTURE(result.err);
    CHECK(result.code == 2);
    CHECK(holds(result.err, "error[E0077]"));
    CHECK(holds(result.err, "the link `out"));
    CHECK(fs::is_empty(cli.folder() / "away"));
  };
  fs::create_symlink("../away", cli.folder() / "here/out");
  refused({"suite", "case.yaml"});
  refused({"suite", "case.yaml", "--no-cache"});
  refused({"suite", "case.yaml", "--mutate"});
  refused({"run", "edge.yaml"});
  refused({"learn", "edge.yaml"});
  // A place that is named is written to, wherever it leads.
  CHECK(cli.parallax({"run", "edge.yaml", "--out", "out/edge", "-q"}, options).code == 1);
  CHECK(fs::exists(cli.folder() / "away/edge/journal.ndjson"));
  fs::remove_all(cli.folder() / "away/edge");
  fs::remove(cli.folder() / "here/out");
  fs::create_directories(cli.folder() / "here/out/suite");
  fs::create_symlink("../../../away", cli.folder() / "here/out/suite/cache");
  refused({"suite", "case.yaml"});
  fs::remove(cli.folder() / "here/out/suite/cache");
  CHECK(cli.parallax({"suite", "case.yaml"}, options).code == 0);
}

TEST_CASE("no output replaces a file that the command reads") {
  const CliFixture cli;
  cli.write("m.e", "range time 0 1\nfluent F()\nload part.e\n");
  cli.write("part.e", "!HoldsAt(F(),0).\n");
  REQUIRE(cli.parallax({"compile", "m.e", "-o", "m.dec.cnf"}).code == 0);
  REQUIRE(cli.parallax({"traces", "m.e", "--format", "jsonl"}).code == 0);
  fs::create_symlink("m.e", cli.folder() / "link.e");
  const auto before = files_below(cli.folder());
  const auto refuses = [&](const std::vector<std::string>& command) {
    CAPTURE(command.front() + " " + command.back());
    const auto result = cli.parallax(command);
    CAPTURE(result.err);
    CHECK(result.code == 2);
    CHECK(holds(result.err, "E0011"));
    CHECK(files_below(cli.folder()) == before);
  };
  refuses({"compile", "m.e", "-o", "m.e"});
  refuses({"compile", "m.e", "-o", "part.e"});
  refuses({"compile", "m.e", "-o", "link.e"});
  refuses({"compile", "m.dec.cnf", "-o", "m.dec.cnf"});
  refuses({"compile", "m.e", "--emit=ast", "-o", "./m.e"});
  refuses({"compile", "edge.yaml", "-o", "world.yaml"});
  refuses({"traces", "m.e", "--limit", "0", "--certify=m.e"});
  refuses({"traces", "m.dec.cnf", "--limit", "0", "--certify=m.dec"});
  refuses({"verify", "m.e", "--property", "!HoldsAt(F(),time)", "--certify=part.e"});
  refuses({"draw", "edge.yaml", "-o", "edge.yaml"});
  refuses({"draw", "edge.yaml", "-o", "domain.e"});
}

TEST_CASE("a scenario that is called like a report is not replaced by one") {
  const CliFixture cli;
  fs::create_directory(cli.folder() / "run");
  for (const auto& entry : fs::directory_iterator(cli.folder())) {
    const auto name = entry.path().filename();
    if (!entry.is_regular_file()) continue;
    fs::copy(entry.path(), cli.folder() / "run" / (name == "edge.yaml" ? "report.txt" : name));
  }
  const auto before = cli.read("run/report.txt");
  const auto result = cli.parallax({"run", "run/report.txt", "--out", "run"});
  CHECK(result.code == 2);
  CHECK(holds(result.err, "E0011"));
  CHECK(cli.read("run/report.txt") == before);
}

/// A scenario whose simulator leaves a file behind and says nothing.
class CommandFixture : public CliFixture {
 public:
  CommandFixture() {
    write("s.yaml",
          "include: wrong_model.yaml\n"
          "simulator: {command: [touch, started], hello_timeout_s: 5}\n");
  }
  bool started() const { return fs::exists(folder() / "started"); }
};

TEST_CASE("run and rates start the command of the scenario that they name, and say so") {
  const CommandFixture cli;
  for (const auto* command : {"run", "rates"}) {
    CAPTURE(command);
    std::error_code ignored;
    fs::remove(cli.folder() / "started", ignored);
    const auto refused = cli.parallax({command, "s.yaml", "--no-commands"});
    CHECK(refused.code == 2);
    CHECK(holds(refused.err, "s.yaml:2:"));
    CHECK(holds(refused.err, "E7114"));
    CHECK(holds(refused.err, "`touch started`"));
    CHECK_FALSE(cli.started());
    const auto result = cli.parallax({command, "s.yaml"});
    CHECK(holds(result.err, "starting `touch started`, as s.yaml:2 says\n"));
    CHECK(result.code == 4);
    CHECK(cli.started());
  }
}

TEST_CASE("commands that do not simulate start nothing") {
  const CommandFixture cli;
  for (const auto* command : {"check", "traces", "draw", "compile", "explain"}) {
    (void)cli.parallax({command, "s.yaml"});
    CHECK_FALSE(cli.started());
  }
}

TEST_CASE("a suite starts commands only where that is permitted") {
  const CommandFixture cli;
  const auto refused = json_of(cli, {"suite", "s.yaml"}, 1);
  CHECK(refused["errors"] == 1);
  CHECK(holds(refused["cases"][0]["problems"][1], "E7114"));
  CHECK_FALSE(cli.started());
  const auto allowed = cli.parallax({"suite", "s.yaml", "--allow-commands"});
  CHECK(holds(allowed.err, "s.yaml starts `touch started`\n"));
  CHECK(cli.started());
}

TEST_CASE("replay starts a command only where that is permitted, even if every hash fits") {
  const CommandFixture cli;
  // A folder as its author would make it: recorded elsewhere, and made to fit.
  REQUIRE(cli.parallax({"run", "wrong_model.yaml", "--out", "r"}).code == 1);
  const auto changed = cli.parallax({"replay", "r", "--scenario", "s.yaml"});
  const std::string now = "now it is ";
  const auto at = changed.err.find(now);
  REQUIRE(at != std::string::npos);
  const auto hash = changed.err.substr(at + now.size(), 32);
  auto journal = cli.read("r/journal.ndjson");
  const std::string key = "\"scenario_hash\":\"";
  journal.replace(journal.find(key) + key.size(), 32, hash);
  cli.write("r/journal.ndjson", journal);
  for (const auto& arguments : {std::vector<std::string>{"replay", "r", "--scenario", "s.yaml"}}) {
    const auto refused = cli.parallax(arguments);
    CHECK(refused.code == 2);
    CHECK(holds(refused.err, "E7114"));
    CHECK_FALSE(cli.started());
    auto allowed = arguments;
    allowed.emplace_back("--allow-commands");
    CHECK(holds(cli.parallax(allowed).err, "starting `touch started`"));
    CHECK(cli.started());
  }
}

}  // namespace
}  // namespace parallax::test
