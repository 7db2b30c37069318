// Names that changed: each is one line of `parallax diff`, found by how it is used.

#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>

#include "tests/tools/cli_json.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr const char* kTill =
    "sort person\nperson Bob, Eve\nrange time 0 2\n"
    "fluent Paid(person)\nfluent Open()\nevent Pay(person)\nevent Lift()\n"
    "[person,time] Initiates(Pay(person),Paid(person),time).\n"
    "[time] HoldsAt(Paid(Bob),time) -> Initiates(Lift(),Open(),time).\n"
    "[time] !Happens(Lift(),time) | HoldsAt(Paid(Bob),time).\n"
    "[person] !HoldsAt(Paid(person),0).\n!HoldsAt(Open(),0).\n";

std::string renamed(std::string text, const std::string& before, const std::string& after) {
  return std::regex_replace(text, std::regex("\\b" + before + "\\b"), after);
}

class Names : public CliFixture {
 public:
  Json compare(const std::string& before, const std::string& after, int code,
               const std::vector<std::string>& more = {}) const {
    write("old.e", before);
    write("new.e", after);
    std::vector<std::string> words = {"diff", "old.e", "new.e"};
    words.insert(words.end(), more.begin(), more.end());
    return json_of(*this, words, code);
  }
};

TEST_CASE(
    "a renamed constant, sort, fluent and event are a line each, and the traces are the same") {
  const Names cli;
  for (const auto& [before, after] : std::vector<std::pair<std::string, std::string>>{
           {"Bob", "Rob"}, {"person", "guest"}, {"Paid", "Settled"}, {"Lift", "Raise"}}) {
    CAPTURE(before);
    const auto found = cli.compare(kTill, renamed(kTill, before, after), 1);
    CHECK(found["renamed"] == Json::array({{{"old", before}, {"new", after}}}));
    CHECK(found["axioms"]["removed"].empty());
    CHECK(found["axioms"]["added"].empty());
    CHECK(found["axioms"]["changed"].empty());
    CHECK(found["declarations"]["removed"].empty());
    CHECK(found["declarations"]["changed"].empty());
    CHECK(found["traces"]["lost"]["answer"] == "none");
    CHECK(found["traces"]["gained"]["answer"] == "none");
    CHECK(found["traces"]["only_old"].empty());
  }
  cli.write("old.e", kTill);
  cli.write("new.e", renamed(renamed(kTill, "Bob", "Rob"), "Open", "Up"));
  const auto text = cli.parallax({"diff", "old.e", "new.e"}).out;
  CHECK(text.starts_with("names: 2 renamed\n  ~ Bob -> Rob\n  ~ Open -> Up\ntraces"));
  CHECK(cli.parallax({"diff", "old.e", "new.e", "--stat"}).out.starts_with("names: 2 renamed\n"));
}

TEST_CASE("what changed besides a name stands below it") {
  const Names cli;
  auto after = renamed(kTill, "Bob", "Rob");
  after.erase(after.find("[time] !Happens(Lift()"),
              after.find("[person] !HoldsAt") - after.find("[time] !Happens(Lift()"));
  const auto found = cli.compare(kTill, after, 1);
  CHECK(found["renamed"].size() == 1);
  CHECK(found["axioms"]["removed"].size() == 1);
  CHECK(found["axioms"]["changed"].empty());
  CHECK(found["traces"]["gained"]["answer"] == "found");
  CHECK(found["traces"]["lost"]["answer"] == "none");
}

TEST_CASE("other things of other names are no renaming, unless that is said") {
  const Names cli;
  // Kim does nothing that Bob did.
  const std::string other = renamed(kTill, "Bob", "Eve") + "person Kim\nHoldsAt(Paid(Kim),2).\n";
  CHECK(cli.compare(kTill, other, 1)["renamed"].empty());
  const auto said = cli.compare(kTill, other, 1, {"--rename", "Bob=Kim"});
  CHECK(said["renamed"] == Json::array({{{"old", "Bob"}, {"new", "Kim"}}}));
  CHECK(cli.parallax({"diff", "old.e", "new.e", "--rename", "Bob=Tom"}).code == 2);
  CHECK(cli.parallax({"diff", "old.e", "new.e", "--rename", "Tom=Kim"}).code == 2);
  CHECK(cli.parallax({"diff", "old.e", "new.e", "--rename", "Bob"}).code == 2);
  // Two names would become one: that of the old model stays, or two rules say the same.
  cli.write("two.e", std::string(kTill) + "person Kim\nHoldsAt(Paid(Kim),2).\n");
  CHECK(cli.parallax({"diff", "two.e", "new.e", "--rename", "Bob=Kim"}).code == 2);
  CHECK(
      cli.parallax({"diff", "two.e", "new.e", "--rename", "Bob=Kim", "--rename", "Kim=Kim"}).code ==
      2);
  // Exchanged names are well.
  CHECK(
      cli.parallax({"diff", "two.e", "new.e", "--rename", "Eve=Kim", "--rename", "Kim=Eve"}).code <=
      1);
  CHECK(cli.compare(kTill, kTill, 0)["renamed"].empty());
}

/// A copy of the scenario with a name replaced in every file.
void copy_renamed(const CliFixture& cli, const std::string& folder, const std::string& before,
                  const std::string& after) {
  fs::create_directories(cli.folder() / folder);
  for (const auto& [name, text] : files_below(cli.folder())) {
    if (name.find('/') != std::string::npos) continue;
    cli.write(folder + "/" + name, before.empty() ? text : renamed(text, before, after));
  }
}

TEST_CASE("a renamed region and body are a line each") {
  const CliFixture cli;
  copy_renamed(cli, "old", "", "");
  copy_renamed(cli, "region", "r1", "left");
  copy_renamed(cli, "body", "box", "crate");
  const auto region = json_of(cli, {"diff", "old/scenario.yaml", "region/scenario.yaml"}, 1);
  CHECK(region["renamed"] == Json::array({{{"old", "r1"}, {"new", "left"}}}));
  CHECK(region["settings"].empty());
  CHECK(region["axioms"]["changed"].empty());
  CHECK(region["traces"]["lost"]["answer"] == "none");
  const auto body =
      json_of(cli, {"diff", "old/scenario.yaml", "body/scenario.yaml", "--no-traces"}, 1);
  CHECK(body["renamed"] == Json::array({{{"old", "box"}, {"new", "crate"}}}));
  for (const auto& setting : body["settings"])
    CHECK(setting["changes"] == Json::array({"words only"}));
  // A rule of a gate is about what is written.
  cli.write("rules.yaml", "models: {world: forbidden}\n");
  const std::vector<std::string> gate = {"diff", "--gate", "rules.yaml", "old/scenario.yaml",
                                         "body/scenario.yaml"};
  CHECK(cli.parallax(gate).code == 1);
  auto said = gate;
  said.insert(said.end(), {"--rename", "box=crate"});
  CHECK(cli.parallax(said).code == 0);
}

}  // namespace
}  // namespace parallax::test
