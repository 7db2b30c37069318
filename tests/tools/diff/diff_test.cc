#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kYale =
    "range time 0 2\n"
    "fluent Alive()\n"
    "fluent Loaded()\n"
    "event Load()\n"
    "event Shoot()\n"
    "[time] Initiates(Load(),Loaded(),time).\n"
    "[time] HoldsAt(Loaded(),time) -> Terminates(Shoot(),Alive(),time).\n"
    "HoldsAt(Alive(),0).\n"
    "!HoldsAt(Loaded(),0).\n";

std::string changed(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE_MESSAGE(at != std::string::npos, from);
  return text.replace(at, from.size(), to);
}

struct DiffFixture : CliFixture {
  /// The document of `parallax diff old.e new.e --json` for two texts.
  Json diff(const std::string& before, const std::string& after,
            std::vector<std::string> more = {}) {
    write("old.e", before);
    write("new.e", after);
    more.insert(more.begin(), {"diff", "old.e", "new.e", "--json"});
    const auto result = parallax(more);
    code = result.code;
    err = result.err;
    return Json::parse(result.out);
  }
  int code = -1;
  std::string err;
};

}  // namespace

TEST_CASE_FIXTURE(DiffFixture, "a rewritten model is no difference") {
  const auto document = diff(kYale,
                             "; rewritten\nevent Shoot()\nevent Load()\n"
                             "fluent Loaded()\nfluent Alive()\nrange time 0 2\n"
                             "!(HoldsAt(Loaded(),0)).\nHoldsAt(Alive(),0).\n"
                             "[time7] (HoldsAt(Loaded(),time7)) ->\n"
                             "  Terminates(Shoot(),Alive(),time7).\n"
                             "[time3] Initiates(Load(),Loaded(),time3).\n");
  CHECK(code == 0);
  CHECK(document["equal"] == true);
  CHECK(document["traces"]["lost"]["answer"] == "none");
  CHECK(document["traces"]["gained"]["answer"] == "none");
  const auto text = parallax({"diff", "old.e", "new.e"});
  CHECK(text.code == 0);
  CHECK(text.out.ends_with("no difference\n"));
}

TEST_CASE_FIXTURE(DiffFixture,
                  "an edited axiom: both places, a shortest witness, what it rests on") {
  const auto document =
      diff(kYale, changed(kYale, "HoldsAt(Loaded(),time) -> Terminates", "Terminates"));
  CHECK(code == 1);
  CHECK(document["equal"] == false);
  CHECK(document["declarations"]["changed"].empty());
  REQUIRE(document["axioms"]["changed"].size() == 1);
  CHECK(document["axioms"]["changed"][0]["old"]["line"] == 7);
  CHECK(document["axioms"]["changed"][0]["new"]["file"] == "new.e");
  const auto& witness = document["traces"]["lost"]["witness"];
  CHECK(witness["excluded_by"] == 1);
  CHECK(witness["events"] == 1);
  CHECK(witness["shortest"] == true);
  CHECK(witness["timepoints"].size() == 3);
  CHECK(witness["timepoints"][0]["happens"] == Json({"Shoot()"}));
  REQUIRE(witness["contradicts"].size() == 1);
  CHECK(witness["contradicts"][0]["line"] == 7);
  CHECK(witness["contradicts"][0]["edited"] == true);
  REQUIRE(witness["edits"].size() == 1);
  CHECK(witness["edits"][0]["old"]["line"] == 7);
  const auto text = parallax({"diff", "old.e", "new.e"}).out;
  CHECK(text.find("~ old.e:7  [time] HoldsAt(Loaded(),time) -> ") != std::string::npos);
  CHECK(text.find("it depends on the edit") != std::string::npos);
}

TEST_CASE_FIXTURE(DiffFixture, "of several edits those are named on which a witness depends") {
  auto after = changed(kYale, "[time] Initiates(Load(),Loaded(),time).\n", "");
  after = changed(after, "!HoldsAt(Loaded(),0).", "!HoldsAt(Loaded(),0) & HoldsAt(Alive(),0).");
  after += "[time] Happens(Shoot(),time) -> HoldsAt(Alive(),time) | !HoldsAt(Loaded(),time).\n";
  const auto document = diff(kYale, after);
  CHECK(document["axioms"]["removed"].size() == 1);
  const auto& edits = document["traces"]["lost"]["witness"]["edits"];
  REQUIRE(edits.size() == 1);
  CHECK(edits[0]["new"].is_null());
  CHECK(edits[0]["old"]["line"] == 6);
  // Inertia alone contradicts the witness: nothing that stands in the new text was edited.
  for (const auto& axiom : document["traces"]["lost"]["witness"]["contradicts"]) {
    CHECK(axiom["edited"] == false);
  }
}

TEST_CASE_FIXTURE(DiffFixture, "an edit that only a needless one needs is not named") {
  // The old text declares a fluent and speaks of it; the new one does neither, and forbids to
  // shoot.
  const auto before = std::string(kYale) +
                      "fluent Tired()\nHoldsAt(Tired(),0) | !HoldsAt(Tired(),0).\n"
                      "[time] Initiates(Shoot(),Tired(),time).\n";
  const auto after = std::string(kYale) + "!Happens(Shoot(),0).\n";
  const auto document = diff(before, after);
  const auto& edits = document["traces"]["lost"]["witness"]["edits"];
  REQUIRE(edits.size() == 1);
  CHECK(edits[0]["old"].is_null());
  CHECK(edits[0]["new"]["text"] == "!Happens(Shoot(),0).");
}

TEST_CASE_FIXTURE(DiffFixture, "numbers are those of the full lists") {
  const auto document =
      diff(kYale, changed(kYale, "HoldsAt(Loaded(),time) -> Terminates", "Terminates"),
           {"--count-limit", "5"});
  const auto count = [&](const char* name) {
    return std::stoi(parallax({"traces", name, "--count"}).out);
  };
  CHECK(document["traces"]["old"]["value"] == count("old.e"));
  CHECK(document["traces"]["new"]["value"] == count("new.e"));
  write("old.jsonl", parallax({"traces", "old.e", "--limit", "0", "--format", "jsonl"}).out);
  write("new.jsonl", parallax({"traces", "new.e", "--limit", "0", "--format", "jsonl"}).out);
  const auto lists = json_of(*this, {"diff", "old.jsonl", "new.jsonl"}, 1);
  for (const auto* side : {"lost", "gained"}) {
    CHECK(document["traces"][side]["count"]["exact"] == true);
    CHECK(document["traces"][side]["count"]["value"] == lists["traces"][side]["count"]);
  }
}

TEST_CASE_FIXTURE(DiffFixture, "different vocabularies and horizons are said") {
  const auto after = changed(changed(kYale, "event Load()", "event Load()\nevent Wait()"),
                             "range time 0 2", "range time 0 3");
  const auto document = diff(kYale, after);
  CHECK(code == 1);
  CHECK(document["traces"]["only_new"] == Json({"Wait()"}));
  CHECK(document["traces"]["horizon"] == 2);
  CHECK(document["traces"]["lost"]["answer"] == "none");
  CHECK(document["traces"]["gained"]["answer"] == "none");
  REQUIRE(document["remarks"].size() == 1);
  const auto text = parallax({"diff", "old.e", "new.e"}).out;
  CHECK(text.find("not compared, as only new.e has them: Wait()") != std::string::npos);
}

TEST_CASE_FIXTURE(DiffFixture, "compiled models are compared with each other and with texts") {
  write("old.e", kYale);
  write("new.e", changed(kYale, "!HoldsAt(Loaded(),0).\n", ""));
  CHECK(parallax({"compile", "old.e", "-o", "old.dec.cnf"}).code == 0);
  CHECK(parallax({"compile", "new.e", "-o", "new.dec.cnf"}).code == 0);
  const auto both = parallax({"diff", "old.dec.cnf", "new.dec.cnf"});
  CHECK(both.code == 1);
  CHECK(both.out.find("- old.e:9  axiom: !HoldsAt(Loaded(),0)") != std::string::npos);
  CHECK(both.out.find("gained: ") != std::string::npos);
  CHECK(parallax({"diff", "old.e", "old.dec.cnf"}).code == 0);
  CHECK(parallax({"diff", "old.e", "new.dec.cnf"}).code == 1);
  CHECK(parallax({"diff", "old.e", "old.dec.cnf", "--horizon", "7"}).code == 3);
  CHECK(parallax({"diff", "old.e", "old.dec.cnf", "--horizon", "1", "--traces-only"}).code == 0);
}

TEST_CASE_FIXTURE(DiffFixture, "--traces-only looks at the meaning, --no-traces at the text") {
  write("old.e", kYale);
  write("new.e", changed(kYale, "!HoldsAt(Loaded(),0).", "!(!(!HoldsAt(Loaded(),0)))."));
  CHECK(parallax({"diff", "old.e", "new.e"}).code == 1);
  CHECK(parallax({"diff", "old.e", "new.e", "--traces-only"}).code == 0);
  CHECK(parallax({"diff", "old.e", "new.e", "--no-traces"}).code == 1);
  CHECK(parallax({"diff", "old.e", "new.e", "--no-traces", "--traces-only"}).code == 2);
}

TEST_CASE_FIXTURE(DiffFixture, "loaded files and --with belong to the model") {
  write("common.e", "fluent Alive()\nevent Shoot()\nrange time 0 1\n");
  write("old.e", "load common.e\n[time] Terminates(Shoot(),Alive(),time).\n");
  write("new.e", "fluent Alive()\nload rest.e\n[t] 0=0.\n");
  write("new.e",
        "event Shoot()\nfluent Alive()\nrange time 0 1\n"
        "[time1] Terminates(Shoot(),Alive(),time1).\n");
  CHECK(parallax({"diff", "old.e", "new.e"}).code == 0);
  write("start.e", "HoldsAt(Alive(),0).\n");
  const auto result = parallax({"diff", "old.e", "new.e", "--with", "start.e", "--json"});
  CHECK(result.code == 0);
  // One value each time, wherever it stands.
  CHECK(parallax({"diff", "--with", "start.e", "-I", ".", "old.e", "new.e"}).code == 0);
  write("more.e", "!Happens(Shoot(),0).\n");
  CHECK(parallax({"diff", "--with", "start.e", "--with", "more.e", "old.e", "new.e"}).code == 0);
}

TEST_CASE_FIXTURE(DiffFixture, "plans are compared as data, to the smallest piece") {
  write("other.lisp", read("fetch.lisp"));
  CHECK(parallax({"diff", "fetch.lisp", "other.lisp"}).code == 0);
  replace("other.lisp", "(perform (a motion (type going) (pose ?here)))",
          "(perform (a  motion ; back\n (type GOING) (pose ?there)))");
  const auto result = parallax({"diff", "fetch.lisp", "other.lisp"});
  CHECK(result.code == 1);
  CHECK(result.out.find("?here") != std::string::npos);
  CHECK(result.out.find("  - fetch.lisp:13  ?here\n  + other.lisp:14  ?there\n") !=
        std::string::npos);
  CHECK(result.out.find("  ~ fetch.lisp:") != std::string::npos);
  // Long forms: the part that changed is shown, not their common beginning.
  std::string body;
  for (int i = 0; i < 30; ++i) body += "  (perform (a motion (type going) (pose ?here)))\n";
  write("long.lisp", "(def-cram-function long (?here)\n" + body + "  (leave early))\n");
  write("longer.lisp", "(def-cram-function long (?here)\n" + body + "  (leave late))\n");
  const auto last = parallax({"diff", "long.lisp", "longer.lisp"}).out;
  CHECK(last.find("?here))) (leave early))\n") != std::string::npos);
  CHECK(last.find("?here))) (leave late))\n") != std::string::npos);
  CHECK(last.find("  - long.lisp:32  early\n  + longer.lisp:32  late\n") != std::string::npos);
  // A form that is put around another is the edit, not the form inside.
  const std::string retry = "(with-failure-handling ((plan-failure (e) (retry)))\n";
  write("wrapped.lisp", "(def-cram-function long (?here)\n" + retry + body + ") (leave early))\n");
  const auto wrapped = parallax({"diff", "long.lisp", "wrapped.lisp"}).out;
  CHECK(wrapped.find("  + wrapped.lisp:2  (with-failure-handling ((plan-failure (e) (retry))) ...)"
                     "  around  (perform ") != std::string::npos);
  CHECK(wrapped.find("\n  - ") == std::string::npos);
  const auto unwrapped = json_of(*this, {"diff", "wrapped.lisp", "long.lisp"}, 1);
  REQUIRE(unwrapped["edits"].size() == 1);
  CHECK(unwrapped["edits"][0]["new"].is_null());
  CHECK(unwrapped["edits"][0]["old"]["line"] == 2);
  // A form more moves no other; two that changed places are another order.
  const auto plan = read("fetch.lisp");
  write("more.lisp", "(defparameter *extra* 1)\n" + plan);
  const auto more = parallax({"diff", "fetch.lisp", "more.lisp"});
  CHECK(more.out.starts_with("forms: 1 added\n"));
  write("moved.lisp", plan + "(defparameter *extra* 1)\n");
  CHECK(parallax({"diff", "more.lisp", "moved.lisp"}).out.starts_with("order: 1 changed\n"));
  CHECK(parallax({"diff", "robot.bind", "robot.bind"}).code == 0);
  write("other.bind", read("robot.bind") + "; a remark\n");
  CHECK(parallax({"diff", "robot.bind", "other.bind"}).code == 0);
  replace("other.bind", "else manipulation-goal-not-reached", "else manipulation-pose-unreachable");
  CHECK(parallax({"diff", "robot.bind", "other.bind"}).code == 1);
}

TEST_CASE_FIXTURE(DiffFixture, "runs are compared by what they report") {
  const auto report = [](const char* verdict, const char* seed) {
    return std::string("{\"status\":\"ok\",\"scenario\":\"s.yaml\",\"seed\":") + seed +
           ",\"verdict\":\"" + verdict +
           "\",\"simulations\":5,\"traces\":[{\"trace\":1,\"verdict\":\"" + verdict +
           "\",\"events\":[\"Go(r2)\"],\"initial_state\":[\"In(r1)\"],\"simulations\":5,"
           "\"clean\":5,\"certified\":{\"confidence\":0.99,\"epsilon\":0.5}}],"
           "\"discrepancies\":[],\"exploration\":\"all traces explored\"}";
  };
  std::filesystem::create_directory(folder() / "a");
  std::filesystem::create_directory(folder() / "b");
  write("a/report.json", report("no-discrepancy", "1"));
  write("b/report.json", report("no-discrepancy", "1"));
  CHECK(parallax({"diff", "a", "b"}).code == 0);
  // The same results of other texts are no equal runs.
  const auto journal = [](const char* hash) {
    return std::string("{\"journal\":1,\"scenario\":\"s.yaml\",\"scenario_hash\":\"") + hash +
           "\",\"seed\":1,\"tool_version\":\"1\",\"simulator\":{\"name\":\"s\",\"version\":\"1\","
           "\"determinism\":\"none\",\"seeds\":true,\"timestep_s\":0.1},\"options\":{}}\n";
  };
  write("a/journal.ndjson", journal("00aa"));
  write("b/journal.ndjson", journal("00bb"));
  const auto texts = parallax({"diff", "a", "b"});
  CHECK(texts.code == 1);
  CHECK(texts.out.find("hash of scenario, models and plan: 00bb") != std::string::npos);
  write("b/journal.ndjson", journal("00aa"));
  CHECK(parallax({"diff", "a", "b"}).code == 0);
  write("b/report.json", report("discrepancy", "2"));
  const auto result = parallax({"diff", "a", "b/report.json"});
  CHECK(result.code == 1);
  CHECK(result.out.find("settings: 1 changed") != std::string::npos);
  CHECK(result.out.find("results: 2 changed") != std::string::npos);
  CHECK(result.out.find("trace [Go(r2)] from [In(r1)]: discrepancy") != std::string::npos);
  write("b/report.json", "{}");
  CHECK(parallax({"diff", "a", "b"}).code == 2);
  std::filesystem::create_directory(folder() / "c");
  CHECK(parallax({"diff", "a", "c"}).code == 2);
}

TEST_CASE_FIXTURE(DiffFixture, "trace files are sets") {
  const std::string one =
      R"x({"trace":1,"timepoints":[{"time":0,"happens":["E()"],"holds":[],"released":[]},)x"
      R"x({"time":1,"happens":[],"holds":["F()"],"released":[]}],"predicates":[]})x";
  const std::string two =
      R"x({"trace":2,"timepoints":[{"time":0,"happens":[],"holds":[],"released":[]},)x"
      R"x({"time":1,"happens":[],"holds":[],"released":[]}],"predicates":[]})x";
  const std::string end =
      R"x({"summary":true,"traces":2,"complete":true,"timing":{"wall_s":1.0}})x";
  write("a.jsonl", one + "\n" + two + "\n" + end + "\n");
  write("b.jsonl", two + "\n" + one + "\n" + end + "\n");
  CHECK(parallax({"diff", "a.jsonl", "b.jsonl"}).code == 0);
  write("b.jsonl", two + "\n");
  const auto result = parallax({"diff", "a.jsonl", "b.jsonl"});
  CHECK(result.code == 1);
  CHECK(result.out.find("b.jsonl: 1 trace, not known to be all\nlost: 1\n") != std::string::npos);
  CHECK(result.out.find("leaves all of b.jsonl at timepoint 1") != std::string::npos);
}

void check_tells_nothing_else(const Json& witness) {
  CHECK_FALSE(witness.contains("predicates"));
  CHECK_FALSE(witness.contains("undetermined"));
  REQUIRE(witness["timepoints"].size() > 1);
  for (const auto& point : witness["timepoints"]) {
    CHECK(point.contains("holds"));
    CHECK_FALSE(point.contains("released"));
  }
}

TEST_CASE_FIXTURE(DiffFixture, "a witness claims nothing of undetermined atoms") {
  const std::string model =
      "range time 0 1\nsort s\ns A,B\nfluent On(s)\nevent Go(s)\npredicate P(s)\n"
      "P(A) | P(B).\n[s,time] Releases(Go(s),On(s),time).\n";
  const auto document = diff(model + "Happens(Go(A),0).\n", model + "!Happens(Go(A),0).\n");
  CHECK(code == 1);
  for (const auto* side : {"lost", "gained"}) {
    CAPTURE(std::string(side));
    const auto& witness = document["traces"][side]["witness"];
    REQUIRE(witness.is_object());
    check_tells_nothing_else(witness);
    CHECK(witness["timepoints"][0].contains("happens"));
    write("witness.jsonl", witness.dump() + "\n");
    const auto* name = side == std::string("lost") ? "old.e" : "new.e";
    CHECK(parallax({"traces", name, "--replay", "witness.jsonl"}).code == 0);
  }
}

TEST_CASE_FIXTURE(DiffFixture, "a witness of trace files agrees with the model of its file") {
  const std::string model = "range time 0 1\nfluent F()\nevent E()\npredicate P()\nP().\n";
  write("old.e", model);
  write("new.e", model + "!Happens(E(),0).\n");
  for (const std::string format : {"jsonl", "itf"}) {
    CAPTURE(format);
    for (const std::string name : {"old", "new"}) {
      const auto listed = parallax({"traces", name + ".e", "--limit", "0", "--format", format});
      REQUIRE(listed.code == 0);
      write(name + ".jsonl", listed.out);
    }
    const auto result = parallax({"diff", "old.jsonl", "new.jsonl", "--json"});
    CHECK(result.code == 1);
    const auto witness = Json::parse(result.out)["traces"]["lost"]["witness"];
    check_tells_nothing_else(witness);
    CHECK(witness["timepoints"][0]["happens"] == Json({"E()"}));
    // ITF has no place for events at the last timepoint.
    CHECK(witness["timepoints"][1].contains("happens") == (format == "jsonl"));
    write("witness.jsonl", witness.dump() + "\n");
    CHECK(parallax({"traces", "old.e", "--replay", "witness.jsonl"}).code == 0);
  }
}

TEST_CASE_FIXTURE(DiffFixture, "trace files are read as strictly as traces --replay reads them") {
  write("m.e", "range time 0 1\nfluent F()\nevent E()\n");
  const std::string good =
      R"x({"trace":1,"timepoints":[{"time":0,"happens":[],"holds":["F()"],"released":[]},)x"
      R"x({"time":1,"happens":[],"holds":["F()"],"released":[]}],"predicates":[]})x";
  write("a.jsonl", good + "\n");
  REQUIRE(parallax({"diff", "a.jsonl", "a.jsonl"}).code == 0);
  REQUIRE(parallax({"traces", "m.e", "--replay", "a.jsonl"}).code == 0);
  const auto spoilt = [&](const std::string& from, const std::string& to) {
    auto text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::vector<std::string> bad = {
      "{",
      "[]",
      "{\"timepoints\":[]}",
      "{\"timepoints\":[{\"time\":0,\"holds\":3}]}",
      "{\"timepoints\":[{\"holds\":[]}]}",                  // without its time
      spoilt("\"time\":1", "\"time\":2"),                   // a gap
      spoilt("\"trace\":1", "\"trace\":-1"),                // a negative number
      spoilt("\"holds\":[\"F()\"]", "\"holds\":[1]"),       // no text
      spoilt("\"trace\":1", "\"trace\":1,\"trace\":1"),     // a name twice
      "{\"summary\":true,\"traces\":7,\"complete\":true}",  // another number of traces
  };
  for (const auto& line : bad) {
    CAPTURE(line);
    write("b.jsonl", good + "\n" + line + "\n");
    const auto refused = parallax({"diff", "a.jsonl", "b.jsonl"});
    const auto replayed = parallax({"traces", "m.e", "--replay", "b.jsonl"});
    CHECK(refused.code == 3);
    CHECK(replayed.code == 3);
    const auto first = refused.err.substr(0, refused.err.find('\n'));
    CHECK(first.find("b.jsonl:2:") == 0);
    CHECK(first == replayed.err.substr(0, replayed.err.find('\n')));
  }
  // An event at the last timepoint: only a model says whether it knows of one.
  write("b.jsonl", spoilt("\"time\":1,\"happens\":[]", "\"time\":1,\"happens\":[\"E()\"]") + "\n");
  CHECK(parallax({"diff", "a.jsonl", "b.jsonl"}).code == 0);
  CHECK(parallax({"traces", "m.e", "--replay", "b.jsonl"}).code == 3);
  write("b.jsonl", "");
  CHECK(parallax({"diff", "a.jsonl", "b.jsonl"}).code == 3);
}

TEST_CASE_FIXTURE(DiffFixture, "what cannot be compared is refused with what can") {
  write("old.e", kYale);
  CHECK(parallax({"diff", "old.e", "fetch.lisp"}).code == 2);
  CHECK(parallax({"diff", "old.e", "missing.e"}).code == 2);
  CHECK(parallax({"diff", "old.e"}).code == 2);
  CHECK(parallax({"diff", "--textconv", "scenario.yaml"}).code == 2);
  CHECK(parallax({"diff", "old.e", "old.e", "--textconv", "old.e"}).code == 2);
  write("bad.e", "fluent F(\n");
  CHECK(json_of(*this, {"diff", "old.e", "bad.e"}, 3)["status"] == "error");
}

TEST_CASE_FIXTURE(DiffFixture, "a scenario is compared with its plan and constraints") {
  CHECK(parallax({"diff", "scenario.yaml", "scenario.yaml"}).code == 0);
  CHECK(json_of(*this, {"diff", "scenario.yaml", "edge.yaml"}, 1)["equal"] == false);
}

TEST_CASE_FIXTURE(DiffFixture, "git shows what models say") {
  const auto git = [&](std::vector<std::string> arguments) {
    const std::vector<std::string> identity = {"git", "-c", "user.name=t", "-c",
                                               "user.email=t@example.org"};
    arguments.insert(arguments.begin(), identity.begin(), identity.end());
    ProcessOptions options;
    options.folder = (folder() / "repository").string();
    return run_process(arguments, options);
  };
  std::filesystem::create_directory(folder() / "repository");
  REQUIRE(git({"init", "-q"}).code == 0);
  const std::string program = std::string(PARALLAX_BINARY_DIR) + "/parallax";
  REQUIRE(git({"config", "diff.dec.textconv", program + " diff --fallback --textconv"}).code == 0);
  write("repository/.gitattributes", "*.e diff=dec\n");
  write("repository/m.e", kYale);
  REQUIRE(git({"add", "."}).code == 0);
  REQUIRE(git({"commit", "-qm", "one"}).code == 0);
  SUBCASE("a renamed variable and another order are nothing") {
    write("repository/m.e",
          changed(changed(kYale, "[time] Initiates(Load(),Loaded(),time).",
                          "[time3] Initiates(Load(),Loaded(),time3)."),
                  "fluent Alive()\nfluent Loaded()\n", "fluent Loaded()\nfluent Alive()\n"));
    CHECK(git({"diff", "--no-textconv", "--stat"}).out.find("m.e") != std::string::npos);
    CHECK(git({"diff"}).out.find("@@") == std::string::npos);
  }
  SUBCASE("an edit is one line") {
    write("repository/m.e", changed(kYale, "HoldsAt(Alive(),0).", "!HoldsAt(Alive(),0)."));
    const auto out = git({"diff", "-U0"}).out;
    CHECK(out.find("-HoldsAt(Alive(),0).\n") != std::string::npos);
    CHECK(out.find("+!HoldsAt(Alive(),0).\n") != std::string::npos);
  }
  SUBCASE("a revision with an error is shown as it is") {
    write("repository/m.e", std::string(kYale) + "HoldsAt(.\n");
    const auto result = git({"diff"});
    CHECK(result.code == 0);
    CHECK(result.out.find("+HoldsAt(.\n") != std::string::npos);
  }
}

TEST_CASE_FIXTURE(DiffFixture, "a canonical text is a model with the same traces") {
  write("old.e", kYale);
  write("new.e", parallax({"diff", "--textconv", "old.e"}).out);
  const auto result = parallax({"diff", "old.e", "new.e"});
  CHECK(result.code == 0);
  CHECK(result.out.ends_with("no difference\n"));
}

TEST_CASE_FIXTURE(DiffFixture, "a difference is written as Markdown, over nothing but its like") {
  write("old.e", kYale);
  write("new.e", changed(kYale, "HoldsAt(Alive(),0).", "!HoldsAt(Alive(),0)."));
  const auto plain = parallax({"diff", "old.e", "new.e", "--no-traces"});
  const auto both = parallax({"diff", "old.e", "new.e", "--no-traces", "--markdown", "out.md"});
  CHECK(both.code == 1);
  CHECK(both.out == plain.out);
  const auto text = read("out.md");
  CHECK(text.starts_with("<!-- parallax diff -->\n## old.e and new.e\n\naxioms: "));
  CHECK_MESSAGE(text.find("\n```diff\n") != std::string::npos, text);
  CHECK(text.find("!HoldsAt(Alive(),0).") != std::string::npos);
  CHECK(text.ends_with("```\n"));
  // Again over its own file; never over another one.
  CHECK(parallax({"diff", "old.e", "old.e", "--markdown", "out.md"}).code == 0);
  CHECK(read("out.md").find("no difference") != std::string::npos);
  write("notes.md", "mine\n");
  const auto refused = parallax({"diff", "old.e", "new.e", "--markdown", "notes.md"});
  CHECK(refused.code == 2);
  CHECK(read("notes.md") == "mine\n");
  CHECK(parallax({"diff", "old.e", "new.e", "--json", "--markdown", "out.md"}).code == 2);
}

}  // namespace parallax::test
