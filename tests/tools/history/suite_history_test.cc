// `suite --history` and `report --history` as real processes.

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/tools/cli_json.h"
#include "tests/tools/history/git_repository.h"
#include "tests/tools/suite/suite_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

std::vector<Json> lines_of(const std::string& text) {
  std::vector<Json> out;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) out.push_back(Json::parse(line, nullptr, false));
  return out;
}

const std::vector<std::string> kWith = {"--history", "h.jsonl", "--revision", "r1", "--no-cache"};

TEST_CASE("every suite appends its line, and says what changed since the one before") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  CHECK(cli.suite(kWith).code == 0);
  auto second = kWith;
  second[3] = "r2";
  cli.write("s/lamp.e", std::string(kLamp) + "event Pull()\n");
  const auto result = cli.suite(second);
  CHECK(result.code == 1);
  CHECK_MESSAGE(holds(result.err,
                      "r2: s/suite.yaml:both: passed, then failed; files that it reads "
                      "changed"),
                result.err);
  const auto lines = lines_of(cli.read("h.jsonl"));
  REQUIRE(lines.size() == 2);
  CHECK(lines[0]["revision"] == "r1");
  CHECK(lines[1]["cases"]["s/suite.yaml:lit"]["outcome"] == "failed");
  CHECK(lines[1]["paths"] == Json::array({"s"}));
  // Another suite in the same file is compared with nothing.
  CHECK(cli.suite({"--history", "h.jsonl", "--only", "lit"}).code == 1);
  const auto page = cli.parallax({"report", "--history", "h.jsonl", "-o", "h.html"});
  CHECK_MESSAGE(page.code == 0, page.err);
  CHECK(holds(page.out, "r2: s/suite.yaml:both: passed, then failed"));
  CHECK(page.out.ends_with("h.html\n"));
  const auto html = cli.read("h.html");
  CHECK(holds(html, "2 changes in 3 lines"));
  CHECK(holds(html, "Suite s --only lit"));
  const auto document = json_of(cli, {"report", "--history", "h.jsonl", "-o", "h.html"});
  CHECK(document["changes"].size() == 2);
  CHECK(document["changes"][0]["revision"] == "r2");
}

TEST_CASE("the revision is asked of git, and nothing of the repository is run for that") {
  const GitFixture repository;
  fs::create_directories(repository.folder() / "s");
  repository.write("s/lamp.e", kLamp);
  repository.write("s/suite.yaml", "cases:\n  - {id: a, model: lamp.e, expect: {traces: 2}}\n");
  const auto commit = repository.commit("first");
  const auto mark = repository.folder() / "executed";
  repository.write("evil.sh", "#!/bin/sh\ntouch '" + mark.string() + "'\n");
  fs::permissions(repository.folder() / "evil.sh", fs::perms::owner_all);
  repository.write(".git/config",
                   repository.read(".git/config") +
                       "[core]\n\tfsmonitor = " + (repository.folder() / "evil.sh").string() +
                       "\n\tpager = " + (repository.folder() / "evil.sh").string() + "\n");
  CHECK(repository.parallax({"suite", "s", "--history", "h.jsonl"}).code == 0);
  CHECK(lines_of(repository.read("h.jsonl"))[0]["revision"] == commit.substr(0, 12));
  CHECK(!fs::exists(mark));
}

TEST_CASE("files that are not committed are told, and no filter of the repository runs for that") {
  const GitFixture repository;
  fs::create_directories(repository.folder() / "s");
  repository.write("s/lamp.e", kLamp);
  repository.write("s/suite.yaml", "cases:\n  - {id: a, model: lamp.e, expect: {traces: 2}}\n");
  repository.write(".gitattributes", "*.e filter=a=b\n");
  const auto commit = repository.commit("first").substr(0, 12);
  const auto mark = repository.folder() / "executed";
  repository.write("evil.sh", "#!/bin/sh\ntouch '" + mark.string() + "'\ncat\n");
  fs::permissions(repository.folder() / "evil.sh", fs::perms::owner_all);
  repository.git({"config", "filter.a=b.clean", (repository.folder() / "evil.sh").string()});
  const auto revision = [&](int code) {
    const auto result = repository.parallax({"suite", "s", "--history", "h.jsonl"});
    CHECK_MESSAGE(result.code == code, result.err);
    return lines_of(repository.read("h.jsonl")).back()["revision"].get<std::string>() + ' ' +
           result.err;
  };
  // Touched, so that git has to look into it; other files do not count.
  repository.write("s/lamp.e", kLamp);
  fs::last_write_time(repository.folder() / "s/lamp.e",
                      fs::file_time_type::clock::now() - std::chrono::hours(1));
  CHECK(revision(0).starts_with(commit + ' '));
  CHECK(!fs::exists(mark));
  repository.write("s/lamp.e", std::string(kLamp) + "[time] !Happens(Press(),time).\n");
  const auto changed = revision(1);
  CHECK(changed.starts_with(commit + "+changes "));
  CHECK_MESSAGE(holds(changed, commit + "+changes: s/suite.yaml:a: passed, then failed"), changed);
  CHECK(!fs::exists(mark));
  // An untracked file is not in the commit either.
  repository.write("s/lamp.e", kLamp);
  repository.write("s/new.e", kLamp);
  repository.git({"commit", "--quiet", "--allow-empty", "--message", "second"});
  repository.write("s/suite.yaml", "cases:\n  - {id: a, model: new.e, expect: {traces: 2}}\n");
  CHECK(holds(revision(0), "+changes "));
  // A revision given by the user is recorded as given.
  CHECK(repository.parallax({"suite", "s", "--history", "h.jsonl", "--revision", "mine"}).code ==
        0);
  CHECK(lines_of(repository.read("h.jsonl")).back()["revision"] == "mine");
}

TEST_CASE("whether files in a submodule changed, the commit of the whole does not say") {
  const GitFixture repository;
  fs::create_directories(repository.folder() / "s");
  repository.write("s/lamp.e", kLamp);
  repository.commit("first");
  repository.git({"-c", "protocol.file.allow=always", "submodule", "--quiet", "add",
                  repository.folder().string(), "part"});
  repository.write("s/suite.yaml",
                   "cases:\n  - {id: a, model: ../part/s/lamp.e, expect: {traces: 2}}\n");
  const auto commit = repository.commit("second").substr(0, 12);
  CHECK(repository.parallax({"suite", "s", "--history", "h.jsonl", "--allow-outside"}).code == 0);
  CHECK(lines_of(repository.read("h.jsonl")).back()["revision"] == commit + "+unknown");
}

TEST_CASE("verdicts and rates of scenarios stand in the line, also of passes that were kept") {
  const CliFixture cli;
  cli.write("edge.yaml",
            "include: common.yaml\nmodel: [domain.e, start.e]\nplan: edge.lisp\n"
            "bind: robot.bind\nhorizon: 6\nconstraints:\n"
            "  - \"{region} (Happens(Place(region),time-1) & HoldsAt(BoxIn(region),time))\"\n"
            "expect: {verdict: discrepancy, rate: {between: [0.0, 1.0], runs: 8}}\n");
  const std::vector<std::string> suite = {"suite", "edge.yaml", "--history", "h.jsonl"};
  CHECK(cli.parallax(suite).code == 0);
  CHECK(cli.parallax(suite).code == 0);
  const auto lines = lines_of(cli.read("h.jsonl"));
  REQUIRE(lines.size() == 2);
  for (const auto& line : lines) {
    const auto& one = line["cases"]["edge.yaml"];
    CHECK(one["verdict"] == "discrepancy");
    CHECK(one["rates"][0]["of"] == "trace 1: any discrepancy");
    CHECK(one["rates"][0]["runs"] == 8);
    CHECK(one["rates"][0]["upper"] > one["rates"][0]["lower"]);
  }
  CHECK(lines[0]["cases"]["edge.yaml"]["rates"] == lines[1]["cases"]["edge.yaml"]["rates"]);
  CHECK(cli.parallax({"report", "--history", "h.jsonl"}).out == "nothing changed\nhistory.html\n");
  CHECK(holds(cli.read("history.html"), "Rates with their intervals"));
}

TEST_CASE("each line says by value what changed in the files of a case") {
  const GitFixture cli;
  fs::create_directories(cli.folder() / "s");
  for (const auto* name : {"scenario.yaml", "common.yaml", "world.yaml", "domain.e", "start.e",
                           "fetch.lisp", "robot.bind"}) {
    fs::copy(cli.folder() / name, cli.folder() / "s" / name);
  }
  cli.write("s/suite.yaml", "cases:\n  - {id: a, model: scenario.yaml, expect: {traces: 1}}\n");
  cli.write("s/lamp.e", kLamp);
  cli.write("s/lamps.yaml", "cases:\n  - {id: b, model: lamp.e, expect: {traces: 2}}\n");
  const auto told = [&](const std::string& revision, int code) {
    const auto result = cli.parallax(
        {"suite", "s", "--only", ".yaml:", "--history", "h.jsonl", "--revision", revision});
    CHECK_MESSAGE(result.code == code, result.err);
    return result.err;
  };
  told("r1", 0);
  cli.replace("s/world.yaml", "mass_kg: 0.3", "mass_kg: 0.35");
  const auto second = told("r2", 0);
  CHECK_MESSAGE(holds(second,
                      "r2: s/suite.yaml:a: passed as before; world.bodies.box.mass_kg 0.3 "
                      "-> 0.35"),
                second);
  CHECK_FALSE(holds(second, "r2: s/lamps.yaml"));
  cli.write("s/lamp.e", std::string(kLamp) + "[time] !Happens(Press(),time).\n");
  cli.write("s/world.yaml", cli.read("s/world.yaml") + "# That is all.\n");
  const auto third = told("r3", 1);
  CHECK_MESSAGE(holds(third,
                      "r3: s/lamps.yaml:b: passed, then failed; files that it reads changed: "
                      "added: [time] !Happens(Press(),time)."),
                third);
  // A comment changes no value.
  CHECK_FALSE(holds(third, "r3: s/suite.yaml:a"));
  const auto lines = lines_of(cli.read("h.jsonl"));
  CHECK(lines[1]["cases"]["s/suite.yaml:a"]["changes"] ==
        Json::array({"world.bodies.box.mass_kg 0.3 -> 0.35"}));
  const auto page = cli.parallax({"report", "--history", "h.jsonl", "-o", "h.html"});
  CHECK(holds(page.out, "world.bodies.box.mass_kg 0.3 -> 0.35"));
  const auto html = cli.read("h.html");
  CHECK(holds(html, "mass_kg 0.3 -&gt; 0.35"));
  CHECK(holds(html, "<h1>1 of 2 cases failed</h1>"));
}

TEST_CASE("the page tells the present state, and subject and date of each revision") {
  const GitFixture repository;
  fs::create_directories(repository.folder() / "s");
  repository.write("s/lamp.e", kLamp);
  repository.write("s/suite.yaml", "cases:\n  - {id: a, model: lamp.e, expect: {traces: 2}}\n");
  repository.commit("Light a lamp");
  CHECK(repository.parallax({"suite", "s", "--history", "h.jsonl"}).code == 0);
  const auto line = lines_of(repository.read("h.jsonl")).back();
  CHECK(line["subject"] == "Light a lamp");
  const auto date = repository.git({"log", "-1", "--format=%cs"});
  CHECK(line["date"] == date);
  CHECK(repository.parallax({"report", "--history", "h.jsonl", "-o", "h.html"}).code == 0);
  const auto html = repository.read("h.html");
  CHECK(holds(html, "<h1>The case passed</h1>"));
  CHECK(holds(html, "<td data-label=\"Date\">" + date + "</td>"));
  CHECK(holds(html, "<td data-label=\"Subject\">Light a lamp</td>"));
  CHECK(holds(html, "<td data-label=\"Cases\">the case passed</td>"));
}

TEST_CASE("half-written lines and lines of others are passed over and said") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  REQUIRE(cli.suite(kWith).code == 0);
  const auto whole = cli.read("h.jsonl");
  cli.write("h.jsonl", whole + "{\"other\":1}\n" + whole.substr(0, 40));
  const auto page = cli.parallax({"report", "--history", "h.jsonl", "-o", "h.html"});
  CHECK(page.code == 0);
  CHECK_MESSAGE(holds(page.err, "line 2 could not be read"), page.err);
  CHECK(holds(page.err, "the last line is half written"));
  CHECK(holds(cli.read("h.html"), "half written"));
  const auto more = cli.suite(kWith);
  CHECK(more.code == 0);
  CHECK_MESSAGE(holds(more.err, "lines 2, 3 could not be read"), more.err);
  CHECK(lines_of(cli.read("h.jsonl")).size() == 4);
  CHECK(cli.read("h.jsonl").starts_with(whole));
}

TEST_CASE("what is no history is refused before the suite begins") {
  const SuiteFixture cli;
  for (const std::string text : {"my notes\n", "[1]", "{\"a\":1}\n"}) {
    cli.write("notes", text);
    const auto result = cli.suite({"--history", "notes"});
    CHECK(result.code == 2);
    CHECK(!holds(result.err, "FAIL"));
    CHECK(cli.read("notes") == text);
    CHECK(cli.parallax({"report", "--history", "notes"}).code == 2);
  }
  CHECK(cli.suite({"--history", "s/suite.yaml"}).code == 2);
  CHECK(cli.suite({"--history", "h", "--shard", "1/2"}).code == 2);
  CHECK(cli.suite({"--revision", "x"}).code == 2);
  CHECK(cli.parallax({"report", "--history", "nowhere"}).code == 2);
  CHECK(cli.parallax({"report"}).code == 2);
  cli.write("h", "");
  CHECK(cli.parallax({"report", "--history", "h", "-o", "h.html"}).code == 0);
  CHECK(cli.parallax({"report", "--history", "h", "out"}).code == 2);
  fs::create_symlink("h", cli.folder() / "link");
  CHECK(cli.suite({"--update-goldens", "--history", "link"}).code == 2);
  CHECK(cli.read("h").empty());
  cli.write("h.html", "mine");
  CHECK(cli.parallax({"report", "--history", "h", "-o", "h.html"}).code == 2);
  CHECK(cli.read("h.html") == "mine");
}

TEST_CASE("shards are one line when they are merged") {
  const SuiteFixture cli;
  REQUIRE(cli.suite({"--update-goldens"}).code == 0);
  for (const std::string shard : {"1", "2"}) {
    REQUIRE(cli.suite({"--shard", shard + "/2", "--out", "o" + shard}).code == 0);
  }
  const auto merged = cli.parallax(
      {"suite", "--merge", "o1", "o2", "--out", "all", "--history", "h.jsonl", "--revision", "m"});
  CHECK_MESSAGE(merged.code == 0, merged.err);
  const auto lines = lines_of(cli.read("h.jsonl"));
  REQUIRE(lines.size() == 1);
  CHECK(lines[0]["cases"].size() == 2);
  // One is missing: that is no whole suite.
  CHECK(cli.parallax({"suite", "--merge", "o1", "--out", "part", "--history", "h.jsonl"}).code ==
        4);
  CHECK(lines_of(cli.read("h.jsonl")).size() == 1);
}

TEST_CASE("hostile names are text on the page and on the terminal") {
  const CliFixture cli;
  const std::string evil = "</td><script>alert(1)</script>\\u001b[2J\\u202e";
  const auto line = [&](const std::string& outcome) {
    return "{\"history\":1,\"revision\":\"" + evil + "\",\"paths\":[\"" + evil +
           "\"],\"cases\":{\"" + evil + "\":{\"outcome\":\"" + outcome + "\",\"verdict\":\"" +
           evil + "\",\"rates\":[{\"of\":\"" + evil + "\",\"count\":1,\"runs\":9}]}}}\n";
  };
  cli.write("h.jsonl", line("passed") + line(evil) + line("failed"));
  const auto page = cli.parallax({"report", "--history", "h.jsonl", "-o", "h.html"});
  CHECK(page.code == 0);
  CHECK(page.out.find('\x1b') == std::string::npos);
  const auto html = cli.read("h.html");
  CHECK(html.find("<script>alert") == std::string::npos);
  CHECK(html.find('\x1b') == std::string::npos);
}

}  // namespace
}  // namespace parallax::test
