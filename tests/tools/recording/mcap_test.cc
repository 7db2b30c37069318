// Recordings exported for other programs, read by another program.

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/tools/cli_fixture.h"
#include "tests/tools/recording/csv_rows.h"

namespace parallax::test {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

TEST_CASE("an export in MCAP is read by the reader of the format's authors") {
  const fs::path modules = fs::path(PARALLAX_SOURCE_DIR) / "build/browser/node_modules";
  if (!fs::exists(modules / "@mcap/core")) {
    std::puts("SKIPPED: no @mcap/core; `tools/setup --browser` installs it where npm is there");
    return;
  }
  const CliFixture cli;
  REQUIRE(cli.parallax({"run", "edge.yaml", "--out", "run"}).code == 1);
  REQUIRE(cli.parallax({"export", "run", "--format", "mcap", "-o", "motion.mcap"}).code == 0);
  const auto csv = cli.parallax({"export", "run"}).out;
  const auto result =
      run_process({"node", std::string(PARALLAX_SOURCE_DIR) + "/tests/tools/recording/read_mcap.js",
                   modules.string(), (cli.folder() / "motion.mcap").string()},
                  {});
  CAPTURE(result.err);
  REQUIRE(result.code == 0);
  const auto read = Json::parse(result.out);
  CHECK(read.at("library") == "parallax");
  CHECK(read.at("chunks").get<int>() >= 1);
  CHECK(read.at("summary") == 4);
  const auto& topics = read.at("topics");
  CHECK(topics.at("/scene").at("schema") == "foxglove.SceneUpdate");
  CHECK(topics.at("/scene").at("count") == 1);
  CHECK(topics.at("/tf").at("schema") == "foxglove.FrameTransforms");
  CHECK(topics.at("/events").at("schema") == "foxglove.Log");
  for (const auto& [name, topic] : topics.items()) CHECK(topic.at("encoding") == "json");
  // The last place of the box is that of the other export.
  const auto last = rows_of(csv, "box").back();
  const auto& box = read.at("poses").at("box").back();
  CHECK(box.at("parent") == "world");
  CHECK(box.at("x").get<double>() == doctest::Approx(last[1]).epsilon(1e-3));
  CHECK(box.at("z").get<double>() == doctest::Approx(last[3]).epsilon(1e-3));
  bool has_box = false;
  for (const auto& entity : read.at("entities")) {
    if (entity.at("id") != "box") continue;
    has_box = true;
    CHECK(entity.at("frame_id") == "box");
    CHECK(entity.at("cubes").size() == 1);
  }
  CHECK(has_box);
  CHECK(read.at("observed").contains("box.x"));
  const auto log = read.at("log").dump();
  CHECK(holds_text(log, " begins"));
  CHECK(holds_text(log, "holds box"));
}

}  // namespace
}  // namespace parallax::test
