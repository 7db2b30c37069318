// MuJoCo, through its C API in a program of C++, behind the protocol.

#include <doctest/doctest.h>

#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;

const std::string kAdapter = PARALLAX_MUJOCO_ADAPTER;
const std::string kMujocoWorld =
    std::string(PARALLAX_SOURCE_DIR) + "/tools/adapters/cpp/mujoco_pusher.xml";

bool no_mujoco() {
  if (!kAdapter.empty() && std::filesystem::exists(kAdapter)) return false;
  std::cout << "SKIPPED: libmujoco-dev was not there when this was built\n";
  return true;
}

Json checked(const CliFixture& cli, std::vector<std::string> words, int code) {
  words.insert(words.begin(), {"adapter-check", "--json"});
  words.insert(words.end(), {"--", kAdapter, kMujocoWorld});
  const auto result = cli.parallax(words);
  CAPTURE(result.out);
  CAPTURE(result.err);
  CHECK(result.code == code);
  REQUIRE(Json::accept(result.out));
  return Json::parse(result.out);
}

TEST_CASE("a world in MuJoCo keeps the protocol, bit by bit, with noise of the seed") {
  if (no_mujoco()) return;
  const CliFixture cli;
  const auto report = checked(cli, {}, 0);
  CHECK(report.at("findings") == Json::array());
  CHECK(report.at("complete") == true);
  CHECK(report.at("measured").at("determinism") == "bitwise");
  CHECK(report.at("measured").at("largest_start_deviation") == 0.0);
  CHECK(report.at("claims").at("several_jobs") == "yes");
  CHECK(report.at("claims").at("search").get<std::string>().starts_with("yes"));
  CHECK(report.at("claims").at("recordings").get<std::string>().starts_with("yes"));
}

TEST_CASE("what happens in MuJoCo is judged: a box that is pushed far enough, and a wall") {
  if (no_mujoco()) return;
  const CliFixture cli;
  cli.write("one.e",
            "sort region\nregion near, far\nfluent In(region)\nevent Go(region)\n"
            "[time] {region} HoldsAt(In(region),time).\n"
            "[region1,region2,time] HoldsAt(In(region1),time) & HoldsAt(In(region2),time) -> "
            "region1=region2.\n"
            "[region,time] Initiates(Go(region),In(region),time).\n"
            "[region1,region2,time] region1!=region2 -> Terminates(Go(region1),In(region2),time).\n"
            "HoldsAt(In(near),0).\nHappens(Go(far),0).\n!Happens(Go(near),0).\n");
  const auto count = [&](const std::string& border, const std::string& target) {
    cli.write("one.yaml",
              "model: one.e\nhorizon: 1\nconstraints: [\"HoldsAt(In(far),time)\"]\nsimulator: "
              "{command: [\"" +
                  kAdapter + "\", \"" + kMujocoWorld + "\"]}\nregions: {cells: {near: {x: [0.2, " +
                  border + "], start: {x: [0.2, 0.9]}}, far: {x: [" + border +
                  ", 4]}}}\nmapping: {In(region): {inside: region, body: box}}\n"
                  "actions: {Go(region): {controller: push, target.x: " +
                  target + "}}\n");
    const auto result = cli.parallax({"rates", "one.yaml", "--runs", "8", "--jobs", "2", "--json"});
    CAPTURE(result.out);
    CAPTURE(result.err);
    REQUIRE(Json::accept(result.out));
    return Json::parse(result.out).at("traces").at(0).at("any").at("count").get<int>();
  };
  CHECK(count("1", "1.5") == 0);
  // The wall begins at 2.18 m, so the middle of the box stays below 2.13 m.
  CHECK(count("2.14", "2.4") == 8);
  CHECK(count("2.1", "2.4") == 0);
}

}  // namespace
}  // namespace parallax::test
