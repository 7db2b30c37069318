// Simulators written with tools/adapters/python/parallax_adapter.py.

#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/tools/adapters/python_fixture.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

constexpr const char* kRequests[] = {
    R"({"id":1,"method":"hello","params":{"protocol":[1]}})",
    R"({"id":2,"method":"reset","params":{"state":{"a.x":0.5},"seed":7}})",
    R"({"id":3,"method":"act","params":{"action":"go","args":{"target.x":1},"sim_time_limit":3}})",
    R"({"id":4,"method":"observe"})"};

std::string all_requests() {
  std::string text;
  for (const auto* line : kRequests) text += std::string(line) + '\n';
  return text;
}

/// A world of one variable; `body` is the code of `go`.
std::string one_variable(const std::string& body, const std::string& observed = "a") {
  return "import sys, os\n"
         "sim = Adapter('one', determinism='bitwise', time_step=0.1)\n"
         "sim.param('a.x', unit='m', settable=True, default=0.0, lower=-1.0, upper=2.0)\n"
         "a = {}\n"
         "sim.on_reset(lambda start: a.update(start))\n"
         "sim.on_observe(lambda: " +
         observed +
         ")\n"
         "@sim.action('go', required={'target.x': 'm'}, optional={'speed': 1.0})\n"
         "def go(target_x, speed):\n  " +
         body;
}

std::vector<Json> lines_of(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    CAPTURE(line);
    REQUIRE(Json::accept(line));
    lines.push_back(Json::parse(line));
  }
  return lines;
}

/// The replies to all requests when `go` does this.
std::vector<Json> replies(PythonFixture& python, const std::string& body,
                          const std::string& observed = "a") {
  auto lines = lines_of(python.answers(one_variable(body, observed), all_requests()));
  CAPTURE(python.errors);
  REQUIRE(lines.size() == 4);
  for (int i = 0; i < 4; ++i) CHECK(lines[static_cast<std::size_t>(i)].at("id") == i + 1);
  return lines;
}

TEST_CASE("the example in plain Python runs to a verdict, and its motion is recorded") {
  if (skipped_without_python()) return;
  const PythonFixture python;
  CHECK(python.parallax({"check", "kinematic_2d.yaml"}).code == 0);
  const auto run = json_of(python, {"run", "kinematic_2d.yaml", "--out", "out", "--jobs", "2"}, 1);
  CHECK(run.at("verdict") == "discrepancy");
  // The answer after a failed action is an observation; the motion went through the protocol.
  const auto found = run.dump();
  CHECK(found.find("navigation-pose-unreachable") != std::string::npos);
  CHECK(found.find("motion is missing") == std::string::npos);
  const auto exported = python.parallax({"export", "out"});
  CAPTURE(exported.err);
  CHECK(exported.code == 0);
  CHECK(exported.out.find(",robot,") != std::string::npos);
  const auto again = python.parallax({"replay", "out", "--allow-commands"});
  CAPTURE(again.out);
  CHECK(again.code == 0);
}

TEST_CASE("an action goes on in simulated time and ends at its limit, whatever it catches") {
  if (skipped_without_python()) return;
  PythonFixture python;
  auto done = replies(python, "a['a.x'] = target_x; sim.advance(0.5); sim.margin('goal', 0.25)");
  CHECK(done[2].at("result").at("status") == "ok");
  CHECK(done[2].at("result").at("sim_time") == 0.5);
  CHECK(done[2].at("result").at("margins").at("goal") == 0.25);
  CHECK(done[3].at("result").at("state") == Json{{"a.x", 1.0}});
  done = replies(python, "\n  while True:\n    try: sim.advance(0.5)\n    except Exception: pass");
  CHECK(done[2].at("result").at("status") == "truncated");
  CHECK(done[2].at("result").at("sim_time") == 3.0);
  done = replies(python, "\n  try: sim.advance(4)\n  except: pass");
  CHECK(done[2].at("result").at("status") == "truncated");
  done = replies(python, "raise Failed('path-blocked: a wall')");
  CHECK(done[2].at("result").at("status") == "failed");
  CHECK(done[2].at("result").at("reason") == "path-blocked: a wall");
  done = replies(python, "raise Lost('the engine is gone')");
  CHECK(done[2].at("result").at("status") == "lost");
}

TEST_CASE(
    "what a program prints or reads, itself or in another process, is no part of the protocol") {
  if (skipped_without_python()) return;
  PythonFixture python;
  const auto done = replies(python,
                            "print('noise'); os.system('echo more noise'); os.write(1, b'raw');"
                            "a['a.x'] = 1.0 if sys.stdin.read() == '' else 2.0");
  CHECK(done[2].at("result").at("status") == "ok");
  CHECK(done[3].at("result").at("state").at("a.x") == 1.0);
  for (const auto* word : {"noise", "more noise", "raw"}) {
    CHECK(python.errors.find(word) != std::string::npos);
  }
}

TEST_CASE("a defect of the program is an error, with its traceback on standard error") {
  if (skipped_without_python()) return;
  PythonFixture python;
  auto done = replies(python, "return 1 / 0");
  CHECK(done[2].at("error").at("code") == "internal");
  CHECK(done[2].at("error").at("message").get<std::string>().find("ZeroDivisionError") == 0);
  CHECK(python.errors.find("Traceback") != std::string::npos);
  // No NaN is sent, neither in the state nor in a margin.
  done = replies(python, "a['a.x'] = float('nan')");
  CHECK(done[3].at("error").at("code") == "not_finite");
  done = replies(python, "sim.margin('goal', float('inf'))");
  CHECK(done[2].at("error").at("code") == "not_finite");
  done = replies(python, "pass", "{}");
  CHECK(done[3].at("error").at("message") == "`a.x` was declared and is not observed");
  done = replies(python, "pass", "{'a.x': 1.0, 'a.y': 2.0}");
  CHECK(done[3].at("error").at("message") == "`a.y` is observed and was not declared");
  done = replies(python, "pass", "{'a.x': 'x' * 2000000}");
  CHECK(done[3].at("error").at("code") == "line_too_long");
}

TEST_CASE("what there is not, or cannot be, is refused") {
  if (skipped_without_python()) return;
  PythonFixture python;
  const std::string reset = R"({"id":2,"method":"reset","params":{"state":)";
  const std::string act = R"({"id":3,"method":"act","params":{"sim_time_limit":3,"action":)";
  const auto answer = [&](const std::string& line) {
    const auto requests = std::string(kRequests[0]) + '\n' + kRequests[1] + '\n' + line + '\n';
    return lines_of(python.answers(one_variable("pass"), requests)).at(2);
  };
  const std::pair<std::string, const char*> refused[] = {
      {reset + R"({"a.y":1},"seed":1}})", "unsupported"},
      {reset + R"({"a.x":"left"},"seed":1}})", "unsupported"},
      {reset + R"({"a.x":true},"seed":1}})", "unsupported"},
      {reset + R"({"a.x":2.5},"seed":1}})", "invalid_start"},
      {act + R"("fly"}})", "unsupported"},
      {act + R"("go","args":{}}})", "unsupported"},
      {act + R"("go","args":{"target.x":1,"target.y":1}}})", "unsupported"},
      {act + R"("go","args":{"target.x":1,"speed":"fast"}}})", "unsupported"}};
  for (const auto& [line, status] : refused) {
    CAPTURE(line);
    CHECK(answer(line).at("result").at("status") == status);
  }
  const std::pair<std::string, const char*> errors[] = {
      {R"({"id":2,"method":"jump"})", "unsupported"},
      {R"({"id":2,"method":"reset","params":{"state":{"a.x":NaN},"seed":1}})", "parse_error"},
      {R"({"id":2,"method":"reset","params":{"state":{"a.x":1e999},"seed":1}})", "parse_error"},
      {R"({"id":2,"method":"reset","params":{"state":{},"seed":-1}})", "invalid_params"},
      {R"({"id":"2","method":"observe"})", "invalid_request"},
      {"[1]", "invalid_request"},
      {"no json", "parse_error"},
      {std::string(2000, '['), "parse_error"}};
  for (const auto& [line, code] : errors) {
    CAPTURE(line);
    CHECK(answer(line).at("error").at("code") == code);
  }
  const auto lines = lines_of(
      python.answers(one_variable("pass"), std::string(kRequests[0]) + '\n' + kRequests[3] + '\n'));
  CHECK(lines.at(1).at("error").at("code") == "incorrect_state");
}

TEST_CASE("what the scenario gives a controller is held against what it says that it takes") {
  if (skipped_without_python()) return;
  const PythonFixture python;
  python.replace("kinematic_2d.yaml", "{controller: drive, from_plan",
                 "{controller: drive, max_sped_m_s: 0.4, from_plan");
  const auto result = python.parallax({"run", "kinematic_2d.yaml"});
  CHECK(result.code == 3);
  CHECK(result.err.find("kinematic_2d.yaml:27:47-49: error[E5121]: the controller `drive` takes no "
                        "argument `max_sped_m_s`") != std::string::npos);
  CHECK(result.err.find("max_speed_m_s") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
