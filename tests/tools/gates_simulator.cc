// A simulator of gates and a way through them: gates_simulator LOST WRONG. An action is lost if
// LOST gates are shut at the start, and does not get through if WRONG gates are; a number that no
// start has means never. Shares no code with the harness.

#include <cstdlib>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

int main(int argc, char** argv) {
  using Json = nlohmann::json;
  if (argc < 3) return 2;
  const int lost = std::atoi(argv[1]), wrong = std::atoi(argv[2]);
  Json state;
  int shut = 0;
  for (std::string line; std::getline(std::cin, line);) {
    const auto request = Json::parse(line);
    const std::string method = request.at("method");
    Json result = {{"status", "ok"}};
    if (method == "hello") {
      result = {{"protocol", 1},           {"name", "gates"},          {"version", "1"},
                {"seeds", true},           {"determinism", "bitwise"}, {"time_step", 0.01},
                {"params", Json::array()}, {"actions", Json::array()}};
    } else if (method == "reset") {
      state = {{"There()", false}, {"Waved()", false}, {"Lit()", false}};
      shut = 0;
      for (const auto& [name, value] : request.at("params").at("state").items()) {
        state[name] = value == 1;
        shut += value == 1 ? 1 : 0;
      }
    } else if (method == "act") {
      const bool goes = request.at("params").at("action") == "go";
      result["sim_time"] = 1.0;
      if (!goes) state["Waved()"] = true;
      if (goes && shut != wrong) state["There()"] = true;
      if (goes && shut == lost) result = {{"status", "lost"}, {"reason", "the gates jammed"}};
    } else if (method == "observe") {
      result = {{"state", state}};
    }
    std::cout << Json{{"id", request.at("id")}, {"result", result}}.dump() << std::endl;
    if (method == "close") return 0;
  }
  return 0;
}
