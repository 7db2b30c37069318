// `parallax adapter-check`: simulators that misbehave in one way each, and some that do not.

#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/tools/adapters/python_fixture.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

/// A simulator that shares no code with the adapter: a box that is pushed, with noise of the seed.
/// The code that replaces `# FAULT` changes an answer, `reply`, before it is sent.
constexpr const char* kPlainSimulator = R"(import json, os, random, sys, time
PARAMS = [{"name": "box.x", "unit": "m", "settable": True, "lower": -5, "upper": 5},
          {"name": "box.yaw", "unit": "rad"}, {"name": "box.held", "unit": "1"}]
HELLO = {"protocol": 1, "name": "plain", "version": "1", "determinism": "bitwise", "seeds": True,
         "time_step": 0.01, "capabilities": ["noise"], "params": PARAMS,
         "actions": [{"name": "push", "args": [{"name": "by", "unit": "m", "required": True,
                                                "example": 1}]}]}
state, rng, resets, finite = {}, random.Random(), 0, True
def outcome(status, sim_time=0.0): return {"status": status, "sim_time": sim_time}
def answer(method, params):
    if method == "hello": return HELLO
    if method == "reset":
        start = params["state"]
        if any(name != "box.x" or not isinstance(x, (int, float)) for name, x in start.items()):
            return outcome("unsupported")
        x = start.get("box.x", 0.0)
        if not -5 <= x <= 5: return outcome("invalid_start")
        rng.seed(params["seed"])
        state.update({"box.x": float(x), "box.yaw": 0.0, "box.held": False})
        return outcome("ok")
    if method == "act":
        if params["action"] != "push" or list(params["args"]) != ["by"]: return outcome("unsupported")
        if params["sim_time_limit"] < 2: return outcome("truncated", params["sim_time_limit"])
        state["box.x"] += params["args"]["by"] + rng.gauss(0, 0.01)
        return outcome("ok", 2.0)
    if method == "observe": return {"state": state}
    return outcome("ok")
def run():
    for line in sys.stdin:
        request = json.loads(line)
        method, params = request["method"], request.get("params", {})
        if method not in ("hello", "reset", "act", "observe", "close"):
            reply = {"id": request["id"], "error": {"code": -32601, "message": "no such method"}}
        else:
            result = json.loads(json.dumps(answer(method, params)))
            result = changed(method, params, result)
            reply = {"id": request["id"], "result": result}
        print(json.dumps(reply), flush=True)
        if method == "close": break
memory = {"resets": 0}
def changed(method, params, result):
    if method == "reset": memory["resets"] += 1
    # FAULT
    return result
run()
)";

std::string simulator_with(const std::string& fault) {
  std::string text = kPlainSimulator;
  const std::string mark = "# FAULT";
  return text.replace(text.find(mark), mark.size(), fault);
}

struct Misbehaviour {
  const char* name;
  const char* fault;  // Python, in `changed`
  const char* check;  // that has to find it
  const char* words;  // of the finding
};

constexpr Misbehaviour kMisbehaviours[] = {
    {"starts elsewhere",
     "if method == 'reset' and result['status'] == 'ok': state['box.x'] += 0.25", "reset",
     "the start asks for `box.x`"},
    {"keeps something of the run before",
     "if method == 'act' and result['status'] == 'ok': state['box.x'] += 0.1 * memory['resets']",
     "determinism", "in one process, after another run"},
    {"has randomness of its own",
     "if method == 'act' and result['status'] == 'ok': state['box.x'] += random.random()", "seeds",
     "the same one gives other results"},
    {"wears out after 90 resets",
     "if method == 'act' and memory['resets'] > 90: state['box.x'] = 0.0", "wear",
     "the first run, made again, gives another result after 120 resets"},
    {"ignores the seed it says to use", "if method == 'reset': rng.seed(1)", "seeds",
     "four seeds give the same result"},
    {"takes any start", "if method == 'reset': result['status'] = 'ok'", "invalid start",
     "a variable that there is not is taken"},
    {"calls an unknown action a failure",
     "if method == 'act' and result['status'] == 'unsupported': result['status'] = 'failed'",
     "unknown", "an unknown action is failed instead of unsupported"},
    {"runs on beyond the limit",
     "if method == 'act' and result['status'] == 'truncated': result.update(status='ok', "
     "sim_time=2.0)",
     "time limit", "ran 2 s with a limit of 1 s"},
    {"tells the time since the reset",
     "if method == 'reset': memory['clock'] = 0.0\n"
     "    if method == 'act': memory['clock'] += result['sim_time']\n"
     "    if method == 'act': result['sim_time'] = memory['clock']",
     "time limit", "looks like a clock since the reset"},
    {"tells the time since it began",
     "if method == 'act': memory['clock'] = memory.get('clock', 0.0) + result['sim_time']\n"
     "    if method == 'act': result['sim_time'] = memory['clock']",
     "time limit", "looks like a clock that no reset puts back"},
    {"takes time for what it says to be timeless",
     "if method == 'hello': result['actions'][0]['instant'] = True", "actions",
     "`push` is said to be `instant`, and took 2 s"},
    {"writes to standard output", "if method == 'act': print('Loading plugin...')", "actions",
     "malformed reply to `act`: the line is not JSON: `Loading plugin...`"},
    {"says NaN",
     "if method == 'observe' and memory['resets'] > 1: result['state']['box.x'] = float('nan')",
     "reset", "NaN and Infinity are no JSON"},
    {"hangs", "if method == 'act': time.sleep(600)", "actions", "no reply to `act` within"},
    {"counts in degrees", "if method == 'observe': result['state']['box.yaw'] = 90.0", "units",
     "are these degrees?"},
    {"dies at its third reset", "if memory['resets'] == 3: os._exit(3)", "reset",
     "it ended during `reset` (exit status 3)"},
    {"stays when it is left alone",
     "if method == 'hello': import atexit; atexit.register(time.sleep, 600)", "end",
     "it does not end within"},
    {"lives on in simulated time between requests",
     "if method == 'observe': state['box.x'] += 0.01", "reset", "time passes between requests"},
    {"works alone only",
     "if method == 'hello' and os.path.exists('lock'): os._exit(4)\n"
     "    if method == 'hello': open('lock', 'w').close()\n"
     "    if method == 'close': os.remove('lock')",
     "determinism", "a second process beside the first one does not work"},
    {"answers with the wrong number",
     "if method == 'act': print(json.dumps({'id': 999, 'result': {}}))", "actions",
     "carries id 999"},
    {"says a status of its own", "if method == 'act': result['status'] = 'done'", "actions",
     "no status `done`"},
    {"does not observe what it declares", "if method == 'observe': del result['state']['box.yaw']",
     "reset", "`box.yaw` is declared and not observed"},
    {"claims to be fast",
     "if method == 'hello': result['min_real_time_factor'] = 100\n"
     "    if method == 'act': time.sleep(0.1)",
     "timing", "says 100 at least"},
    {"names millimetres", "if method == 'hello': result['params'][0]['unit'] = 'mm'", "units",
     "`box.x` is in `mm`"},
    {"floods", "if method == 'act': sys.stdout.write('x' * 3000000); sys.stdout.flush()", "actions",
     "is longer than"},
    {"changes kinds",
     "if method == 'act': state['box.held'] = 1\n"
     "    if method == 'reset': state['box.held'] = False",
     "actions", "now a boolean or text, now a number"}};

constexpr const char* kPerforms =
    "if method == 'hello': result['capabilities'].append('perform')\n"
    "    if method == 'perform':\n"
    "        parts = [(r['method'], r.get('params', {})) for r in params['requests']]\n"
    "        result = {'replies': [{'result': json.loads(json.dumps(answer(*p)))} for p in "
    "parts]}\n";

TEST_CASE("a simulator that takes a run at once is held against its requests one by one") {
  if (skipped_without_python()) return;
  const std::string known = "\"observe\", \"close\")",
                    wider = "\"observe\", \"close\", \"perform\")";
  const auto report_with = [&](const std::string& fault) {
    const CliFixture cli;
    auto text = simulator_with(kPerforms + fault);
    const auto at = text.find(known);
    REQUIRE(at != std::string::npos);
    cli.write("all.py", text.replace(at, known.size(), wider));
    const auto result = cli.parallax(
        {"adapter-check", "--json", "--request-limit", "5", "--", "python3", "-B", "all.py"});
    CAPTURE(result.out);
    REQUIRE(Json::accept(result.out));
    return std::pair(result.code, result.out);
  };
  CHECK(report_with("").first == 0);
  const std::pair<const char*, const char*> faults[] = {
      {"        result['replies'][3]['result']['state']['box.x'] += 0.5\n",
       "`perform` gives another result than its requests one by one: `box.x` after `push`"},
      {"        result['replies'].pop()\n", "`replies` breaks off"},
      {"        result = {}\n", "`replies` is missing"},
      {"        result['replies'][1] = {}\n", "`result` is missing"},
      {"        result['replies'][2]['result']['status'] = 'lost'\n",
       "goes on after an answer that is the last one"}};
  for (const auto& [fault, words] : faults) {
    CAPTURE(fault);
    const auto [code, out] = report_with(fault);
    CHECK(code == 1);
    CHECK(out.find(words) != std::string::npos);
  }
}

std::vector<std::string> check_command(const std::string& file, const char* limit_s = "30") {
  return {"adapter-check", "--request-limit", limit_s, "--", "python3", "-B", file};
}

TEST_CASE("each fault is named by the check that is about it") {
  if (skipped_without_python()) return;
  for (const auto& one : kMisbehaviours) {
    CAPTURE(one.name);
    const CliFixture cli;
    cli.write("bad.py", simulator_with(one.fault));
    auto words = check_command("bad.py", "3");
    words.insert(words.begin() + 1, "--json");
    const auto result = cli.parallax(words);
    CAPTURE(result.out);
    CAPTURE(result.err);
    CHECK(result.code == 1);
    REQUIRE(Json::accept(result.out));
    bool is_named = false;
    const auto report = Json::parse(result.out);
    for (const auto& finding : report.at("findings")) {
      is_named =
          is_named || (finding.at("severity") == "fault" && finding.at("check") == one.check &&
                       finding.at("text").get<std::string>().find(one.words) != std::string::npos);
    }
    CHECK(is_named);
  }
}

TEST_CASE("simulators without a fault are said to have none, and what they support") {
  if (skipped_without_python()) return;
  const PythonFixture python;
  python.write("good.py", simulator_with("pass"));
  for (const auto* file : {"good.py", "kinematic_2d.py"}) {
    CAPTURE(file);
    auto words = check_command(file);
    words.insert(words.begin() + 1, "--json");
    const auto result = python.parallax(words);
    CAPTURE(result.out);
    CHECK(result.code == 0);
    const auto report = Json::parse(result.out);
    CHECK(report.at("findings") == Json::array());
    CHECK(report.at("complete") == true);
    CHECK(report.at("checks").size() == 13);
    for (const auto& check : report.at("checks")) CHECK(check.at("state") == "ok");
    CHECK(report.at("measured").at("determinism") == "bitwise");
    CHECK(report.at("measured").at("largest_start_deviation") == 0.0);
    CHECK(report.at("claims").at("replay") == "bitwise");
    CHECK(report.at("claims").at("several_jobs") == "yes");
  }
  const auto text = python.parallax(check_command("good.py"));
  CHECK(text.out.find("no fault, 0 warnings") != std::string::npos);
}

TEST_CASE(
    "timeless actions need no limit and no word of warning where they are said to be instant") {
  if (skipped_without_python()) return;
  const std::string timeless =
      "if method == 'act': result['sim_time'] = 0.0\n"
      "    if method == 'act' and result['status'] == 'truncated': result['status'] = 'ok'\n";
  const CliFixture cli;
  cli.write("untold.py", simulator_with(timeless));
  const auto untold = cli.parallax(check_command("untold.py"));
  CHECK(untold.code == 0);
  CHECK(untold.out.find("`push` changed something in no simulated time; say `sim_time`, or "
                        "`instant`") != std::string::npos);
  cli.write("told.py",
            simulator_with(timeless +
                           "    if method == 'hello': result['actions'][0]['instant'] = True"));
  const auto told = cli.parallax(check_command("told.py"));
  CAPTURE(told.out);
  CHECK(told.code == 0);
  CHECK(told.out.find("no fault, 0 warnings") != std::string::npos);
  CHECK(told.out.find("every action that was tried is said to be instant") != std::string::npos);
}

TEST_CASE("the built-in simulator keeps the protocol, too") {
  const CliFixture cli;
  const auto program = std::string(PARALLAX_PROGRAM);
  const auto result = cli.parallax(
      {"adapter-check", "--scenario", "scenario.yaml", "--", program, "worker", "scenario.yaml"});
  CAPTURE(result.out);
  CAPTURE(result.err);
  CHECK(result.code == 0);
  CHECK(result.out.find("largest deviation 0") != std::string::npos);
}

TEST_CASE("a start of each initial state of the scenario's trace is tried") {
  const CliFixture cli;
  const auto ward = std::string(PARALLAX_SOURCE_DIR) + "/scenarios/ward/trolley.yaml";
  const std::vector<std::string> check = {"adapter-check",  "--scenario", ward, "--",
                                          PARALLAX_PROGRAM, "worker",     ward};
  const auto result = cli.parallax(check);
  CAPTURE(result.out + result.err);
  CHECK(result.out.find("4 starts of 3 of 3 initial states, largest deviation ") !=
        std::string::npos);
  auto as_json = check;
  as_json.insert(as_json.begin() + 1, "--json");
  const auto report = nlohmann::json::parse(cli.parallax(as_json).out);
  CHECK(report.at("initial_states") == nlohmann::json{{"all", 3}, {"tried", 3}});
}

TEST_CASE("a simulator is held against a scenario") {
  if (skipped_without_python()) return;
  const PythonFixture python;
  const auto fits = python.parallax({"adapter-check", "--scenario", "kinematic_2d.yaml"});
  CAPTURE(fits.out);
  CHECK(fits.code == 0);
  CHECK(fits.err.find("starting `python3 kinematic_2d.py`, as kinematic_2d.yaml:5 says") !=
        std::string::npos);
  python.replace("kinematic_2d.yaml", "body: crate, unless", "body: crat, unless");
  const auto odd = python.parallax({"adapter-check", "--scenario", "kinematic_2d.yaml"});
  CAPTURE(odd.err);
  CHECK(odd.code == 3);
  CHECK(odd.err.find("error[E5115]") != std::string::npos);
}

TEST_CASE("what adapter-check finds in a handshake or an outcome, a run refuses or warns of") {
  if (skipped_without_python()) return;
  // Stands between and changes an answer.
  const std::string between =
      "import json, subprocess, sys\n"
      "child = subprocess.Popen([sys.executable, '-B', 'kinematic_2d.py'], stdin=subprocess.PIPE,\n"
      "                         stdout=subprocess.PIPE, text=True)\n"
      "for line in sys.stdin:\n"
      "    child.stdin.write(line); child.stdin.flush()\n"
      "    asked, reply = json.loads(line), json.loads(child.stdout.readline())\n"
      "    answers = [(asked['method'], reply)]\n"
      "    if asked['method'] == 'perform':\n"
      "        answers = [(one['method'], answer) for one, answer in\n"
      "                   zip(asked['params']['requests'], reply['result']['replies'])]\n"
      "    for method, answer in answers:\n"
      "        result = answer.get('result', {})\n"
      "        # FAULT\n"
      "    print(json.dumps(reply), flush=True)\n"
      "    if asked['method'] == 'close': break\n";
  struct Nonsense {
    const char* fault;
    const char* words;
    bool is_refused;  // else warned of
  };
  const Nonsense all[] = {
      {"if method == 'hello': result['determinism'] = 'total'", "`determinism` is `total`", true},
      {"if method == 'hello': result['params'].append(result['params'][0])", "is declared twice",
       true},
      {"if method == 'act': result['sim_time'] = 1e6", "ran 1e+06 s with a limit of", true},
      {"if method == 'act': result['sim_time'] = -1", "`sim_time` is not within", true},
      {"if method == 'hello': result['capabilities'] = ['telepathy']",
       "`telepathy` is no capability", false}};
  for (const auto& one : all) {
    CAPTURE(std::string(one.fault));
    const PythonFixture python;
    auto text = between;
    python.write("odd.py", text.replace(text.find("# FAULT"), 7, one.fault));
    python.write("odd.yaml",
                 "include: kinematic_2d.yaml\nsimulator: {command: [python3, -B, odd.py]}\n");
    const auto checked = python.parallax({"adapter-check", "--scenario", "odd.yaml"});
    CAPTURE(checked.out);
    CHECK(checked.out.find(one.words) != std::string::npos);
    const auto ran =
        python.parallax({"run", "odd.yaml", "--allow-commands", "--max-runs", "2", "--out", "out"});
    CAPTURE(ran.err);
    CAPTURE(ran.out);
    // An error in an act makes a lost run, whose reason is in the journal.
    const bool is_told = ran.err.find(one.words) != std::string::npos;
    const bool is_lost =
        python.read("out/journal.ndjson").find(one.words) != std::string::npos && ran.code == 4;
    CHECK((is_told || is_lost));
    CHECK((ran.err.find("W7177") == std::string::npos) == one.is_refused);
    if (one.is_refused && !is_lost) CHECK(ran.out.empty());
    if (is_lost) CHECK(ran.out.find("0 clean of 2, 2 lost") != std::string::npos);
  }
}

bool is_there(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  const auto end = text.rfind(") ");
  return end != std::string::npos && text[end + 2] != 'Z' && text[end + 2] != 'X';
}

TEST_CASE("nothing that a simulator starts is left behind") {
  if (skipped_without_python()) return;
  const CliFixture cli;
  cli.write("forks.py",
            simulator_with("if method == 'hello' and os.fork() == 0:\n"
                           "        os.setsid()\n"
                           "        print(os.getpid(), file=open('pids', 'a'), flush=True)\n"
                           "        time.sleep(600)\n"));
  CHECK(cli.parallax(check_command("forks.py")).code == 0);
  std::ifstream pids(cli.folder() / "pids");
  int count = 0;
  for (pid_t pid = 0; pids >> pid; ++count) {
    for (int wait = 0; is_there(pid) && wait < 500; ++wait) ::usleep(10'000);
    CHECK_FALSE(is_there(pid));
    if (is_there(pid)) ::kill(pid, SIGKILL);
  }
  CHECK(count >= 1);  // others may end before they have written
}

TEST_CASE("a command line that asks for nothing, or for what there is not") {
  const CliFixture cli;
  const auto code = [&](const std::vector<std::string>& words) { return cli.parallax(words).code; };
  CHECK(code({"adapter-check"}) == 2);
  CHECK(code({"adapter-check", "--scenario", "scenario.yaml"}) == 2);  // it names no command
  CHECK(code({"adapter-check", "--act", "push by", "--", "true"}) == 2);
  CHECK(code({"adapter-check", "--act", " ", "--", "true"}) == 2);
  CHECK(code({"adapter-check", "--scenario", "nothing.yaml"}) == 2);
  const auto silent = cli.parallax({"adapter-check", "--", "true"});
  CHECK(silent.code == 1);
  CHECK(silent.out.find("it ended during `hello` (exit status 0)") != std::string::npos);
  const auto absent = cli.parallax({"adapter-check", "--", "no-such-program"});
  CHECK(absent.code == 1);
  CHECK(absent.out.find("cannot start `no-such-program`") != std::string::npos);
}

}  // namespace
}  // namespace parallax::test
