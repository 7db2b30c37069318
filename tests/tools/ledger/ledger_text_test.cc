// The text of a ledger, edited line by line: the rest stays as it is.

#include "tools/ledger/ledger_text.h"

#include <doctest/doctest.h>

#include <random>

#include "tools/ledger/ledger_check.h"

namespace parallax::tools {
namespace {

using harness::Ledger;
using harness::LedgerEntry;
using harness::LedgerStatus;

Ledger read(const std::string& text) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto ledger = harness::parse_ledger(files.add("ledger.yaml", text), files, sink);
  REQUIRE_MESSAGE(ledger, (sink.has_errors() ? sink.sorted().front().message : text));
  return *ledger;
}

LedgerEntry entry_of(const std::string& scenario, const std::string& id) {
  LedgerEntry entry;
  entry.id = id;
  entry.scenario = scenario;
  entry.event = "Place(r1)";
  entry.fluents = {"not BoxIn(r1)"};
  entry.trace = {"Go(r2)"};
  return entry;
}

TEST_CASE("entries come in any order, and the file has them by scenario and id") {
  std::mt19937 random(5);
  std::vector<LedgerEntry> entries;
  for (const auto* scenario : {"a.yaml", "b/c.yaml", "z.yaml"}) {
    for (const auto* id : {"one", "three", "two"}) {
      entries.push_back(entry_of(scenario, std::string(scenario, 1) + '.' + id));
    }
  }
  std::string first;
  for (int round = 0; round < 20; ++round) {
    std::shuffle(entries.begin(), entries.end(), random);
    auto text = new_ledger_text();
    for (const auto& entry : entries) {
      const auto more = with_entry(text, read(text), entry);
      REQUIRE(more);
      text = *more;
    }
    if (round == 0) first = text;
    CHECK(text == first);
  }
}

TEST_CASE("any text that an entry may hold is read back, and other lines stay to the byte") {
  const std::string hand =
      "# ours\n"
      "discrepancies:\n"
      "    # about b\n"
      "    -   id: b   # a remark\n"
      "        status: 'accepted because it''s rare: so'\n"
      "        scenario: m.yaml\n"
      "        event: \"Go(r2)\"\n"
      "\n"
      "    # about d\n"
      "    - {id: d, scenario: m.yaml, event: start, status: open}\n"
      "# end";
  const auto ledger = read(hand);
  REQUIRE(ledger.entries.size() == 2);
  CHECK(ledger.entries[0].decision == "it's rare: so");
  for (const auto* odd : {"plain",
                          "a: b",
                          "# no comment",
                          "- dash",
                          "\"quoted\"",
                          "it's",
                          "true",
                          "1.5",
                          "null",
                          "~",
                          "a\nb\tc",
                          "\xE2\x80\xAE turned",
                          "ends with colon:",
                          " blank ",
                          "{x: y}",
                          "[1]",
                          "*a",
                          "&b",
                          "!t",
                          "%d",
                          "@x",
                          "`y`",
                          "back\\slash",
                          "x #y",
                          "|",
                          ">"}) {
    CAPTURE(odd);
    auto entry = entry_of("m.yaml", "c");
    entry.says = odd;
    entry.outcome = odd;
    entry.trace = std::vector<std::string>{odd, "Go(r2)"};
    entry.status = LedgerStatus::kAccepted;
    entry.decision = odd;
    const auto text = with_entry(hand, ledger, entry);
    REQUIRE(text);
    const auto again = read(*text);
    REQUIRE(again.entries.size() == 3);
    CHECK(again.entries[1].says == odd);
    CHECK(again.entries[1].trace == entry.trace);
    CHECK(again.entries[1].decision == odd);
    // Behind the entry of b and in front of the comment on d; the rest is as it was.
    auto rest = *text;
    const auto added = entry_text(entry, 4);
    const auto at = rest.find(added);
    REQUIRE(at == hand.find("    # about d"));
    CHECK(rest.erase(at, added.size()) == hand);
  }
}

TEST_CASE("a status is replaced where it stands") {
  const std::string hand =
      "discrepancies:\n"
      "  - id: a\n"
      "    status: \"repaired in 12\"  # by Ann\n"
      "    scenario: m.yaml\n"
      "    event: E()\n"
      "  - {id: b, scenario: m.yaml, event: E(), status: open}\n";
  auto entry = *read(hand).find("a");
  entry.status = LedgerStatus::kOpen;
  entry.decision.clear();
  CHECK(with_status(hand, read(hand), entry) ==
        "discrepancies:\n"
        "  - id: a\n"
        "    status: open  # by Ann\n"
        "    scenario: m.yaml\n"
        "    event: E()\n"
        "  - {id: b, scenario: m.yaml, event: E(), status: open}\n");
  entry = *read(hand).find("b");
  entry.status = LedgerStatus::kAccepted;
  entry.decision = "never, mind";
  const auto text = with_status(hand, read(hand), entry);
  // Within braces a comma would end the text: a value that cannot be replaced so is left alone.
  if (text) CHECK(read(*text).find("b")->decision == "never, mind");
  if (!text) CHECK(read(hand).find("b")->status == LedgerStatus::kOpen);
}

TEST_CASE("layouts that are not edited line by line are refused, not broken") {
  for (const std::string hand :
       {"{discrepancies: [{id: a, scenario: m.yaml, event: E(), status: open}]}\n",
        "discrepancies: [{id: a, scenario: m.yaml, event: E(), status: open}]\n",
        "discrepancies:\n  - id: a\n    scenario: m.yaml\n    event: E()\n    status: "
        "open\n...\n"}) {
    CAPTURE(hand);
    CHECK(!with_entry(hand, read(hand), entry_of("m.yaml", "b")));
  }
  for (const std::string empty : {"discrepancies:", "discrepancies: []",
                                  "discrepancies: [ ] # none\n", "# x\ndiscrepancies:\n# y\n"}) {
    CAPTURE(empty);
    const auto text = with_entry(empty, read(empty), entry_of("m.yaml", "b"));
    REQUIRE(text);
    CHECK(read(*text).entries.size() == 1);
  }
}

TEST_CASE("an entry that asks for less is known by less; the one that asks for most speaks") {
  ShownDiscrepancy shown{"1.1", "Place(r1)", "", {"BoxIn(r2)", "not BoxIn(r1)"}, {"Go(r2)"}, "w"};
  auto entry = entry_of("m.yaml", "a");
  CHECK(!is_known_as(shown, entry));
  entry.fluents = {"not BoxIn(r1)", "BoxIn(r2)"};  // in any order
  CHECK(is_known_as(shown, entry));
  entry.trace = {"Go(r1)"};
  CHECK(!is_known_as(shown, entry));
  entry.trace.reset();
  CHECK(is_known_as(shown, entry));
  entry.fluents.reset();
  CHECK(is_known_as(shown, entry));
  entry.outcome = "path-blocked";
  CHECK(!is_known_as(shown, entry));
  entry.outcome.reset();
  Ledger ledger;
  ledger.entries = {entry, entry_of("m.yaml", "b"), entry_of("other.yaml", "c")};
  ledger.entries[1].fluents = {"BoxIn(r2)", "not BoxIn(r1)"};
  ledger.entries[1].status = LedgerStatus::kRepaired;
  ledger.entries[1].decision = "12";
  ShownRun run;
  run.discrepancies = {shown};
  const auto verdict = hold_against(ledger, "m.yaml", run);
  REQUIRE(verdict.findings.size() == 1);
  CHECK(verdict.findings[0].kind == LedgerFinding::Kind::kBack);
  CHECK(verdict.findings[0].words() == "b is repaired in 12, and comes back: 1.1: w");
  CHECK(hold_against(ledger, "other.yaml", run).findings[0].kind == LedgerFinding::Kind::kUnknown);
}

/// The only discrepancy of a run in which trace 1 is Go(r2), PickUp(), Go(r2).
ShownDiscrepancy shown_of(const std::string& discrepancy, const std::string& more = {}) {
  const auto run = shown_run(
      R"x({"traces":[{"trace":1,"events":["Go(r2)","PickUp()","Go(r2)"]}],"discrepancies":[)x" +
      discrepancy + "]" + more + "}");
  REQUIRE(run);
  REQUIRE(run->discrepancies.size() == 1);
  return run->discrepancies.front();
}

using Names = std::vector<std::string>;

TEST_CASE("event and outcome are known by the fields of the cause, whatever its words are") {
  // The reason has the outcome.
  auto shown = shown_of(
      R"x({"trace":1,"sample":3,"first_divergence":2,"first":[{"fluent":"Held()","observed":false}],)x"
      R"x("cause":{"text":"in other words: x","reason":"slipped: off","event":"PickUp()"}})x");
  CHECK(shown.sample == "1.3");
  CHECK(shown.event == "PickUp()");
  CHECK(shown.outcome == "slipped");
  CHECK(shown.fluents.empty());
  CHECK(shown.trace == Names{"Go(r2)"});
  // No reason: the status of the event has it, of the one behind the first divergence.
  const std::string silent =
      R"x({"trace":1,"first_divergence":3,"first":[{"fluent":"Held()","observed":true}],)x"
      R"x("cause":{"text":"y","event":"Go(r2)"},"outcomes":[{"status":"ok"},{"status":"ok"},)x";
  shown = shown_of(silent + R"x({"status":"truncated"}]})x");
  CHECK(shown.outcome == "truncated");
  CHECK(shown.fluents.empty());
  CHECK(shown.trace == Names{"Go(r2)", "PickUp()"});
  shown = shown_of(silent + R"x({"status":"ok"}]})x");
  CHECK(shown.outcome.empty());
  CHECK(shown.fluents == Names{"Held()"});
  // A fluent that differs at the end had the opposite value where it began to differ.
  shown = shown_of(
      R"x({"trace":1,"first_divergence":2,"first":[],"fluents":[{"fluent":"Held()","observed":true}],)x"
      R"x("cause":{"text":"PickUp(): not Held()","event":"PickUp()","fluents":["Held()"]}})x",
      R"x(,"compare":"final")x");
  CHECK(shown.outcome.empty());
  CHECK(shown.fluents == Names{"Held()"});
  shown = shown_of(
      R"x({"trace":1,"first_divergence":0,"first":[{"fluent":"Held()","observed":false}],)x"
      R"x("cause":{"text":"start: not Held()","event":""}})x");
  CHECK(shown.event == "start");
  CHECK(shown.fluents == Names{"not Held()"});
  CHECK(shown.trace.empty());
}

TEST_CASE("a step of an executed plan is known by how the model does not have it") {
  const auto step = [](const std::string& differs, const std::string& outcome,
                       const std::string& status) {
    return shown_of(R"x({"trace":1,"first":[{"fluent":"F()","observed":true}],)x"
                    R"x("cause":{"text":"z","event":"Detect(cup)"},)x"
                    R"x("path":[{"event":"Go(r2)","outcome":"failed","condition":"c"},)x"
                    R"x({"event":"Detect(cup)",)x" +
                        outcome +
                        R"x(}],"outcomes":[{"status":"failed","reason":"path: blocked"},{)x" +
                        status + R"x(}],"differs":{"event":1,)x" + differs + "}}",
                    R"x(,"execution":"closed-loop")x");
  };
  const std::string ok = R"x("status":"ok")x", found = R"x("outcome":"ok","object":"cup1")x";
  const auto impossible = step(R"x("impossible":true)x", found, ok);
  CHECK(impossible.event == "Detect(cup)");
  CHECK(impossible.outcome == "happens");
  CHECK(impossible.trace == Names{"Go(r2) fails (c)"});
  CHECK(step(R"x("outcome":true)x", found, ok).outcome == "found cup1");
  CHECK(step(R"x("outcome":true)x", R"x("outcome":"ok")x", ok).outcome == "succeeds");
  CHECK(step(R"x("outcome":true)x", R"x("outcome":"failed")x", ok).outcome == "fails");
  CHECK(step(R"x("outcome":true)x", R"x("outcome":"failed")x",
             R"x("status":"failed","reason":"not-found: cup")x")
            .outcome == "not-found");
  const auto differs = step(R"x("outcome":false)x", found, ok);
  CHECK(differs.outcome.empty());
  CHECK(differs.fluents == Names{"F()"});
}

TEST_CASE("documents of anything are no runs, and half of one says no more than it has") {
  for (const auto* text :
       {"", "{", "[]", "null", "{}", R"({"traces":[]})", R"({"traces":{},"discrepancies":[]})"}) {
    CHECK(!shown_run(text));
  }
  const auto run = shown_run(
      R"x({"traces":[7,{"trace":"x","events":[1,"E()"]}],)x"
      R"x("discrepancies":[{},7,{"trace":1,"first":[{}],"first_divergence":-9223372036854775807,)x"
      R"x("cause":{"text":"E(): F()"},"fluents":{}}]})x");
  REQUIRE(run);
  CHECK(run->discrepancies.size() == 3);
  CHECK(!run->is_complete);
}

}  // namespace
}  // namespace parallax::tools
