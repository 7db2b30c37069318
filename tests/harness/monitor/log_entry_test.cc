#include "harness/monitor/log_entry.h"

#include <doctest/doctest.h>

namespace parallax::test {
namespace {

using harness::CsvLog;
using harness::FlagBinding;
using harness::ForeignNames;
using harness::LogEntry;
using harness::LogError;
using harness::ObservationReader;
using harness::RangeBinding;
using harness::StateMapping;

/// Three variables: a number, a flag and a text.
struct Fixture {
  StateMapping mapping{harness::RegionMap(harness::RegionSet()),
                       {{"Open", 0, RangeBinding{"door.q", {0.4, 0.5}, {0.0, 0.1}, 0.0}, {}},
                        {"Held", 0, FlagBinding{"box.held", false}, {}},
                        {"Looks", 0, harness::EqualsBinding{"robot.looking_at", "door"}, {}}}};
  ObservationReader reader{mapping,
                           {harness::ground_fluent("Open()"), harness::ground_fluent("Held()"),
                            harness::ground_fluent("Looks()")}};
  LogEntry entry;
  ForeignNames foreign;

  std::string json(std::string_view line) {
    const auto error = read_json_line(line, reader, entry, foreign);
    return error ? error->text : std::string();
  }
  const std::optional<harness::Value>& value(const char* name) {
    return entry.values[*reader.variable(name)];
  }
};

TEST_CASE("a line of JSON: an event with its outcome, an action that is begun, a state") {
  Fixture f;
  CHECK(f.json(
            R"j({"t": 1.5, "event": "Go( bTable )", "outcome": "failed", "reason": "blocked"})j") ==
        "");
  CHECK(f.entry.t == 1.5);
  REQUIRE(f.entry.events);
  CHECK(*f.entry.events == std::vector<std::string>{"Go(bTable)"});
  CHECK(f.entry.ok == false);
  CHECK(f.entry.reason == "blocked");
  CHECK_FALSE(f.entry.has_state);
  CHECK(f.json(R"j({"state": {"door.q": 1, "box.held": true, "robot.looking_at": "door",
                   "other": 3, "box.mass": null}, "t": 2})j") == "");
  CHECK(f.entry.has_state);
  CHECK_FALSE(f.entry.events);
  CHECK(std::get<std::int64_t>(*f.value("door.q")) == 1);
  CHECK(std::get<bool>(*f.value("box.held")));
  CHECK(std::get<std::string>(*f.value("robot.looking_at")) == "door");
  CHECK(f.foreign == ForeignNames{"other"});
  CHECK(f.json(R"j({"t": 2, "event": ["Go(a)", "Ring"]})j") == "");
  CHECK(*f.entry.events == std::vector<std::string>{"Go(a)", "Ring()"});
  CHECK(f.json(R"j({"t": 2, "event": []})j") == "");
  CHECK(f.entry.events->empty());
  CHECK(f.json(R"j({"t": 2, "started": "Go(a)"})j") == "");
  CHECK(f.entry.started == "Go(a)");
  // A value that was not reported again is gone.
  CHECK(f.json(R"j({"t": 3, "state": {}})j") == "");
  CHECK_FALSE(f.value("door.q"));
}

TEST_CASE("a line of JSON that is none of a log is refused in its words") {
  Fixture f;
  const std::pair<const char*, const char*> cases[] = {
      {R"j({"t": 1, "sate": {}})j", "`sate` is no key of a line of a log; is `state` meant?"},
      {R"j({"event": "Go(a)"})j", "`t`, the time in seconds, is missing"},
      {R"j({"t": 1})j", "it says nothing: `event`, `started` and `state` are missing"},
      {R"j({"t": 1, "state": {}, "outcome": "ok"})j",
       "an outcome is that of an `event`, and there is none"},
      {R"j({"t": 1, "event": "Go(a)", "outcome": "good"})j",
       "an outcome is `ok` or `failed`, not `good`"},
      {R"j({"t": "1", "event": "Go(a)"})j", "a text is not what `t` can be"},
      {R"j({"t": 1, "event": {"name": "Go"}})j", "an object is not what `event` can be"},
      {R"j({"t": 1, "state": {"door": {"q": 1}}})j", "an object is not what `door` can be"},
      {R"j({"t": 1, "state": {"door.q": "wide"}})j",
       "`door.q` is a number where the mapping asks for it"},
      {R"j({"t": 1, "state": {"box.held": 0.5}})j",
       "`box.held` is true or false where the mapping asks for it"},
      {R"j({"t": 1, "state": {"robot.looking_at": 3}})j",
       "`robot.looking_at` is a text where the mapping asks for it"},
      {R"j({"t": 1, "state": {"door.q": 1, "door.q": 2}})j", "`door.q` is there twice"},
      {R"j({"t": 1, "t": 2, "event": "Go(a)"})j", "`t` is there twice"},
      {R"j({"t": 1, "state": {"door.q": NaN}})j", "it is no JSON object as far as it goes"},
      {R"j({"t": 1, "state": {"door.q": 1e999}})j", "a number is too large"},
      {R"j([1, 2])j", "it is no JSON object"},
      {R"j({"t": 1, "state": {"door.q)j", "it is no JSON object as far as it goes"},
      {R"j({"t": 1, "event": "Go(a)"} x)j", "it is no JSON object as far as it goes"}};
  for (const auto& [line, wanted] : cases) {
    CAPTURE(line);
    CHECK(f.json(line) == wanted);
  }
}

struct CsvFixture : Fixture {
  CsvLog log;
  std::string header(std::string_view line) {
    const auto error = log.read_header(line, reader, foreign);
    return error ? error->text : std::string();
  }
  std::string row(std::string_view line) {
    const auto error = log.read_line(line, reader, entry);
    return error ? error->text : std::string();
  }
};

TEST_CASE("a row of CSV says what its cells say") {
  CsvFixture f;
  REQUIRE(f.header("t,event,outcome,door.q,box.held,robot.looking_at,other") == "");
  CHECK(f.foreign == ForeignNames{"other"});
  CHECK(f.row("1.5,\"PickUp(left,milk1);Ring\",ok,,,,") == "");
  CHECK(*f.entry.events == std::vector<std::string>{"PickUp(left,milk1)", "Ring()"});
  CHECK(f.entry.ok == true);
  CHECK_FALSE(f.entry.has_state);
  CHECK(f.row("2,,,0.45,false,\"the \"\"door\"\"\",7") == "");
  CHECK_FALSE(f.entry.events);
  CHECK(std::get<double>(*f.value("door.q")) == 0.45);
  CHECK_FALSE(std::get<bool>(*f.value("box.held")));
  CHECK(std::get<std::string>(*f.value("robot.looking_at")) == "the \"door\"");
  CHECK(f.row("3,,,,1,,") == "");
  CHECK_FALSE(f.value("door.q"));
  CHECK(std::get<bool>(*f.value("box.held")));
}

TEST_CASE("quotes around an empty cell change nothing, in every column") {
  const std::string columns =
      "t,event,outcome,reason,started,door.q,box.held,robot.looking_at,other";
  for (int quoted = 0; quoted < 256; ++quoted) {
    CsvFixture f;
    REQUIRE(f.header(columns) == "");
    std::string row = "4";
    for (int i = 0; i < 8; ++i) row += (quoted >> i & 1) != 0 ? ",\"\"" : ",";
    CAPTURE(row);
    CHECK(f.row(row) == "it says nothing: `event`, `started` and `state` are missing");
    CHECK_FALSE(f.entry.events);
    for (const char* name : {"door.q", "box.held", "robot.looking_at"}) CHECK_FALSE(f.value(name));
  }
}

TEST_CASE("a row of CSV that does not fit is refused in its words") {
  CsvFixture f;
  CHECK(f.header("time,event") ==
        "neither a JSON object nor a header of CSV with a column `t`, the time in seconds");
  // Taken for a column of somebody's own, it would leave out every event without a word.
  CHECK(CsvFixture().header("t,Event,door.q") == "write the column `Event` as `event`");
  CHECK(CsvFixture().header("t, event,door.q") == "write the column ` event` as `event`");
  CHECK(CsvFixture().header("t,T,event,door.q") == "");
  CsvFixture twice;
  CHECK(twice.header("t,door.q,door.q") == "the column `door.q` is there twice");
  CsvFixture g;
  REQUIRE(g.header("t,event,door.q,box.held") == "");
  const std::pair<const char*, const char*> cases[] = {
      {"1,Go(a)", "it has 2 cells, and the header 4"},
      {"1,Go(a),1,1,1", "it has 5 cells, and the header 4"},
      {"1,\"Go(a),1,1", "a quoted cell does not end"},
      {"1,\"Go(a)\"x,1,1", "something stands behind a quoted cell"},
      {"1,,nan,", "`door.q` is no finite number"},
      {"1,,inf,", "`door.q` is no finite number"},
      {"1,,1.2.3,", "`door.q` is a number where the mapping asks for it"},
      {"1,,,maybe", "`box.held` is true or false where the mapping asks for it"},
      {"nan,Go(a),,", "`nan` is no time in seconds"},
      {",Go(a),,", "`t`, the time in seconds, is missing"},
      {"1,,,", "it says nothing: `event`, `started` and `state` are missing"}};
  for (const auto& [line, wanted] : cases) {
    CAPTURE(line);
    CHECK(g.row(line) == wanted);
  }
}

}  // namespace
}  // namespace parallax::test
