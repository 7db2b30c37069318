#pragma once

#include <doctest/doctest.h>

#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"
#include "tests/tools/cli_json.h"

namespace parallax::test {

using Json = nlohmann::json;
using Words = std::vector<std::string>;

inline constexpr const char* kDomain = R"dec(range time 0 2
sort region
region goal, start
fluent BoxIn(region)
fluent Up()
event Lift()
event Push()
completion Happens
[time] Initiates(Lift(),Up(),time).
[time] Initiates(Push(),BoxIn(goal),time).
[time] Terminates(Push(),BoxIn(start),time).
HoldsAt(BoxIn(start),0).
!HoldsAt(BoxIn(goal),0).
!HoldsAt(Up(),0).
Happens(Lift(),0).
Happens(Push(),1).
)dec";

inline constexpr const char* kScenario = R"yaml(
horizon: 2
constraints: "HoldsAt(BoxIn(goal),time)"
regions: {cells: {goal: {x: [0, 1]}, start: {x: [3, 4]}}, gaps: allowed}
mapping:
  BoxIn(region): {inside: region, body: box}
  Up(): {flag: box.up}
actions:
  Lift(): {controller: lift}
  Push(): {controller: push}
sampling:
  inset_m: 0
  variables: {cup.a: [0, 1], cup.b: [-10, 10], cup.c: [0, 1], cup.d: 0.25}
)yaml";

inline bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// A world that goes wrong by rules (border_worker.cc), and a run of it in `out`.
class BorderWorld : public CliFixture {
 public:
  explicit BorderWorld(const Words& rules, int code = 1, const Words& more = {}) {
    write("domain.e", kDomain);
    write("s.yaml", "model: domain.e\nsimulator: {command: [" +
                        Json(PARALLAX_BORDER_WORKER).dump() + words(rules) + "]}" + kScenario);
    Words run = {"run", "s.yaml", "--out", "out"};
    run.insert(run.end(), more.begin(), more.end());
    const auto ran = parallax(run);
    CAPTURE(ran.err);
    REQUIRE(ran.code == code);
  }

  Json confirm(int code, const Words& more = {}) const {
    return tell({"confirm", "out"}, more, code);
  }
  Json threshold(const std::string& parameter, int code = 0, const Words& more = {}) const {
    return tell({"threshold", "out", "--parameter", parameter}, more, code);
  }
  /// The simulator may be writing it.
  std::int64_t runs() const { return std::strtoll(read("runs").c_str(), nullptr, 10); }

 private:
  static std::string words(const Words& rules) {
    std::string out;
    for (const auto& rule : rules) out += ", " + Json(rule).dump();
    return out;
  }
  Json tell(Words command, const Words& more, int code) const {
    command.insert(command.end(), more.begin(), more.end());
    command.emplace_back("--allow-commands");
    return json_of(*this, command, code);
  }
};

}  // namespace parallax::test
