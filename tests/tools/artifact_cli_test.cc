#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

constexpr const char* kLamps =
    "sort lamp\nlamp A, B, C\nfluent On(lamp)\nevent Press(lamp)\n"
    "[lamp,time] !HoldsAt(On(lamp),time) -> Initiates(Press(lamp),On(lamp),time).\n"
    "[lamp,time] HoldsAt(On(lamp),time) -> Terminates(Press(lamp),On(lamp),time).\n"
    "[event1,event2,time] Happens(event1,time) & Happens(event2,time) -> event1=event2.\n"
    "[lamp] !HoldsAt(On(lamp),0).\nrange time 0 3\n";

/// A reader of the names and clauses, written from docs/reference/formats.md alone.
struct Stranger {
  std::map<int, std::string> names;  // "HoldsAt On(A) 2" by variable
  std::vector<std::vector<int>> clauses;
  std::vector<int> shown, hits;

  explicit Stranger(const std::string& text) {
    std::map<std::string, int> frame;
    std::vector<std::tuple<std::string, std::string, int>> slots;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string c, dec, key, name;
      words >> c;
      if (c != "c" && c != "p") {
        clauses.emplace_back();
        std::istringstream literals(line);
        for (int literal = 0; literals >> literal && literal != 0;) {
          clauses.back().push_back(literal);
        }
        continue;
      }
      words >> dec >> key;
      int number = 0;
      if (dec == "p" && key == "show") {
        while (words >> number && number != 0) shown.push_back(number);
      } else if (dec == "dec" && key == "atom") {
        words >> number >> name;
        if (name == "Hit") hits.push_back(number);
      } else if (dec == "dec" && (key == "horizon" || key == "base" || key == "stride")) {
        words >> frame[key];
      } else if (dec == "dec" && (key == "fluent" || key == "event")) {
        words >> name >> number;
        slots.emplace_back(key == "fluent" ? "HoldsAt" : "Happens", name, number);
      }
    }
    for (const auto& [kind, name, slot] : slots) {
      const int points = frame["horizon"] + (kind == "HoldsAt" ? 1 : 0);
      for (int t = 0; t < points; ++t) {
        names[frame["base"] + t * frame["stride"] + slot + 1] =
            kind + " " + name + " " + std::to_string(t);
      }
    }
  }
};

bool minisat_says_satisfiable(const CliFixture& cli, const std::string& file, std::string& model) {
  ProcessOptions options;
  options.folder = cli.folder().string();
  const auto result = run_process({"minisat", "-verb=0", file, "model.txt"}, options);
  REQUIRE((result.code == 10 || result.code == 20));
  model = cli.read("model.txt");
  return result.code == 10;
}

bool minisat_is_installed() { return run_process({"minisat", "--help"}).code == 0; }

}  // namespace

TEST_CASE("traces of a compiled model are those of its text, byte for byte") {
  const CliFixture cli;
  cli.write("lamps.e", kLamps);
  cli.write("fall.e",
            "load foundations/EC.e\nrange time 0 4\nfluent F()\nfluent G()\nevent E()\nevent D()\n"
            "[time] Initiates(E(),F(),time).\n[time] Releases(D(),G(),time).\n"
            "Happens(E(),1).\n!HoldsAt(F(),0).\nHoldsAt(G(),0).\n");
  const std::vector<std::vector<std::string>> models = {
      {"lamps.e"},
      {"fall.e"},
      {"fall.e", "--compat", "decreasoner"},
      {"lamps.e", "--horizon", "2"},
      {"lamps.e", "--until", "HoldsAt(On(A),time) & HoldsAt(On(B),time)"},
      {"edge.yaml"}};
  for (const auto& model : models) {
    CAPTURE(model.front());
    auto compile = model;
    compile.insert(compile.begin(), "compile");
    compile.insert(compile.end(), {"-o", "m.dec.cnf"});
    REQUIRE(cli.parallax(compile).code == 0);
    for (const auto& format : {"text", "jsonl"}) {
      auto direct = model;
      direct.insert(direct.begin(), "traces");
      const std::vector<std::string> options = {"--limit", "0", "--format", format};
      direct.insert(direct.end(), options.begin(), options.end());
      std::vector<std::string> read = {"traces", "m.dec.cnf"};
      read.insert(read.end(), options.begin(), options.end());
      const auto wanted = cli.parallax(direct), found = cli.parallax(read);
      CHECK(wanted.code == 0);
      CHECK(found.code == 0);
      CHECK(without_timing(found.out) == without_timing(wanted.out));
      CHECK(wanted.out.size() > 50);
    }
    REQUIRE(cli.parallax({"compile", "m.dec.cnf", "-o", "again.dec.cnf"}).code == 0);
    CHECK(cli.read("again.dec.cnf") == cli.read("m.dec.cnf"));
    CHECK(cli.parallax({"check", "m.dec.cnf"}).code == 0);
  }
}

TEST_CASE("a compiled model is the same bytes wherever the checkout lies") {
  const CliFixture cli;
  namespace fs = std::filesystem;
  const auto root = cli.folder();
  for (const auto* checkout : {"a", "b/deeper"}) {
    fs::create_directories(root / checkout / "cases");
    cli.write(std::string(checkout) + "/cases/part.e", "event Kick()\n");
    cli.write(std::string(checkout) + "/cases/lamps.e", std::string(kLamps) + "load part.e\n");
  }
  const auto compiled = [&](const std::string& in, std::vector<std::string> arguments) {
    ProcessOptions options;
    options.folder = (root / in).string();
    arguments.insert(arguments.begin(), "compile");
    const auto result = cli.parallax(std::move(arguments), options);
    CHECK_MESSAGE(result.code == 0, result.err);
    return result.out;
  };
  const auto absolute = [&](const char* name) { return (root / name / "cases/lamps.e").string(); };
  const auto text = compiled("a", {"cases/lamps.e"});
  CHECK(text.find("c dec source cases/lamps.e ") != std::string::npos);
  CHECK(compiled("b/deeper", {"cases/lamps.e"}) == text);
  CHECK(compiled("b/deeper", {absolute("b/deeper")}) == text);
  // From elsewhere a rule says where the checkout lies; the longest one counts.
  CHECK(compiled("a", {absolute("b/deeper")}) != text);
  CHECK(compiled("a", {absolute("b/deeper"), "--path-map", (root / "b/deeper").string() + "=",
                       "--path-map", root.string() + "=/src"}) == text);
  CHECK(cli.parallax({"compile", "a/cases/lamps.e", "--path-map", "a"}).code == 2);
  // A rule ends at a slash.
  CHECK(compiled("a", {"cases/lamps.e", "--path-map", "cas=x"}) == text);
}

TEST_CASE("a compiled model refuses what belongs to its compilation") {
  const CliFixture cli;
  cli.write("lamps.e", kLamps);
  REQUIRE(cli.parallax({"compile", "lamps.e", "-o", "m.dec.cnf"}).code == 0);
  const auto horizon = cli.parallax({"traces", "m.dec.cnf", "--horizon", "9"});
  CHECK(horizon.code == 3);
  CHECK(horizon.err.find("E6014") != std::string::npos);
  CHECK(cli.parallax({"traces", "m.dec.cnf", "--horizon", "3"}).code == 0);
  CHECK(cli.parallax({"traces", "m.dec.cnf", "--compat", "decreasoner"}).code == 2);
  CHECK(cli.parallax({"traces", "m.dec.cnf", "lamps.e"}).code == 2);
  CHECK(cli.parallax({"traces", "m.dec.cnf", "--check"}).code == 2);
  CHECK(cli.parallax({"compile", "m.dec.cnf", "--emit=lp"}).code == 2);
  cli.write("short.dec.cnf", cli.read("m.dec.cnf").substr(0, 900));
  const auto damaged = cli.parallax({"check", "short.dec.cnf"});
  CHECK(damaged.code == 3);
  CHECK(damaged.err.find("short.dec.cnf:") != std::string::npos);
}

TEST_CASE("a compiled model that is older than its texts is told wherever one is read") {
  const CliFixture cli;
  cli.write("part.e", "event Kick()\n");
  cli.write("lamps.e", std::string(kLamps) + "load part.e\n");
  std::filesystem::create_directory(cli.folder() / "sub");
  REQUIRE(cli.parallax({"compile", "lamps.e", "-o", "m.dec.cnf"}).code == 0);
  const auto told = [&](const std::vector<std::string>& arguments, const std::string& what) {
    const auto result = cli.parallax(arguments);
    CAPTURE(arguments.front());
    CHECK_MESSAGE((result.err.find("W6080") != std::string::npos) == !what.empty(), result.err);
    CHECK(result.err.find(what) != std::string::npos);
  };
  const std::vector<std::vector<std::string>> readers = {
      {"traces", "m.dec.cnf", "--count"}, {"check", "m.dec.cnf"},
      {"explain", "m.dec.cnf"},           {"consequences", "m.dec.cnf"},
      {"diff", "m.dec.cnf", "m.dec.cnf"}, {"diff", "lamps.e", "m.dec.cnf"}};
  for (const auto& reader : readers) told(reader, "");
  cli.write("part.e", "event Kick()\nevent Push()\n");
  for (const auto& reader : readers) told(reader, "the text `part.e` has changed");
  std::filesystem::remove(cli.folder() / "part.e");
  told(readers.front(), "the text `part.e` was removed");
  // A byte order mark is no part of the text, and the names start beside the compiled model, too.
  cli.write("part.e",
            "\xEF\xBB\xBF"
            "event Kick()\n");
  told(readers.front(), "");
  for (const auto* name : {"m.dec.cnf", "lamps.e", "part.e"}) {
    std::filesystem::rename(cli.folder() / name, cli.folder() / "sub" / name);
  }
  told({"traces", "sub/m.dec.cnf"}, "");
  cli.write("sub/lamps.e", kLamps);
  told({"traces", "sub/m.dec.cnf"}, "the text `lamps.e` has changed");
  // Without its texts it stands alone.
  std::filesystem::remove(cli.folder() / "sub/lamps.e");
  std::filesystem::remove(cli.folder() / "sub/part.e");
  told({"traces", "sub/m.dec.cnf"}, "");
}

TEST_CASE("a scenario, its compiled model and a case of a suite have the same number of traces") {
  const CliFixture cli;
  const std::vector<std::string> constraints = {
      "HoldsAt(Holding(),time)", "HoldsAt(BoxIn(r1),time)", "HoldsAt(RobotIn(r1),time)",
      "HoldsAt(BoxIn(r2),time) & HoldsAt(RobotIn(r2),time)"};
  for (const auto& constraint : constraints) {
    CAPTURE(constraint);
    cli.write("cut.yaml",
              "include: common.yaml\nmodel: [domain.e, start.e]\nhorizon: 2\nconstraints: ['" +
                  constraint + "']\n");
    const auto count = cli.parallax({"traces", "cut.yaml", "--count"}).out;
    REQUIRE_FALSE(count.empty());
    REQUIRE(cli.parallax({"compile", "cut.yaml", "-o", "cut.dec.cnf"}).code == 0);
    CHECK(cli.parallax({"traces", "cut.dec.cnf", "--count"}).out == count);
    const auto number = count.substr(0, count.find('\n'));
    cli.write("suite.yaml", "cases:\n  - {id: a, model: cut.yaml, expect: {traces: " + number +
                                "}}\n  - {id: b, model: cut.dec.cnf, expect: {traces: " + number +
                                "}}\n");
    CHECK(cli.parallax({"suite", "suite.yaml", "--no-cache"}).code == 0);
    const auto listed = cli.parallax({"traces", "cut.yaml", "--limit", "0"}).out;
    CHECK(listed.find(number + " trace") != std::string::npos);
  }
  // Constraints that would not count are refused.
  const auto until = cli.parallax({"traces", "cut.yaml", "--until", "HoldsAt(Holding(),time)"});
  CHECK(until.code == 2);
  CHECK(until.err.find("--until is for models") != std::string::npos);
}

TEST_CASE("a stranger's reader and another solver agree with us") {
  if (!minisat_is_installed()) {
    MESSAGE("SKIPPED: minisat is not installed");
    return;
  }
  const CliFixture cli;
  cli.write("lamps.e", kLamps);
  for (const auto& [goal, possible] : std::map<std::string, bool>{
           {"HoldsAt(On(A),3) & HoldsAt(On(B),3) & HoldsAt(On(C),3).\n", true},
           {"HoldsAt(On(A),2) & HoldsAt(On(B),2) & HoldsAt(On(C),2).\n", false}}) {
    cli.write("goal.e", std::string(kLamps) + goal);
    REQUIRE(cli.parallax({"compile", "goal.e", "--no-projection-line", "-o", "m.dec.cnf"}).code ==
            0);
    std::string answer;
    CHECK(minisat_says_satisfiable(cli, "m.dec.cnf", answer) == possible);
    CHECK((cli.parallax({"traces", "goal.e", "--count"}).out != "0\n") == possible);
    if (!possible) continue;
    const Stranger stranger(cli.read("m.dec.cnf"));
    std::set<std::string> pressed, lit;
    std::istringstream words(answer.substr(answer.find('\n') + 1));
    for (int literal = 0; words >> literal && literal != 0;) {
      const auto name = stranger.names.find(literal);
      if (name == stranger.names.end()) continue;
      if (name->second.starts_with("Happens")) pressed.insert(name->second);
      if (name->second.ends_with(" 3")) lit.insert(name->second);
    }
    CHECK(pressed.size() == 3);
    CHECK(lit == std::set<std::string>{"HoldsAt On(A) 3", "HoldsAt On(B) 3", "HoldsAt On(C) 3"});
  }
  REQUIRE(cli.parallax({"compile", "lamps.e", "-o", "m.dec.cnf"}).code == 0);
  const Stranger stranger(cli.read("m.dec.cnf"));
  std::set<int> named;
  for (const auto& [variable, name] : stranger.names) named.insert(variable);
  CHECK(std::set<int>(stranger.shown.begin(), stranger.shown.end()) == named);
}

/// Models of the clauses that differ in a shown variable, counted by another solver.
std::size_t counted_by_minisat(const CliFixture& cli, std::vector<std::vector<int>> clauses,
                               const std::vector<int>& shown) {
  const std::set<int> is_shown(shown.begin(), shown.end());
  for (std::size_t count = 0;; ++count) {
    REQUIRE(count < 1000);
    int variables = 0;
    std::ostringstream text;
    for (const auto& clause : clauses) {
      for (const int literal : clause) {
        variables = std::max(variables, std::abs(literal));
        text << literal << ' ';
      }
      text << "0\n";
    }
    cli.write("count.cnf", "p cnf " + std::to_string(variables) + ' ' +
                               std::to_string(clauses.size()) + '\n' + text.str());
    std::string model;
    if (!minisat_says_satisfiable(cli, "count.cnf", model)) return count;
    auto& other = clauses.emplace_back();
    std::istringstream words(model.substr(model.find('\n') + 1));
    for (int literal = 0; words >> literal && literal != 0;) {
      if (is_shown.contains(std::abs(literal))) other.push_back(-literal);
    }
    REQUIRE(!other.empty());
  }
}

TEST_CASE("another solver counts as many traces, also with plans and constraints") {
  if (!minisat_is_installed()) {
    MESSAGE("SKIPPED: minisat is not installed");
    return;
  }
  const CliFixture cli;
  for (const std::string name :
       {"two_regions/edge", "ward/weight", "ward/bring", "kitchen/plan2"}) {
    CAPTURE(name);
    const auto scenario = std::string(PARALLAX_SOURCE_DIR) + "/scenarios/" + name + ".yaml";
    REQUIRE(cli.parallax({"compile", scenario, "-o", "s.dec.cnf"}).code == 0);
    const Stranger stranger(cli.read("s.dec.cnf"));
    REQUIRE(!stranger.hits.empty());
    auto clauses = stranger.clauses;
    clauses.push_back(stranger.hits);
    const auto count = counted_by_minisat(cli, std::move(clauses), stranger.shown);
    CHECK(count > 0);
    CHECK(cli.parallax({"traces", scenario, "--split-initial", "--limit", "0", "--count"}).out ==
          std::to_string(count) + '\n');
  }
}

}  // namespace parallax::test
