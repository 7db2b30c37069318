// The log has the shape that readers of SARIF 2.1.0 rely on.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "compiler/base/codes/files.h"
#include "compiler/base/codes/names.h"
#include "compiler/base/diagnostic_printer.h"

namespace parallax::base {
namespace {

using nlohmann::json;

struct SarifText {
  SourceFiles files;
  DiagnosticSink sink;
  FileId file;

  explicit SarifText(const std::string& text, const std::string& name = "folder/model one.e")
      : file(files.add(name, text)) {}
  SourceRange find(const std::string& word, std::size_t from = 0) const {
    const auto at = files[file].text().find(word, from);
    const auto begin = static_cast<std::uint32_t>(at);
    return {file, begin, begin + static_cast<std::uint32_t>(word.size())};
  }
  json log() const { return json::parse(to_sarif(sink.sorted(), files, "1.2.3")); }
};

TEST_CASE("sarif: rules, results and regions fit together") {
  SarifText text("sort a\n; \xC3\xA4\xC3\xB6 note\nP(b) & Q(c).\n");
  text.sink.error(codes::kUnknownName, text.find("P(b)"), "predicate", "P", "")
      .note(text.find("sort a"), "declared here")
      .note("elsewhere")
      .fix("replace `P` with `R`");
  text.sink.warning(codes::kUnusedSort, text.find("a\n"), "a");
  text.sink.warning(codes::kUnusedSort, text.find("note"), "b");
  text.sink.error_about(codes::kFileNotFound, "some where.e", "gone");
  const auto log = text.log();
  CHECK(log["version"] == "2.1.0");
  CHECK(log["$schema"].is_string());
  REQUIRE(log["runs"].size() == 1);
  const auto& run = log["runs"][0];
  CHECK(run["columnKind"] == "unicodeCodePoints");
  const auto& driver = run["tool"]["driver"];
  CHECK(driver["name"] == "parallax");
  CHECK(driver["version"] == "1.2.3");

  std::set<std::string> ids;
  for (const auto& rule : driver["rules"]) {
    CHECK(ids.insert(rule["id"]).second);
    CHECK_FALSE(rule["shortDescription"]["text"].get<std::string>().empty());
    CHECK_FALSE(rule["help"]["text"].get<std::string>().empty());
  }
  CHECK(ids == std::set<std::string>{"E0001", "E2101", "W2104"});

  const auto& results = run["results"];
  REQUIRE(results.size() == 4);
  std::set<std::string> fingerprints;
  for (const auto& result : results) {
    CHECK(driver["rules"][result["ruleIndex"].get<std::size_t>()]["id"] == result["ruleId"]);
    const auto id = result["ruleId"].get<std::string>();
    CHECK(result["level"] == (id[0] == 'E' ? "error" : "warning"));
    CHECK_FALSE(result["message"]["text"].get<std::string>().empty());
    REQUIRE(result["locations"].size() == 1);
    const auto& place = result["locations"][0]["physicalLocation"];
    CHECK_FALSE(place["artifactLocation"]["uri"].get<std::string>().empty());
    for (const auto& value : result["partialFingerprints"]) fingerprints.insert(value);
  }
  CHECK(fingerprints.size() == 4);

  const auto& missing = results[0]["locations"][0]["physicalLocation"];
  CHECK(missing["artifactLocation"]["uri"] == "some%20where.e");
  CHECK_FALSE(missing.contains("region"));
  const auto& note = results[2]["locations"][0]["physicalLocation"];
  CHECK(note["artifactLocation"]["uri"] == "folder/model%20one.e");
  CHECK(note["region"]["startLine"] == 2);
  CHECK(note["region"]["startColumn"] == 6);  // code points, not bytes
  CHECK(note["region"]["endColumn"] == 10);
  const auto& unknown = results[3];
  CHECK(unknown["ruleId"] == "E2101");
  REQUIRE(unknown["relatedLocations"].size() == 2);
  CHECK(unknown["relatedLocations"][0]["physicalLocation"]["region"]["startLine"] == 1);
  CHECK_FALSE(unknown["relatedLocations"][1].contains("physicalLocation"));
  CHECK(unknown["message"]["text"].get<std::string>().find("replace `P`") != std::string::npos);
}

TEST_CASE("sarif: fingerprints stay when other lines come and go, and change with their own") {
  const auto print = [](const std::string& text) {
    SarifText one(text);
    one.sink.warning(codes::kUnusedSort, one.find("sort b"), "b");
    return one.log()["runs"][0]["results"][0]["partialFingerprints"].dump();
  };
  const auto first = print("sort a\nsort b\n");
  CHECK(print("; head\n\nsort a\n  sort b\nsort c\n") == first);
  CHECK(print("sort a\nsort b, c\n") != first);
}

TEST_CASE("sarif: equal lines get fingerprints that differ") {
  SarifText text("sort b\nsort b\n");
  text.sink.warning(codes::kUnusedSort, text.find("sort b"), "b");
  text.sink.warning(codes::kUnusedSort, text.find("sort b", 3), "b");
  const auto results = text.log()["runs"][0]["results"];
  REQUIRE(results.size() == 2);
  CHECK(results[0]["partialFingerprints"] != results[1]["partialFingerprints"]);
}

TEST_CASE("sarif: absolute paths become relative below the current folder") {
  const auto here = std::filesystem::current_path();
  SarifText inside("x", (here / "sub" / "m.e").string());
  inside.sink.warning(codes::kUnusedSort, inside.find("x"), "x");
  const auto place = [](const json& log) {
    return log["runs"][0]["results"][0]["locations"][0]["physicalLocation"]["artifactLocation"]
              ["uri"];
  };
  CHECK(place(inside.log()) == "sub/m.e");
  SarifText outside("x", "/nowhere/m.e");
  outside.sink.warning(codes::kUnusedSort, outside.find("x"), "x");
  CHECK(place(outside.log()) == "file:///nowhere/m.e");
}

TEST_CASE("sarif: without diagnostics there is a log all the same") {
  const auto log = SarifText("").log();
  CHECK(log["runs"][0]["results"] == json::array());
  CHECK(log["runs"][0]["tool"]["driver"]["rules"] == json::array());
}

}  // namespace
}  // namespace parallax::base
