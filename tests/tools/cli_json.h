#pragma once

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/tools/cli_fixture.h"

namespace parallax::test {

/// The document that `parallax ARGUMENTS... --json` prints in the fixture's folder. The output must
/// be one JSON document, and the exit code the expected one.
inline nlohmann::json json_of(const CliFixture& cli, std::vector<std::string> arguments,
                              int expected_code = 0) {
  arguments.emplace_back("--json");
  const auto result = cli.parallax(std::move(arguments));
  CAPTURE(result.err);
  CAPTURE(result.out);
  CHECK(result.code == expected_code);
  REQUIRE(nlohmann::json::accept(result.out));
  return nlohmann::json::parse(result.out);
}

}  // namespace parallax::test
