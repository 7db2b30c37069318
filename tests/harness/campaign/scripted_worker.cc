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

Json reply_to(const std::string& mode, const std::string& method, const Json& params) {
  static Json state = Json::object();
  static int resets = 0;
  if (method == "hello") {
    return {{"protocol", 1},           {"name", "scripted"},
            {"version", "2"},          {"determinism", "bitwise"},
            {"seeds", true},           {"time_step", 0.01},
            {"params", Json::array()}, {"actions", Json::array()}};
  }
  if (method == "reset") {
    if (mode == "invalid") return {{"status", "invalid_start"}, {"reason", "box overlaps counter"}};
    state = params.at("state");
    state["resets"] = ++resets;
    state["pid"] = static_cast<long>(::getpid());
    state["session"] = static_cast<long>(::getsid(0));
    return {{"status", "ok"}};
  }
  if (method == "act") {
    state["robot.x"] = 0.1;
    return {{"status", "failed"}, {"reason", "blocked"}, {"sim_time", 1.5}};
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
