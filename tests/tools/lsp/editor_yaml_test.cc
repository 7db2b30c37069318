// Keys of scenarios and worlds: completion, hover and units.

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "tests/tools/lsp/editor_desk.h"

namespace parallax::test {
namespace {

using Json = EditorClient::Json;

/// The label and detail of keys and values that are offered at `|` in a text that is typed.
std::map<std::string, std::string> offered(Desk& desk, std::string text) {
  static int version = 0;
  const auto place = text.find('|');
  text.erase(place, 1);
  desk.write("typed.yaml", "");
  desk.editor.open(desk.path("typed.yaml"), text, ++version);
  auto at = desk.document("typed.yaml");
  at["position"] = place_in(text, place);
  std::map<std::string, std::string> out;
  const auto answer = desk.editor.ask("textDocument/completion", at);
  for (const auto& item : answer["items"]) {
    // Properties and members of enumerations; the rest are names of the model.
    if (item["kind"] == 10 || item["kind"] == 20)
      out[item["label"].get<std::string>()] = item["detail"].get<std::string>();
  }
  return out;
}

TEST_CASE("keys that may stand at a place are offered with type, range and unit") {
  Desk desk;
  auto keys = offered(desk, "model: domain.e\nsampling:\n  |\n");
  CHECK(keys.at("inset_m") == "number, >= 0, in m");
  CHECK(keys.contains("variables"));
  CHECK(!keys.contains("model"));
  keys = offered(desk, "model: domain.e\nhor|\n");
  CHECK(keys.at("horizon") == "integer, >= 0, <= 1000000");
  CHECK(!keys.contains("model"));  // it stands there already
  keys = offered(
      desk,
      "world:\n  bodies:\n    box:\n      shapes:\n        - size_m: [1, 1, 1]\n          |\n");
  CHECK(keys.at("yaw_rad") == "number, in rad");
  CHECK(!keys.contains("size_m"));
  // Brackets that are not closed, and what follows them.
  keys = offered(desk, "model: domain.e\nexpect: {verdict: discrepancy, |\nhorizon: 6\n");
  CHECK(keys.at("time_limit_s") == "number, > 0, <= 86400, in s");
  CHECK(!keys.contains("verdict"));
  CHECK(!keys.contains("horizon"));
  keys = offered(desk, "model: domain.e\nexpect:\n  rate: {between: [0.2, 0.4], co|}\n");
  CHECK(keys.at("confidence") == "number, >= 0.5, <= 0.999999");
  // A world of its own.
  keys = offered(desk, "friction:\n  default: 0.5\nsolver:\n  gr|\n");
  CHECK(keys.at("gravity_m_s2") == "list of 3: number, in m/s^2");
  CHECK(keys.at("timestep_s") == "number, > 0, in s");
  CHECK(offered(desk, "model: domain.e\nname: |\n").empty());
}

TEST_CASE("the words that a value can be are offered") {
  Desk desk;
  const auto words = [&](const std::string& text) {
    std::set<std::string> out;
    for (const auto& [word, detail] : offered(desk, text)) out.insert(word);
    return out;
  };
  CHECK(words("model: domain.e\nexpect:\n  verdict: |\n") ==
        std::set<std::string>{"discrepancy", "inconclusive", "no-discrepancy"});
  CHECK(words("model: domain.e\nexpect: {verdict: no|}\n") ==
        std::set<std::string>{"discrepancy", "inconclusive", "no-discrepancy"});
  CHECK(words("world:\n  solver:\n    resting_joints: |\n") ==
        std::set<std::string>{"false", "true"});
}

TEST_CASE("hover says what a key takes, and of a fluent its declaration") {
  Desk desk;
  const auto hover = [&](const std::string& file, const std::string& word) {
    const auto answer = desk.editor.ask("textDocument/hover", desk.at(file, word));
    return answer.is_null() ? "" : answer["contents"]["value"].get<std::string>();
  };
  desk.open("common.yaml");
  CHECK(hover("common.yaml", "time_limit_s") == "`time_limit_s`: number, > 0, <= 86400, in s");
  CHECK(hover("common.yaml", "RobotIn(region)").find("fluent RobotIn(region)") !=
        std::string::npos);
  desk.open("world.yaml");
  CHECK(hover("world.yaml", "max_force_n") == "`max_force_n`: number, >= 0, in N");
  CHECK(hover("world.yaml", "mass_kg") == "`mass_kg`: number, >= 0, in kg");
  CHECK(hover("world.yaml", "grip_force_n").find("in N") != std::string::npos);
}

TEST_CASE("numbers whose keys say no unit have it behind them") {
  Desk desk;
  desk.open("common.yaml");
  auto params = desk.document("common.yaml");
  params["range"] = {{"start", {{"line", 0}, {"character", 0}}},
                     {"end", {{"line", 1000}, {"character", 0}}}};
  const auto text = desk.read("common.yaml");
  std::vector<std::string> lines = {""};
  for (const char c : text) {
    if (c == '\n')
      lines.emplace_back();
    else
      lines.back() += c;
  }
  std::set<std::string> hints;
  for (const auto& hint : desk.editor.ask("textDocument/inlayHint", params)) {
    const auto& line = lines.at(hint["position"]["line"].get<std::size_t>());
    hints.insert(line.substr(0, hint["position"]["character"].get<std::size_t>()) + " " +
                 hint["label"].get<std::string>());
  }
  CHECK(hints == std::set<std::string>{"    r1: {x: [0, 1] m", "    r2: {x: [1, 2] m",
                                       "    box.y: 0 m", "    box.yaw: 0 rad"});
  params["range"]["end"]["line"] = 3;
  CHECK(desk.editor.ask("textDocument/inlayHint", params).empty());
}

TEST_CASE("half-typed scenarios of all kinds are answered") {
  Desk desk;
  const auto whole =
      desk.read("common.yaml") + desk.read("scenario.yaml") + desk.read("world.yaml");
  for (std::size_t length = 0; length < whole.size(); length += 37) {
    const auto text = whole.substr(0, length);
    auto keys = offered(desk, text + "|");
    keys = offered(desk, text + "\n  |\n" + whole.substr(length));
  }
  const char* texts[] = {"{",  "[",          "- ", "-",     "- - -", "a: {b: [", "'",
                         "\"", "a: |\n x\n", "? ", "{,,,:", "}",     "]"};
  for (const std::string text : texts) {
    CAPTURE(text);
    CHECK(offered(desk, text + "|").size() < 100);
  }
}

}  // namespace
}  // namespace parallax::test
