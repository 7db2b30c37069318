// A simulator behind the protocol whose discrepancies are known: it lifts a box, then pushes it
// from its region into the next. Each argument is a rule, KIND:CONDITION,CONDITION...: where all of
// its conditions hold (`cup.a>0.7`, `cup.a+cup.b<1`, `seed%3`, `run%2`), it does what its kind
// says:
//
//     fails        the push leaves the box where it is
//     otherwise    the lift does not lift
//     refuses      the start is invalid
//     loses        the process ends in the push
//
//     drifts       the box is seen a little farther away in each run
//
// `unseeded` and `loose` change what it says of itself. It shares no code with the harness.

#include <unistd.h>

#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Json = nlohmann::json;

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, at);) out.push_back(part);
  return out;
}

class World {
 public:
  explicit World(std::vector<std::string> rules) : rules_(std::move(rules)) {}

  Json hello() const {
    const auto is = [&](const char* word) {
      for (const auto& rule : rules_) {
        if (rule == word) return true;
      }
      return false;
    };
    Json params = Json::array();
    for (const auto* name : {"box.x", "cup.a", "cup.b", "cup.c", "cup.d"}) {
      params.push_back({{"name", name}, {"unit", "m"}, {"settable", true}});
    }
    params.push_back({{"name", "box.up"}, {"unit", "1"}, {"settable", false}});
    return {{"protocol", 1},
            {"name", "border"},
            {"version", "1"},
            {"determinism", is("loose") || is("unseeded") ? "none" : "bitwise"},
            {"seeds", !is("unseeded")},
            {"time_step", 0.01},
            {"params", params},
            {"actions", {"lift", "push"}}};
  }

  Json reset(const Json& params) {
    state_.clear();
    for (const auto& [name, value] : params.at("state").items()) {
      state_[name] = value.get<double>();
    }
    seed_ = params.at("seed").get<std::uint64_t>();
    // A worker process simulates many starts: runs are counted over all of them.
    std::ifstream counted("runs");
    counted >> runs_;
    std::ofstream("runs") << ++runs_;
    up_ = false;
    if (holds("refuses")) return {{"status", "invalid_start"}, {"reason", "box and wall: 3 mm"}};
    return {{"status", "ok"}, {"sim_time", 0.0}};
  }

  Json act(const std::string& action) {
    if (action == "lift") {
      up_ = !holds("otherwise");
    } else if (holds("loses")) {
      ::_exit(3);
    } else if (!holds("fails")) {
      state_["box.x"] = 0.5;
    }
    return {{"status", "ok"}, {"sim_time", 1.0}};
  }

  Json observe() const {
    Json state = {{"box.up", up_}};
    for (const auto& [name, value] : state_) state[name] = value;
    if (holds("drifts")) state["box.x"] = state_.at("box.x") + 1e-9 * static_cast<double>(runs_);
    return {{"state", state}};
  }

 private:
  bool holds(const std::string& kind) const {
    for (const auto& rule : rules_) {
      const auto colon = rule.find(':');
      if (rule.substr(0, colon) != kind) continue;
      bool all = true;
      for (const auto& condition : split(rule.substr(colon + 1), ','))
        all = all && is_so(condition);
      if (all) return true;
    }
    return false;
  }

  bool is_so(const std::string& condition) const {
    if (condition == "always") return true;
    if (const auto at = condition.find('%'); at != std::string::npos) {
      const auto number = condition.substr(0, at) == "seed" ? seed_ : runs_;
      return number % std::stoull(condition.substr(at + 1)) == 0;
    }
    const auto at = condition.find_first_of("<>");
    double sum = 0.0;
    for (const auto& name : split(condition.substr(0, at), '+')) sum += state_.at(name);
    const double border = std::stod(condition.substr(at + 1));
    return condition[at] == '>' ? sum > border : sum < border;
  }

  std::vector<std::string> rules_;
  std::map<std::string, double> state_;
  std::uint64_t seed_ = 0, runs_ = 0;
  bool up_ = false;
};

}  // namespace

int main(int argc, char** argv) {
  World world({argv + 1, argv + argc});
  for (std::string line; std::getline(std::cin, line);) {
    const auto request = Json::parse(line);
    const auto method = request.at("method").get<std::string>();
    Json result = {{"status", "ok"}};
    if (method == "hello") result = world.hello();
    if (method == "reset") result = world.reset(request.at("params"));
    if (method == "act") result = world.act(request.at("params").at("action"));
    if (method == "observe") result = world.observe();
    std::cout << Json{{"id", request.at("id")}, {"result", result}}.dump() << std::endl;
    if (method == "close") return 0;
  }
  return 0;
}
