// `parallax traces --replay`: right traces, edited ones, and files that hold no traces.

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kLamp =
    "range time 0 2\nfluent On()\nfluent Broken()\nevent Press()\n"
    "[time] !HoldsAt(Broken(),time) -> Initiates(Press(),On(),time).\n"
    "!HoldsAt(On(),0).\n";

/// Occurrences of `part`.
std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

struct Lamp {
  CliFixture cli;
  Lamp() {
    cli.write("m.e", kLamp);
    cli.write("t.jsonl", cli.parallax({"traces", "m.e", "--format", "jsonl", "--limit", "0"}).out);
    cli.write("t.itf", cli.parallax({"traces", "m.e", "--format", "itf", "--limit", "0"}).out);
    cli.write("one.itf.json",
              cli.parallax({"traces", "m.e", "--format", "itf", "--limit", "1"}).out);
  }
  ProcessResult replay(const std::string& file, std::vector<std::string> more = {}) const {
    std::vector<std::string> command = {"traces", "m.e", "--replay", file};
    command.insert(command.end(), more.begin(), more.end());
    return cli.parallax(command);
  }
};

TEST_CASE("what the program writes agrees with the model it was made from") {
  const Lamp lamp;
  for (const auto* file : {"t.jsonl", "t.itf"}) {
    const auto result = lamp.replay(file);
    CHECK(result.code == 0);
    CHECK(result.err == "");
    CHECK(result.out.ends_with("8 traces replayed, complete: 8 agree, 0 fail, 8 checked\n"));
  }
  const auto one = lamp.replay("one.itf.json");
  CHECK(one.code == 0);
  CHECK(one.out.starts_with("trace 1: agrees\n1 trace replayed, complete"));
}

TEST_CASE(
    "a list with an event at the last timepoint is replayed with the options it was made with") {
  const CliFixture cli;
  cli.write("m.e",
            "range time 0 1\nfluent F()\nevent E()\nevent D()\nHoldsAt(F(),0) | Happens(E(),1).\n");
  const std::vector<std::string> traces = {"traces", "m.e", "--compat", "decreasoner"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), traces.begin(), traces.end());
    return cli.parallax(more);
  };
  for (const auto* format : {"jsonl", "itf"}) {
    const auto list = with({"--limit", "0", "--format", format}).out;
    cli.write("list", list);
    const auto replayed = with({"--replay", "list"});
    CHECK(replayed.err == "");
    CHECK(replayed.code == 0);
    CHECK(replayed.out.find("3 traces replayed, complete: 3 agree, 0 fail") != std::string::npos);
  }
  cli.write("list.jsonl", with({"--limit", "0", "--format", "jsonl"}).out);
  CHECK(cli.read("list.jsonl").find(R"~({"time":1,"happens":["E()"])~") != std::string::npos);
  CHECK(cli.parallax({"diff", "list.jsonl", "list.jsonl"}).code == 0);
  // The standard meaning has no such event, nor has the old one another than the formula's.
  const auto trace = [](const char* first, const char* last) {
    return R"~({"timepoints":[{"time":0,"happens":[],"holds":[)~" + std::string(first) +
           R"~(],"released":[]},{"time":1,"happens":[)~" + last + R"~(],"holds":[)~" + first +
           "],\"released\":[]}]}\n";
  };
  cli.write("one.jsonl", trace("\"F()\"", "\"E()\""));
  CHECK(with({"--replay", "one.jsonl"}).code == 0);
  CHECK(cli.parallax({"traces", "m.e", "--replay", "one.jsonl"}).code == 3);
  cli.write("other.jsonl", trace("\"F()\"", "\"D()\""));
  CHECK(with({"--replay", "other.jsonl"}).err.find("E6102") != std::string::npos);
  cli.write("none.jsonl", trace("", ""));
  CHECK(with({"--replay", "none.jsonl"}).code == 1);
}

TEST_CASE("a list that was cut off behind a trace is replayed, with a remark") {
  const Lamp lamp;
  const auto whole = lamp.cli.read("t.jsonl");
  lamp.cli.write("cut.jsonl", whole.substr(0, whole.find('\n', whole.find('\n') + 1) + 1));
  const auto result = lamp.replay("cut.jsonl");
  CHECK(result.code == 0);
  CHECK(result.out.find("2 traces replayed") != std::string::npos);
  CHECK(result.err.find("the file does not say how its list ended") != std::string::npos);
}

TEST_CASE("a compiled model replays as well, without the second check") {
  const Lamp lamp;
  CHECK(lamp.cli.parallax({"compile", "m.e", "-o", "m.dec.cnf"}).code == 0);
  const auto result = lamp.cli.parallax({"traces", "m.dec.cnf", "--replay", "t.itf"});
  CHECK(result.code == 0);
  CHECK(result.out.ends_with("8 agree, 0 fail, 0 checked\n"));
}

TEST_CASE("a fact that was edited is found at its axiom, with the atoms that decide") {
  const Lamp lamp;
  lamp.cli.write("bad.jsonl",
                 R"~({"trace":7,"timepoints":[{"time":0,"happens":["Press()"],"holds":[],)~"
                 R"~("released":[]},{"time":1,"happens":[],"holds":["On()"],"released":[]},)~"
                 R"~({"time":2,"happens":[],"holds":[],"released":[]}],"predicates":[]})~"
                 "\n");
  const auto result = lamp.replay("bad.jsonl");
  CHECK(result.code == 1);
  CHECK(result.out.starts_with("trace 7: fails at timepoint 1, m.e:2\n"));
  CHECK(result.err.find("m.e:2:8-11: error[E7204]: trace 7 fails at timepoint 1: DEC5 for On(): it "
                        "changes without an event at 1") != std::string::npos);
  const auto document = Json::parse(lamp.replay("bad.jsonl", {"--json"}).out);
  CHECK(document["fail"] == 1);
  CHECK(document["list"][0]["line"] == 2);
  CHECK(document["list"][0]["timepoint"] == 1);
  CHECK(document["diagnostics"].size() == 1);
}

TEST_CASE("a fact that is left open is found if there is a value for it, and counted") {
  const Lamp lamp;
  // Pressed, and dark: possible only if the lamp is broken, of which the file says nothing.
  const std::string head = R"~({"vars":["On","mbt::actionTaken"],"states":[)~"
                           R"~({"On":false,"mbt::actionTaken":"init"},)~"
                           R"~({"On":false,"mbt::actionTaken":"Press()"},)~";
  lamp.cli.write("dark.json", head + R"~({"On":false,"mbt::actionTaken":""}]})~");
  const auto dark = lamp.replay("dark.json");
  CHECK(dark.code == 0);
  CHECK(
      dark.out.starts_with("trace 1: agrees, with values for 3 atoms that it does not mention\n"));
  CHECK(dark.err == "");
  lamp.cli.write("odd.json", head + R"~({"On":true,"mbt::actionTaken":"Press()"}]})~");
  const auto odd = lamp.replay("odd.json");
  CHECK(odd.code == 1);
  CHECK(odd.err.find("E7204") != std::string::npos);
  CHECK(odd.err.find("whatever it does not mention") != std::string::npos);
  CHECK(odd.err.find("note") != std::string::npos);  // no single axiom is to blame
}

TEST_CASE("what is said to be undetermined is an atom of the model, and is not said to be true") {
  const CliFixture cli;
  cli.write("m.e",
            "range time 0 1\nfluent F()\nevent E()\npredicate P()\npredicate Q()\n"
            "[time] Releases(E(),F(),time).\nP() | Q().\n");
  const auto replayed = [&](const std::string& predicates, const std::string& undetermined) {
    const std::string point = R"~("happens":[],"holds":[],"released":[]})~";
    cli.write("one.jsonl", R"~({"timepoints":[{"time":0,)~" + point + R"~(,{"time":1,)~" + point +
                               R"~(],"predicates":[)~" + predicates + R"~(],"undetermined":)~" +
                               undetermined + "}\n");
    return cli.parallax({"traces", "m.e", "--replay", "one.jsonl"});
  };
  CHECK(replayed("", "[]").code == 1);  // neither P nor Q
  CHECK(replayed("", R"~(["P()"])~").code == 0);
  CHECK(replayed("\"P()\"", R"~(["Q()","ReleasedAt(F(),0)"])~").code == 0);
  const auto refused = [&](const std::string& undetermined, const std::string& code) {
    const auto result = replayed("\"P()\"", undetermined);
    CHECK(result.code == 3);
    CHECK_MESSAGE(result.err.find("one.jsonl:1:") == 0, result.err);
    CHECK_MESSAGE(result.err.find(code) != std::string::npos, result.err);
  };
  refused(R"~(["R()"])~", "E6103");
  refused(R"~(["ReleasedAt(G(),0)"])~", "E6103");
  refused(R"~(["P()"])~", "E6102");
  refused(R"~(["ReleasedAt(F(),2)"])~", "E6102");
  refused(R"~(["ReleasedAt(F())"])~", "E6102");
  refused("[1]", "E6102");
  refused("\"Q()\"", "E6102");
}

TEST_CASE("a trace of another model is refused at the hash, or compared by its names on request") {
  const Lamp lamp;
  lamp.cli.write("m.e", std::string(kLamp) + "!Happens(Press(),0).\n");
  const auto refused = lamp.replay("t.jsonl");
  CHECK(refused.code == 3);
  CHECK(refused.err.find("t.jsonl:9:") != std::string::npos);
  CHECK(refused.err.find("E6104") != std::string::npos);
  CHECK(refused.out == "");
  const auto compared = lamp.replay("t.jsonl", {"--other-model"});
  CHECK(compared.code == 1);
  CHECK(compared.out.ends_with("8 traces replayed, complete: 4 agree, 4 fail, 4 checked\n"));
  lamp.cli.write("m.e", "range time 0 2\nfluent Glows()\nevent Press()\n");
  const auto stranger = lamp.replay("t.jsonl", {"--other-model"});
  CHECK(stranger.code == 3);
  CHECK(stranger.err.find("E6103") != std::string::npos);
}

TEST_CASE("the horizon has to be that of the trace") {
  const Lamp lamp;
  const auto result = lamp.replay("t.jsonl", {"--horizon", "3"});
  CHECK(result.code == 3);
  CHECK(result.err.find("t.jsonl:1:") != std::string::npos);
  CHECK(result.err.find("E6105") != std::string::npos);
}

TEST_CASE("with state constraints a trace has to end where they hold first") {
  const Lamp lamp;
  const std::vector<std::string> until = {"--until", "HoldsAt(On(),time)"};
  lamp.cli.write("u.jsonl", lamp.cli
                                .parallax({"traces", "m.e", "--until", "HoldsAt(On(),time)",
                                           "--format", "jsonl", "--limit", "0"})
                                .out);
  const auto fine = lamp.replay("u.jsonl", until);
  CHECK(fine.code == 0);
  CHECK(fine.out.find("2 agree, 0 fail") != std::string::npos);
  const auto other = lamp.replay("t.jsonl", {"--until", "HoldsAt(On(),time)", "--other-model"});
  CHECK(other.code == 1);
  CHECK(other.err.find("E7205") != std::string::npos);
  CHECK(other.err.find("the state constraints hold before, at 1") != std::string::npos);
  CHECK(other.err.find("the state constraints do not hold at 2") != std::string::npos);
}

TEST_CASE("traces of a scenario go through its plan") {
  const CliFixture cli;
  const auto traces = cli.parallax({"traces", "scenario.yaml", "--format", "jsonl"});
  cli.write("t.jsonl", traces.out);
  const auto result = cli.parallax({"traces", "scenario.yaml", "--replay", "t.jsonl"});
  CHECK(result.code == 0);
  CHECK(result.out.find(" 0 fail") != std::string::npos);
  // States that the model allows, but the plan would have gone somewhere.
  cli.write("idle.jsonl",
            R"~({"timepoints":[{"time":0,"happens":[],"holds":["BoxIn(r2)","RobotIn(r1)"]},)~"
            R"~({"time":1,"happens":[],"holds":["BoxIn(r2)","RobotIn(r1)"]}]})~");
  const auto idle = cli.parallax({"traces", "scenario.yaml", "--replay", "idle.jsonl"});
  CHECK(idle.code == 1);
  CHECK(idle.out.find("trace 1: fails at timepoint 1, ") == 0);
  CHECK(idle.err.find("fetch.lisp:11") != std::string::npos);
  CHECK(idle.err.find("plan step") != std::string::npos);
}

TEST_CASE("files that are no trace file give one located message and exit code 3") {
  const Lamp lamp;
  const auto whole = lamp.cli.read("t.jsonl");
  const auto first = whole.substr(0, whole.find('\n') + 1);
  const auto itf = lamp.cli.read("one.itf.json");
  std::string deep(100000, '[');
  const auto changed = [](std::string text, const std::string& from, const std::string& to) {
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "E6101"},
      {"\n \n", "E6101"},
      {"hello\n", "E6101"},
      {"[]\n", "E6102"},
      {"{}\n", "E6102"},
      {"null", "E6102"},
      {deep, "E6101"},
      {"{\"timepoints\":" + deep, "E6101"},
      {std::string("\0\1\2", 3), "E0006"},
      {"{\"trace\":\"\xff\"}", "E0006"},
      {first.substr(0, first.size() / 2), "E6101"},           // cut off
      {whole.substr(0, whole.size() - 20), "E6101"},          // in the last line
      {first + first.substr(0, 40) + "\n", "E6101"},          // in a later trace
      {first + R"({"summary":true,"traces":2})", "E6102"},    // a trace was taken out
      {changed(first, "\"time\":1", "\"time\":2"), "E6102"},  // a timepoint was taken out
      {changed(first, "\"time\":1", "\"time\":\"1\""), "E6102"},
      {changed(first, "\"time\":1,", ""), "E6102"},
      {changed(first, "\"trace\":1", "\"trace\":0"), "E6102"},
      {changed(first, "\"holds\":[]", "\"holds\":{}"), "E6102"},
      {changed(first, "\"holds\":[]", "\"holds\":[1]"), "E6102"},
      {changed(first, "\"holds\":[]", "\"holds\":[\"Of()\"]"), "E6103"},
      {changed(first, "\"happens\":[]", "\"happens\":[\"On()\"]"), "E6103"},
      {changed(first, "\"trace\":1", "\"trace\":1,\"trace\":2"), "E6101"},
      {R"({"timepoints":[]})", "E6102"},
      {itf.substr(0, itf.size() / 2), "E6101"},
      {changed(itf, "\"On\":", "\"Of\":"), "E6102"},  // a state without a variable
      {changed(itf, "\"On\"", "\"Of\""), "E6103"},    // in vars
      {changed(itf, "init", "Press()"), "E6102"},
      {changed(itf, "false]", "0]"), "E6102"},
      {changed(itf, "\"states\":[", "\"states\":[],\"old\":["), "E6102"},
      {changed(itf, "\"vars\":", "\"loop\":0,\"vars\":"), "E6102"},
      {changed(itf, "\"vars\":", "\"names\":"), "E6102"},
      {changed(itf, "\"tag\":\"None\"", "\"tag\":\"Maybe\""), "E6102"},
  };
  for (const auto& [text, code] : cases) {
    CAPTURE(text.substr(0, 300));
    lamp.cli.write("bad", text);
    const auto result = lamp.replay("bad", {"--time-limit", "20"});
    CHECK(result.code == 3);
    CHECK(count(result.err, "error[") == 1);
    CHECK(result.err.find("bad:") == 0);
    CHECK_MESSAGE(result.err.find(code) != std::string::npos, result.err);
    CHECK(result.out.find("complete") == std::string::npos);
    const auto document = Json::parse(lamp.replay("bad", {"--json"}).out);
    CHECK(document["status"] == "error");
  }
  CHECK(lamp.replay("missing").code == 2);
}

TEST_CASE("a file of a million brackets or values is refused in bounded time and memory") {
  const Lamp lamp;
  std::string wide = "{\"timepoints\":[0";
  for (int i = 0; i < 4'100'000; ++i) wide += ",0";
  lamp.cli.write("wide", wide + "]}");
  const auto result = lamp.replay("wide", {"--memory-limit", "600"});
  CHECK(result.code == 3);
  CHECK(result.err.find("E6101") != std::string::npos);
}

TEST_CASE("a limit before the last trace: what was replayed is printed, and stopped") {
  const Lamp lamp;
  std::string many;
  const auto whole = lamp.cli.read("t.jsonl");
  const auto first = whole.substr(0, whole.find('\n') + 1);
  for (int i = 0; i < 200000; ++i) many += first;
  lamp.cli.write("many", many);
  const auto result = lamp.replay("many", {"--time-limit", "0.5"});
  CHECK(result.code == 4);
  CHECK(result.out.find("traces replayed, stopped: ") != std::string::npos);
  CHECK(result.out.find("complete") == std::string::npos);
}

}  // namespace
}  // namespace parallax::test
