// `parallax record` and `parallax replay-adapter`: the simulator of a run, and its recording in its
// place.

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/tools/adapters/python_fixture.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

std::string command_line(const std::string& words) {
  return "simulator: {command: [" + words + "]}";
}

TEST_CASE("a run is repeated from its recording, bit by bit, without the simulator") {
  if (skipped_without_python()) return;
  const PythonFixture python;
  const std::string program = PARALLAX_PROGRAM;
  const std::string plain = command_line("python3, kinematic_2d.py");
  const std::string record =
      command_line(program + ", record, -o, runs.ndjson, --, python3, -B, kinematic_2d.py");
  python.replace("kinematic_2d.yaml", plain, record);
  const std::vector<std::string> rates = {"rates", "kinematic_2d.yaml", "--runs", "30"};
  const auto with = [&](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  const auto first = python.parallax(with(rates, {"--samples", "a.csv", "--jobs", "2"}));
  CAPTURE(first.err);
  CHECK(first.code == 0);
  CHECK(python.read("runs.ndjson").starts_with("{\"parallax_adapter_recording\":1}\n"));
  // The simulator is gone; whatever the number of jobs, the recording answers every request.
  python.replace("kinematic_2d.yaml", record,
                 command_line(program + ", replay-adapter, runs.ndjson"));
  std::filesystem::remove(python.folder() / "kinematic_2d.py");
  for (const auto* jobs : {"1", "3"}) {
    const auto again = python.parallax(with(rates, {"--samples", "b.csv", "--jobs", jobs}));
    CAPTURE(again.err);
    CHECK(again.code == 0);
    CHECK(again.out == first.out);
    CHECK(python.read("b.csv") == python.read("a.csv"));
  }
  // A perform that was never asked for is a loss, with that reason.
  const auto other = python.parallax(with(rates, {"--seed", "2"}));
  CHECK(other.code == 4);
  CHECK(other.err.find("the recording has no such `perform`") != std::string::npos);
}

TEST_CASE("a run as one request gives the bytes of one request after the other") {
  if (skipped_without_python()) return;
  const auto outcome = [](const char* perform, std::size_t& requests) {
    const PythonFixture python;
    const std::string program = PARALLAX_PROGRAM;
    python.replace("kinematic_2d.py", "noise=True,",
                   std::string("noise=True, perform=") + perform + ",");
    python.replace("kinematic_2d.yaml", command_line("python3, kinematic_2d.py"),
                   command_line(program + ", record, -o, asked, --, python3, -B, kinematic_2d.py"));
    const auto run = python.parallax({"run", "kinematic_2d.yaml", "--out", "out", "--json"});
    const auto rates =
        python.parallax({"rates", "kinematic_2d.yaml", "--runs", "40", "--samples", "s.csv"});
    CAPTURE(run.err);
    CHECK(run.code == 1);
    CHECK(rates.code == 0);
    const auto asked = python.read("asked");
    requests = static_cast<std::size_t>(std::count(asked.begin(), asked.end(), '\n'));
    CHECK((asked.find("\"method\":\"perform\"") != std::string::npos) ==
          (std::string(perform) == "True"));
    // But for how long it took.
    return run.out.substr(0, run.out.rfind("\"timing\"")) + rates.out + python.read("s.csv") +
           python.read("out/report.txt");
  };
  std::size_t few = 0, many = 0;
  CHECK(outcome("True", few) == outcome("False", many));
  CHECK(few * 5 < many);
}

TEST_CASE("a recording is appended to, and nothing else is touched") {
  if (skipped_without_python()) return;
  const PythonFixture python;
  const std::string program = PARALLAX_PROGRAM;
  const auto ask = [&](const std::string& words, const std::string& requests) {
    python.write("requests", requests);
    ProcessOptions options;
    options.folder = python.folder().string();
    return run_process({"sh", "-c", "exec " + program + " " + words + " < requests"}, options);
  };
  const std::string hello = "{\"id\":1,\"method\":\"hello\",\"params\":{\"protocol\":[1]}}\n";
  const std::string record = "record -o r.ndjson -- python3 -B kinematic_2d.py";
  const auto said = ask(record, hello);
  CHECK(said.code == 0);
  CHECK(ask(record, hello + "no json\n").code == 0);
  const auto again = ask("replay-adapter r.ndjson", hello + "no json\n" + "[]\n");
  CHECK(again.code == 0);
  const auto first = again.out.substr(0, again.out.find('\n'));
  CHECK(nlohmann::json::parse(first) == nlohmann::json::parse(said.out));
  CHECK(again.out.find("not_recorded") != std::string::npos);
  // A simulator that ends is one that ends when it is replayed, with another code.
  CHECK(ask("record -o ends.ndjson -- sh -c 'exit 3'", hello).code == 3);
  CHECK(ask("replay-adapter ends.ndjson", hello).code == 1);

  python.write("mine", "mine\n");
  CHECK(ask("record -o mine -- python3 -B kinematic_2d.py", hello).code == 2);
  CHECK(python.read("mine") == "mine\n");
  CHECK(ask("record -o no/such/folder -- true", hello).code == 2);
  CHECK(ask("record -o /dev/null -- true", hello).code == 2);
  CHECK(ask("record -- true", hello).code == 2);
  const auto absent = ask("record -o absent.ndjson -- no-such-program", hello);
  CHECK(absent.code == 127);
  CHECK(absent.err.find("cannot start `no-such-program`") != std::string::npos);
}

TEST_CASE("what is no recording is refused at its line") {
  const CliFixture cli;
  const std::string head = "{\"parallax_adapter_recording\":1}\n";
  const auto check = [&](const std::string& text, const std::string& place) {
    CAPTURE(text);
    cli.write("r.ndjson", text);
    const auto result = cli.parallax({"replay-adapter", "r.ndjson"});
    CAPTURE(result.err);
    CHECK(result.code == 3);
    CHECK(result.err.find(place + ": error[E0010]") != std::string::npos);
  };
  check("", "r.ndjson:0");
  check("{}\n", "r.ndjson:1");
  check(head + "[]\n", "r.ndjson:2");
  check(head + "{\"session\":\"a\",\"request\":{}}\n", "r.ndjson:2");
  check(head + std::string(5000, '[') + "\n", "r.ndjson:2");
  CHECK(cli.parallax({"replay-adapter", "nothing"}).code == 2);
}

}  // namespace
}  // namespace parallax::test
