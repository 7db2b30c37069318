#include <doctest/doctest.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {

TEST_CASE("the reference evaluator accepts every trace of the classic problems") {
  const auto folder = std::filesystem::path(PARALLAX_SOURCE_DIR) / "scenarios/classics";
  const auto manifest = YAML::LoadFile((folder / "suite.yaml").string());
  const CliFixture cli;
  int cases = 0;
  for (const auto& one : manifest["cases"]) {
    const auto traces = one["expect"]["traces"].as<int>(0);
    if (traces == 0 || !one["model"] || !one["model"].IsScalar()) continue;
    std::vector<std::string> words = {"traces",  (folder / one["model"].as<std::string>()).string(),
                                      "--check", "--limit",
                                      "0",       "--quiet"};
    words.push_back("--allow-outside");
    if (one["horizon"]) {
      words.insert(words.end(), {"--horizon", one["horizon"].as<std::string>()});
    }
    if (const auto constraint = one["constraints"]) {
      words.insert(words.end(), {"--until", constraint.as<std::string>()});
    }
    const auto result = cli.parallax(words);
    CAPTURE(one["id"].as<std::string>());
    CHECK_MESSAGE(result.code == 0, result.err);
    CHECK(result.out.find(", " + std::to_string(traces) + " checked\n") != std::string::npos);
    ++cases;
  }
  CHECK(cases >= 20);
}

}  // namespace parallax::test
