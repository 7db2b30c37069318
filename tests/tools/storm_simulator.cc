// A simulator that fails in every way that a process can, for about half of its starts. The start
// decides the fault, which is written to the file of the first argument before it happens. It
// shares no code with the harness.

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

using Json = nlohmann::json;

constexpr const char* kFaults[] = {"abort", "segfault", "exit",   "flood", "not-finite",
                                   "noise", "wrong-id", "orphan", "sleep", "growth"};

/// splitmix64 of the bits of the start: which fault, at which request, or none.
std::uint64_t mixed(double start) {
  std::uint64_t x = 0;
  std::memcpy(&x, &start, sizeof x);
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

struct Fault {
  std::string kind;  // empty: none
  std::string method;
};

Fault fault_of(double start) {
  const auto x = mixed(start);
  // Those that take their time are rarer: 1 of 50 starts each; of the others 6 of 100.
  const auto place = x % 100;
  Fault fault;
  if (place < 48) fault.kind = kFaults[place / 6];
  if (place == 50 || place == 51) fault.kind = "sleep";
  if (place == 60 || place == 61) fault.kind = "growth";
  constexpr const char* kMethods[] = {"reset", "act", "observe"};
  fault.method = kMethods[(x >> 32U) % 3];
  return fault;
}

void note(const char* file, const std::string& line) {
  const int log = ::open(file, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
  const auto text = line + '\n';
  if (log < 0 || ::write(log, text.data(), text.size()) < 0) ::_exit(99);
  ::close(log);
}

[[noreturn]] void hang() {
  for (;;) ::pause();
}

/// Comes back where a reply still follows.
void misbehave(const std::string& kind, const char* log) {
  if (kind == "abort") std::abort();
  if (kind == "segfault") ::raise(SIGSEGV);
  if (kind == "exit") ::_exit(7);
  if (kind == "sleep") hang();
  if (kind == "noise") std::cout << "Loading plugin...\n" << std::flush;
  if (kind == "wrong-id") std::cout << R"({"id":999,"result":{"status":"ok"}})" << '\n';
  if (kind == "flood") {
    for (int i = 0; i < 40000; ++i) std::cout << std::string(64, 'x');
    std::cout << std::flush;
    hang();
  }
  if (kind == "growth") {
    std::vector<std::vector<char>> held;
    for (int mebibytes = 0; mebibytes < 300; ++mebibytes) held.emplace_back(1U << 20U, 'x');
    hang();
  }
  if (kind == "orphan") {
    const pid_t child = ::fork();
    if (child == 0) {
      ::setsid();
      hang();
    }
    // Who is ended before it left the group was never an orphan: wait until it has left.
    while (::getsid(child) != child) ::usleep(100);
    note(log, "process " + std::to_string(child));
    ::_exit(9);
  }
}

Json result_of(const std::string& method, Json& state) {
  if (method == "hello") {
    return {{"protocol", 1},           {"name", "storm"},         {"version", "1"},
            {"seeds", false},          {"determinism", "none"},   {"time_step", 0.01},
            {"params", Json::array()}, {"actions", Json::array()}};
  }
  if (method == "act") {
    state["box.x"] = 0.5;
    return {{"status", "ok"}, {"sim_time", 1.0}};
  }
  if (method == "observe") return {{"state", state}};
  if (method == "reset") return {{"status", "ok"}};
  return Json::object();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return 2;
  Fault fault;
  Json state;
  std::string line;
  while (std::getline(std::cin, line)) {
    const auto request = Json::parse(line);
    const std::string method = request.at("method");
    if (method == "reset") {
      state = request.at("params").at("state");
      const double start = state.at("box.x");
      fault = fault_of(start);
      if (!fault.kind.empty()) {
        char text[64];
        std::snprintf(text, sizeof text, "fault %s %.17g", fault.kind.c_str(), start);
        note(argv[1], text);
      }
    }
    const bool now = !fault.kind.empty() && method == fault.method;
    if (now) misbehave(fault.kind, argv[1]);
    if (now && fault.kind == "not-finite") {
      std::cout << R"({"id":)" << request.at("id") << R"(,"result":{"status":"ok","sim_time":NaN,)"
                << R"("state":{"box.x":NaN}}})" << std::endl;
      continue;
    }
    const Json reply = {{"id", request.at("id")}, {"result", result_of(method, state)}};
    std::cout << reply.dump() << std::endl;
    if (method == "close") return 0;
  }
  return 0;
}
