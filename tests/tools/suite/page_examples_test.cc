// The commands and files of docs/reference/suites.md, played in a repository with
// scenarios/two_regions: each does what the page shows.

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include "tests/support/xml.h"
#include "tests/tools/history/git_repository.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

struct Example {
  std::vector<std::string> words;  // behind `parallax`
  std::string shown;               // what the page prints below it
};

/// The indented blocks of a page.
std::vector<std::string> blocks_of(const std::string& page) {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/docs/" + page);
  std::vector<std::string> out;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    const bool is_block = line.starts_with("    ");
    if (is_block && !inside) out.emplace_back();
    if (is_block) out.back() += line.substr(4) + '\n';
    if (!line.empty()) inside = is_block;
  }
  return out;
}

/// The commands of a page, `$ parallax ...`.
std::vector<Example> examples_of(const std::string& page) {
  std::vector<Example> out;
  for (const auto& block : blocks_of(page)) {
    std::istringstream lines(block);
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
      if (line.starts_with("$ parallax ")) {
        std::istringstream words(line.substr(11));
        out.emplace_back();
        for (std::string word; words >> word;) out.back().words.push_back(word);
        inside = true;
      } else if (inside) {
        out.back().shown += line + '\n';
      }
    }
  }
  return out;
}

const Example& find(const std::vector<Example>& examples, const std::string& word) {
  const auto at = std::find_if(examples.begin(), examples.end(), [&](const Example& one) {
    return std::count(one.words.begin(), one.words.end(), word) > 0;
  });
  REQUIRE_MESSAGE(at != examples.end(), word);
  return *at;
}

/// Lines in an order of their own, without times.
std::set<std::string> sorted_lines(const std::string& text) {
  static const std::regex time(R"( \([0-9.]+ s\))");
  std::set<std::string> out;
  std::istringstream lines(std::regex_replace(text, time, ""));
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) out.insert(line);
  }
  return out;
}

/// `scenarios/two_regions` as a repository of git.
class Repository : public GitFixture {
 public:
  Repository() {
    fs::create_directories(folder() / "scenarios");
    fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios/two_regions",
             folder() / "scenarios/two_regions", fs::copy_options::recursive);
    for (const auto* name : {"scenario.yaml", "edge.yaml", "wrong_model.yaml"}) {
      fs::remove(folder() / name);
    }
    // The page shows nothing that depends on the number of runs.
    const std::string common = "scenarios/two_regions/common.yaml";
    write(common, read(common) + "criterion: {kind: clean-runs, epsilon: 0.15}\n");
    write(".gitignore", "out\nhistory.jsonl\n");
  }
  ProcessResult play(const Example& example) const { return parallax(example.words); }
};

/// Everything that the page shows is printed, but for hashes and what it leaves out.
void check_bisect(const GitFixture& cli, const Example& bisect) {
  const auto found = cli.parallax(bisect.words);
  CHECK_MESSAGE(found.code == 1, found.err);
  std::istringstream lines(bisect.shown);
  for (std::string line; std::getline(lines, line);) {
    if (line.ends_with("...")) continue;
    const auto text = line.starts_with(' ') ? line : line.substr(line.find(' '));
    CHECK_MESSAGE(has(found.out, text), found.out);
  }
}

TEST_CASE("the suites of the page") {
  const Repository cli;
  const auto examples = examples_of("reference/suites.md");
  const auto& first = find(examples, "--jobs");
  const auto suite = cli.play(first);
  CHECK(suite.code == 0);
  CHECK(sorted_lines(suite.out + suite.err) == sorted_lines(first.shown));

  const auto listed = cli.play(find(examples, "--collect-only"));
  CHECK(listed.code == 0);
  CHECK(std::count(listed.out.begin(), listed.out.end(), '\n') == 3);

  // The page shows the second of four parts; the others are like it.
  auto part = find(examples, "--shard");
  for (int i = 1; i <= 4; ++i) {
    for (auto& word : part.words) {
      if (word.ends_with("/4")) word = fmt::format("{}/4", i);
      if (word.starts_with("out/")) word = fmt::format("out/{}", i);
    }
    CHECK(cli.parallax(part.words).code == 0);
  }
  CHECK(cli.play(find(examples, "--merge")).code == 0);
  CHECK(parse_xml(cli.read("suite.xml")).all("testcase").size() == 3);
}

TEST_CASE("the manifest and the quarantine of the page") {
  const CliFixture cli;
  fs::copy(fs::path(PARALLAX_SOURCE_DIR) / "scenarios/classics", cli.folder() / "m",
           fs::copy_options::recursive);
  cli.write("m/lamp.e",
            "range time 0 1\nfluent On()\nevent Press()\n[time] Initiates(Press(),On(),time).\n");
  bool has_manifest = false, has_quarantine = false;
  for (const auto& block : blocks_of("reference/suites.md")) {
    if (block.starts_with("defaults:")) {
      cli.write("m/suite.yaml", block);
      const auto result = cli.parallax({"suite", "m/suite.yaml"});
      CHECK_MESSAGE(result.code == 0, result.out);
      CHECK(result.out == "3 passed, 0 failed\n");
      has_manifest = true;
    } else if (block.starts_with("quarantine:")) {
      cli.write("known.yaml", block);
      const auto result = cli.parallax({"suite", "m/suite.yaml", "--quarantine", "known.yaml"});
      CHECK(result.code == 0);
      CHECK(has(result.err, "which is no case"));
      has_quarantine = true;
    }
  }
  CHECK(has_manifest);
  CHECK(has_quarantine);
}

TEST_CASE("the history of the page, and its search for a revision") {
  const Repository cli;
  const auto examples = examples_of("reference/suites.md");
  cli.commit("first");
  cli.git({"tag", "v1.2"});
  const auto& suite = find(examples, "--history");
  CHECK(cli.play(suite).code == 0);
  cli.write("scenarios/two_regions/notes.md", "a note\n");
  cli.commit("Take notes");
  // The box is held in its middle and goes to the middle of r1.
  cli.replace("scenarios/two_regions/edge.lisp", "0.985", "0.5");
  cli.replace("scenarios/two_regions/edge.lisp", "0.7", "0.5");
  cli.commit("Grip the box in its middle");
  const auto second = cli.play(suite);
  CHECK(second.code == 1);
  const auto where = second.err.find(": scenarios/two_regions/edge.yaml: ");
  REQUIRE_MESSAGE(where != std::string::npos, second.err);
  CHECK(has(suite.shown, second.err.substr(where, second.err.find('\n', where) - where)));
  CHECK(cli.parallax({"report", "--history", "history.jsonl", "-o", "history.html"}).code == 0);

  check_bisect(cli, find(examples, "scenarios/two_regions/edge.yaml"));
}

TEST_CASE("the search of the page for the revision that broke a case") {
  const GitFixture cli;
  fs::create_directories(cli.folder() / "cases");
  cli.write("cases/lock.e",
            "range time 0 2\nfluent Open()\nfluent Unlocked()\nevent Pull()\nevent Unlock()\n"
            "[time] HoldsAt(Unlocked(),time) -> Initiates(Pull(),Open(),time).\n"
            "[time] Initiates(Unlock(),Unlocked(),time).\n"
            "!HoldsAt(Open(),0).\n!HoldsAt(Unlocked(),0).\n");
  cli.write("cases/suite.yaml",
            "cases:\n  - {id: lock_opens, model: lock.e, constraints: 'HoldsAt(Open(),time)', "
            "expect: {traces: 4}}\n");
  cli.commit("first");
  cli.git({"tag", "v1.2"});
  cli.write("cases/lock.e", "; A lock.\n" + cli.read("cases/lock.e"));
  cli.commit("Say what it is");
  cli.replace("cases/lock.e", "HoldsAt(Unlocked(),time) -> ", "");
  cli.commit("Open without a key");
  cli.write("cases/lock.e", cli.read("cases/lock.e") + "; The end.\n");
  cli.commit("Say that it ends");
  check_bisect(cli, find(examples_of("reference/suites.md"), "cases/suite.yaml:lock_opens"));
}

}  // namespace
}  // namespace parallax::test
