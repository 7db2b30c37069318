// `parallax schema`, and the documents of all commands held against the published schemas.

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "compiler/base/sha256.h"
#include "tests/tools/cli_json.h"
#include "tests/tools/schema/json_schema.h"

namespace parallax::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

const fs::path kHere = fs::path(PARALLAX_SOURCE_DIR) / "tests/tools/schema";

std::vector<json> listed_schemas(const CliFixture& cli) {
  return json_of(cli, {"schema", "--list"}).at("schemas").get<std::vector<json>>();
}

std::map<std::string, JsonSchema> all_schemas(const CliFixture& cli) {
  std::map<std::string, JsonSchema> out;
  for (const auto& one : listed_schemas(cli)) {
    const auto name = one.at("name").get<std::string>();
    out.emplace(name, JsonSchema(json::parse(cli.parallax({"schema", name}).out)));
  }
  return out;
}

/// Words of a line up to the last one, which has the rest.
std::vector<std::string> split(const std::string& line, std::size_t count) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; words.size() + 1 < count && in >> word;) words.push_back(word);
  std::string rest;
  std::getline(in >> std::ws, rest);
  words.push_back(rest);
  return words;
}

/// Runs the cases of cases.txt in a folder of its own.
class Cases {
 public:
  Cases() {
    for (const auto& file : fs::directory_iterator(kHere / "files")) {
      fs::copy(file.path(), cli_.folder() / file.path().filename());
    }
  }

  /// Documents of one case, each with the name of its schema.
  std::pair<std::string, std::vector<json>> documents(const std::string& line) {
    if (line.starts_with("$ ")) {
      const auto result = shell(line.substr(2));
      CAPTURE(result.err);
      CHECK(result.code == 0);
      return {};
    }
    const auto words = split(line, 3);
    const auto& name = words.at(0);
    if (words.at(1) == "<") return {name, {json::parse(cli_.read(words.at(2)))}};
    if (words.at(1) == "lines") return {name, lines(cli_.read(words.at(2).substr(2)))};
    // What stands behind `--` is a command of another program.
    auto arguments = words.at(2);
    const auto behind = arguments.find(" -- ");
    arguments.insert(behind == std::string::npos ? arguments.size() : behind, " --json");
    const auto result = shell("parallax " + arguments);
    CAPTURE(result.out.substr(0, 2000));
    CAPTURE(result.err);
    CHECK(std::to_string(result.code) == words.at(1));
    REQUIRE(json::accept(result.out));
    return {name, {json::parse(result.out)}};
  }

  const CliFixture& cli() const { return cli_; }

 private:
  ProcessResult shell(const std::string& command) {
    ProcessOptions options;
    options.folder = cli_.folder().string();
    const auto folder = fs::path(CliFixture::program()).parent_path().string();
    return run_process({"sh", "-c", "PATH=\"$0:$PATH\"; " + command, folder}, options);
  }

  static std::vector<json> lines(const std::string& text) {
    std::vector<json> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(json::parse(line));
    return out;
  }

  CliFixture cli_;
};

TEST_CASE("every schema is one, and leaves no object open") {
  const CliFixture cli;
  for (const auto& [name, schema] : all_schemas(cli)) {
    CAPTURE(name);
    const auto faults = schema.faults();
    CHECK(faults == std::vector<std::string>());
  }
}

TEST_CASE("what commands print is what their schemas say, and they say nothing else") {
  Cases cases;
  auto schemas = all_schemas(cases.cli());
  std::map<std::string, int> seen;
  std::ifstream in(kHere / "cases.txt");
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.starts_with('#')) continue;
    CAPTURE(line);
    const auto [name, documents] = cases.documents(line);
    if (name.empty()) continue;
    REQUIRE(schemas.contains(name));
    for (const auto& document : documents) {
      CAPTURE(document.dump().substr(0, 2000));
      const auto errors = schemas.at(name).errors(document);
      CHECK(errors == std::vector<std::string>());
      ++seen[name];
    }
  }
  std::size_t unseen = 0;
  std::set<std::string> shared;  // keys of definitions that several schemas have
  for (const auto& [name, schema] : schemas) {
    if (name.ends_with(".yaml")) continue;  // files that are read (yaml_schema_test)
    CAPTURE(name);
    CHECK(seen[name] > 0);
    for (const auto& key : schema.unseen()) {
      if (key.starts_with("#/$defs/")) {
        shared.insert(key);
        continue;
      }
      std::cout << "no document of this test has " << name << ' ' << key << '\n';
      ++unseen;
    }
  }
  for (const auto& [name, schema] : schemas) {
    for (const auto& key : schema.seen()) shared.erase(key);
  }
  for (const auto& key : shared) {
    if (key.starts_with("#/$defs/yaml_")) continue;
    std::cout << "no document of this test has " << key << '\n';
    ++unseen;
  }
  std::cout << unseen << " keys of schemas were not seen\n";
}

TEST_CASE("a key that is new, is missing or changed its type is noticed") {
  const CliFixture cli;
  auto schemas = all_schemas(cli);
  const auto document = json_of(cli, {"traces", "edge.yaml"});
  auto& traces = schemas.at("traces");
  REQUIRE(traces.errors(document).empty());
  auto changed = document;
  changed["news"] = 1;
  CHECK(traces.errors(changed) == std::vector<std::string>{": has the unknown key `news`"});
  changed = document;
  changed["list"][0]["timepoints"][0].erase("holds");
  CHECK(traces.errors(changed) == std::vector<std::string>{"/list/0/timepoints/0: lacks `holds`"});
  changed = document;
  changed["complete"] = "yes";
  CHECK(traces.errors(changed) == std::vector<std::string>{"/complete: \"yes\" is no \"boolean\""});
  changed = document;
  changed["status"] = "fine";
  CHECK(!traces.errors(changed).empty());
}

TEST_CASE("a changed schema has a new version") {
  const CliFixture cli;
  std::string now;
  for (const auto& one : listed_schemas(cli)) {
    const auto name = one.at("name").get<std::string>();
    const auto text = cli.parallax({"schema", name}).out;
    now += name + ' ' + one.at("version").get<std::string>() + ' ' +
           base::sha256_hex(text).substr(0, 16);
    now += '\n';
  }
  const auto kept = kHere / "versions.txt";
  if (const auto* update = std::getenv("PARALLAX_UPDATE_GOLDEN"); update != nullptr) {
    std::ofstream(kept) << now;
  }
  std::ifstream in(kept);
  const std::string before{std::istreambuf_iterator<char>(in), {}};
  INFO(
      "a schema changed: raise its version (the second number if keys were added, else the first), "
      "tell it in CHANGELOG.md, and run this test with PARALLAX_UPDATE_GOLDEN=1");
  CHECK(now == before);
}

TEST_CASE("a schema says what it is of, and names what there is not") {
  const CliFixture cli;
  const auto schema = json::parse(cli.parallax({"schema", "traces"}).out);
  CHECK(schema.at("$schema") == "https://json-schema.org/draft/2020-12/schema");
  CHECK(schema.at("$id") ==
        "urn:parallax:schema:traces:" + schema.at("version").get<std::string>());
  CHECK(schema.at("$defs").contains("timepoint"));
  CHECK(!schema.at("$defs").contains("rate"));
  // With --json it is the one document, too.
  CHECK(json_of(cli, {"schema", "traces"}) == schema);
  CHECK(cli.parallax({"schema", "man"}).out == cli.parallax({"schema", "help"}).out);
  CHECK(cli.parallax({"schema", "--list"}).out.find("\nrun ") != std::string::npos);
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"schema"}, {"schema", "run", "--list"}, {"schema", "common"}}) {
    CHECK(cli.parallax(wrong).code == 2);
  }
  const auto result = cli.parallax({"schema", "trace"});
  CHECK(result.code == 2);
  CHECK(result.err.find("fix: replace `trace` with `traces`") != std::string::npos);
}

TEST_CASE("every command whose answer is a document has a schema") {
  const CliFixture cli;
  // These print a table, or speak the protocol of simulators.
  const std::set<std::string> without = {"diagnostics", "lsp", "record", "replay-adapter"};
  std::istringstream in(cli.parallax({"--help"}).out);
  std::size_t commands = 0;
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with("  ") || line.starts_with("  -") || line.starts_with("   ")) continue;
    const auto name = line.substr(2, line.find(' ', 2) - 2);
    if (line.find("parallax " + name) != std::string::npos || name == "parallax") continue;
    CAPTURE(name);
    ++commands;
    CHECK((cli.parallax({"schema", name}).code == 0) == !without.contains(name));
  }
  CHECK(commands > 30);
}

}  // namespace
}  // namespace parallax::test
