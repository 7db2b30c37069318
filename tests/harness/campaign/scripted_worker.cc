// A child process for the tests of ProcessSimulator. The first argument says how it behaves:
// answer, refuse, or how and when it fails. It shares no code with the harness.

#include <signal.h>
#include <unistd.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

using Json = nlohmann::json;

[[noreturn]] void hang() {
  for (;;) ::pause();
}

/// Fails as the mode says, when it is its turn; comes back if it is not.
void misbehave(const std::string& mode, const std::string& method, int count) {
  if (mode == method + "-crash") {
    std::cerr << "first line\nassertion failed: x < y" << std::endl;
    ::raise(SIGKILL);
  }
  if (mode == method + "-exit") ::_exit(7);
  if (mode == method + "-hang") hang();
  if (mode == method + "-stubborn") {
    ::signal(SIGTERM, SIG_IGN);
    hang();
  }
  if (mode == method + "-hog") {
    std::vector<std::vector<char>> held;
    for (int mebibytes = 0; mebibytes < 512; ++mebibytes) held.emplace_back(1U << 20U, 'x');
    hang();
  }
  if (mode == method + "-hog-child") {
    if (::fork() == 0) misbehave(method + "-hog", method, count);
    hang();
  }
  if (mode == method + "-garbage") std::cout << "Loading plugin...\n" << std::flush;
  if (mode == method + "-endless") {
    for (int i = 0; i < 40000; ++i) std::cout << std::string(64, 'x');
    std::cout << std::flush;
    hang();
  }
  if (mode == method + "-wrong-id") std::cout << R"({"id":999,"result":{"status":"ok"}})" << '\n';
  if (mode == "third-act-crash" && method == "act" && count == 3) ::raise(SIGSEGV);
  if (mode == "chatty" && method == "act") {
    for (int i = 0; i < 100000; ++i) std::cerr << "log line " << i << '\n';
  }
}

/// The bodies that a simulator with poses reports.
Json bodies() {
  return {{"bodies",
           {{{"name", "table"}, {"shapes", {{{"box", {1, 1, 0.1}}}}}},
            {{"name", "robot"}, {"kind", "robot"}, {"moves", true}},
            {{"name", "cup"},
             {"kind", "item"},
             {"moves", true},
             {"shapes", {{{"cylinder", {0.04, 0.1}}}}}}}},
          {"grippers", {"hand"}}};
}

/// The robot goes along x at 1 m/s, and takes the cup with it from 0.5 s on.
Json frames(const std::string& mode, double from_s, double to_s, double step_s) {
  Json out = Json::array();
  for (int i = 0; from_s + i * step_s < to_s + 1e-9; ++i) {
    const double t = from_s + i * step_s;
    const double cup = t < 0.5 ? 0.5 : t;
    Json frame = {{"t", t},
                  {"bodies", {{"robot", {t, 0.0, 0.0}}, {"cup", {cup, 0, 1, 1, 0, 0, 0}}}}};
    if (t >= 0.5) frame["held"] = {{"cup", "hand"}};
    if (t > 0.7 && t < 1.0) {
      if (mode == "poses-unknown") frame["bodies"]["ghost"] = {0, 0, 0};
      if (mode == "poses-static") frame["bodies"]["table"] = {0, 0, 0};
      if (mode == "poses-far") frame["bodies"]["cup"] = {1e9, 0, 0};
      if (mode == "poses-unturned") frame["bodies"]["cup"] = {0, 0, 0, 0, 0, 0, 0};
      if (mode == "poses-short") frame["bodies"]["cup"] = {0, 0};
      if (mode == "poses-words") frame["bodies"]["cup"] = {"a", "b", "c"};
      if (mode == "poses-back") frame["t"] = 0.01;
      if (mode == "poses-late") frame["t"] = 1e300;
      if (mode == "poses-hand") frame["held"] = {{"cup", "foot"}};
      if (mode == "poses-no-time") frame.erase("t");
    }
    out.push_back(std::move(frame));
  }
  return out;
}

Json reply_to(const std::string& mode, const std::string& method, const Json& params) {
  static Json state = Json::object();
  static int resets = 0;
  static bool asked = false;
  const bool has_poses = mode.starts_with("poses");
  if (method == "hello") {
    Json hello = {{"protocol", 1},           {"name", "scripted"},
                  {"version", "2"},          {"determinism", "bitwise"},
                  {"seeds", true},           {"time_step", 0.01},
                  {"params", Json::array()}, {"actions", Json::array()}};
    if (has_poses) hello["pose"] = bodies();
    if (mode == "poses-wrong-scene") hello["pose"] = {{"bodies", 3}};
    return hello;
  }
  if (method == "reset") {
    if (mode == "invalid") return {{"status", "invalid_start"}, {"reason", "box overlaps counter"}};
    state = params.at("state");
    state["resets"] = ++resets;
    state["pid"] = static_cast<long>(::getpid());
    state["session"] = static_cast<long>(::getsid(0));
    Json result = {{"status", "ok"}};
    asked = params.contains("pose_interval");
    if (has_poses && asked) result["poses"] = frames(mode, 0.0, 0.0, 0.1);
    if (mode == "poses-partial") result["poses"][0]["bodies"].erase("cup");
    return result;
  }
  if (method == "act") {
    state["robot.x"] = 0.1;
    Json result = {{"status", "failed"}, {"reason", "blocked"}, {"sim_time", 1.5}};
    if (!has_poses || !asked) return result;
    result["poses"] = frames(mode, 0.1, 1.5, mode == "poses-fast" ? 0.001 : 0.1);
    if (mode == "poses-no-list") result["poses"] = "here";
    if (mode == "poses-no-base64") result["motion"] = "*";
    if (mode == "poses-both") result["motion"] = "AAAA";
    return result;
  }
  return {{"state", state}};
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "answer";
  if (mode == "dies") {
    std::cerr << "no licence" << std::endl;
    return 3;
  }
  int acts = 0;
  std::string line;
  while (std::getline(std::cin, line)) {
    const auto request = Json::parse(line);
    const std::string method = request.at("method");
    if (method == "act") ++acts;
    misbehave(mode, method, acts);
    Json reply = {{"id", request.at("id")}};
    if (mode == "refuse" && method == "act") {
      reply["error"] = {{"code", "unsupported"}, {"message", "no action `fly`"}};
    } else if (mode == "nan" && method == "observe") {
      reply["error"] = {{"code", "not_finite"}, {"message", "`box.x` is not finite"}};
    } else {
      reply["result"] = method == "close" ? Json::object()
                                          : reply_to(mode, method, request.value("params", Json()));
    }
    std::cout << reply.dump() << std::endl;
    if (method == "close") return 0;
  }
  return 0;
}
