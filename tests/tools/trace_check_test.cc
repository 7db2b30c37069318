// `parallax traces --check`, and its messages when a trace is wrong.

#include "tools/app/trace_check.h"

#include <doctest/doctest.h>

#include "compiler/base/diagnostic_printer.h"
#include "tests/support/text_model.h"
#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

constexpr const char* kModel =
    "range time 0 1\nfluent On()\nevent Press()\n[time] Initiates(Press(),On(),time).\n"
    "!HoldsAt(On(),0).\n";

runtime::Trace trace_of(const std::vector<std::string>& first_events,
                        const std::vector<std::string>& last_state,
                        const std::vector<std::string>& first_state = {}) {
  const auto symbols = std::make_shared<compiler::SymbolTable>();
  runtime::Trace trace;
  trace.symbols = symbols;
  trace.number = 7;
  trace.points.resize(2);
  for (const auto& event : first_events) {
    trace.points[0].happens.push_back(symbols->add_event(event));
  }
  for (const auto& name : first_state) trace.points[0].holds.push_back(symbols->add_fluent(name));
  for (const auto& name : last_state) trace.points[1].holds.push_back(symbols->add_fluent(name));
  return trace;
}

TEST_CASE("a right trace is counted, a wrong one is an internal error at the axiom") {
  TextModel model(kModel);
  REQUIRE(model.typed != nullptr);
  tools::TraceCheck check(*model.typed, nullptr, model.sink);
  check.check(trace_of({"Press()"}, {"On()"}));
  CHECK(check.agreed());
  CHECK(model.codes() == "");
  check.check(trace_of({"Press()"}, {}));
  CHECK(!check.agreed());
  CHECK(check.checked() == 2);
  REQUIRE(model.codes() == "E7201");
  CHECK(model.sink.exit_code() == 5);
  const auto text = base::to_text(model.sink.sorted().front(), model.files, {});
  CHECK(text.find("test.e:4:") != std::string::npos);
  CHECK(text.find("trace 7 does not satisfy the model: DEC9 for On(): no effect of "
                  "Happens(Press(),0)") != std::string::npos);
}

TEST_CASE("further violations of one trace are notes") {
  TextModel model(kModel);
  REQUIRE(model.typed != nullptr);
  tools::TraceCheck check(*model.typed, nullptr, model.sink);
  check.check(trace_of({}, {}, {"On()"}));
  REQUIRE(model.codes() == "E7201");
  const auto diagnostic = model.sink.sorted().front();
  REQUIRE(diagnostic.notes.size() == 1);
  CHECK(diagnostic.notes[0].text == "DEC5 for On(): it changes without an event at 0");
}

TEST_CASE("a raised stop ends the check with a message, once") {
  TextModel model(kModel);
  REQUIRE(model.typed != nullptr);
  const std::atomic<bool> stop = true;
  tools::TraceCheck check(*model.typed, &stop, model.sink);
  check.check(trace_of({}, {}));
  check.check(trace_of({}, {}));
  CHECK(check.checked() == 0);
  CHECK(model.codes() == "E7202");
  CHECK(model.sink.exit_code() == 4);
}

TEST_CASE("--check counts what it checked in every form of output") {
  const CliFixture cli;
  cli.write("m.e", kModel);
  const auto text = cli.parallax({"traces", "m.e", "--check"});
  CHECK(text.code == 0);
  CHECK(text.err == "");
  CHECK(text.out.find("2 traces, complete (no proof), 2 checked\n") != std::string::npos);
  const auto lines = cli.parallax({"traces", "m.e", "--check", "--format", "jsonl"});
  CHECK(lines.out.find("\"checked\":2") != std::string::npos);
  const auto json = cli.parallax({"traces", "m.e", "--check", "--json", "--limit", "1"});
  CHECK(json.out.find("\"checked\":1") != std::string::npos);
  const auto count = cli.parallax({"traces", "m.e", "--check", "--json", "--count"});
  CHECK(count.out.find("\"checked\":2") != std::string::npos);
  CHECK(cli.parallax({"traces", "m.e", "--json"}).out.find("checked") == std::string::npos);
}

TEST_CASE("--check goes through a scenario's plan and constraints") {
  const CliFixture cli;
  const auto result = cli.parallax({"traces", "scenario.yaml", "--check"});
  CHECK(result.code == 0);
  CHECK(result.err == "");
  CHECK(result.out.find(", 1 checked\n") != std::string::npos);
}

TEST_CASE("--check does not go with the meaning of the 2005 reasoner") {
  const CliFixture cli;
  cli.write("m.e", kModel);
  const auto result = cli.parallax({"traces", "m.e", "--check", "--compat", "decreasoner"});
  CHECK(result.code == 2);
  CHECK(result.err.find("--check") != std::string::npos);
  CHECK(result.out == "");
}

TEST_CASE("a model too large for the check says so, prints its traces and exits with 4") {
  const CliFixture cli;
  cli.write("m.e",
            "range time 0 1\nsort n: integer\nrange n 0 99\nfluent F()\n"
            "[n1,n2,n3] n1=n2 & n2=n3 & n3=7 & n1=7 & n2=7 -> HoldsAt(F(),0).\n");
  const auto result = cli.parallax({"traces", "m.e", "--check"});
  CHECK(result.code == 4);
  CHECK(result.err.find("E7202") != std::string::npos);
  CHECK(result.out.find("1 trace, complete (no proof), 0 checked\n") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
