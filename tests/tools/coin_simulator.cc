// A simulator that shows a discrepancy with a known probability: coin_simulator P KIND LOG. With
// the kind `seeded` the seed decides, and it says so; with `unseeded` the machine does, and runs
// that go wrong take longer. An action takes COIN_SECONDS besides. Each reset is written to LOG
// with the number of its process. Its stated version is COIN_VERSION. After COIN_WEAR resets of a
// process all of its runs go wrong. Shares no code with the harness.

#include <fcntl.h>
#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace {

using Json = nlohmann::json;

constexpr useconds_t kSlow = 60'000;

/// splitmix64, as a number from 0 to 1.
double drawn_from(std::uint64_t seed) {
  std::uint64_t x = seed + 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return static_cast<double>((x ^ (x >> 31U)) >> 11U) * 0x1p-53;
}

void note(const char* file, const std::string& line) {
  const int log = ::open(file, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600);
  const auto text = line + '\n';
  if (log < 0 || ::write(log, text.data(), text.size()) < 0) ::_exit(99);
  ::close(log);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const double p = std::atof(argv[1]);
  const bool seeded = std::string(argv[2]) == "seeded";
  const char* version = std::getenv("COIN_VERSION");
  const char* seconds = std::getenv("COIN_SECONDS");
  const char* wear = std::getenv("COIN_WEAR");
  int resets = 0;
  std::random_device machine;
  Json state;
  bool goes_wrong = false;
  for (std::string line; std::getline(std::cin, line);) {
    const auto request = Json::parse(line);
    const std::string method = request.at("method");
    Json result = Json::object();
    if (method == "hello") {
      result = {{"protocol", 1},
                {"name", "coin"},
                {"version", version == nullptr ? "1" : version},
                {"seeds", seeded},
                {"determinism", seeded ? "bitwise" : "none"},
                {"time_step", 0.01},
                {"params", Json::array()},
                {"actions", Json::array()}};
    } else if (method == "reset") {
      note(argv[3], "reset " + std::to_string(::getpid()));
      state = request.at("params").at("state");
      const auto seed = seeded ? request.at("params").at("seed").get<std::uint64_t>()
                               : (std::uint64_t{machine()} << 32U) + machine();
      goes_wrong = drawn_from(seed) < p || (wear != nullptr && ++resets > std::atoi(wear));
      result = {{"status", "ok"}};
    } else if (method == "act") {
      if (goes_wrong && !seeded) ::usleep(kSlow);
      if (seconds != nullptr) ::sleep(static_cast<unsigned>(std::atoi(seconds)));
      if (!goes_wrong) state["box.x"] = 0.5;
      result = {{"status", "ok"}, {"sim_time", 1.0}};
    } else if (method == "observe") {
      result = {{"state", state}};
    }
    std::cout << Json{{"id", request.at("id")}, {"result", result}}.dump() << std::endl;
    if (method == "close") return 0;
  }
  return 0;
}
