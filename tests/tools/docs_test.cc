// Checks that the documentation describes what the program does.

#include <doctest/doctest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

#include "compiler/base/diagnostic.h"
#include "tests/tools/cli_fixture.h"
#include "tests/tools/rounded.h"

namespace parallax::test {
namespace {

namespace fs = std::filesystem;

std::string document(const std::string& name) {
  std::ifstream in(std::string(PARALLAX_SOURCE_DIR) + "/" + name);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

TEST_CASE("every code is printed, and its kind stands on the page about diagnostics") {
  const CliFixture cli;
  const auto printed = cli.parallax({"diagnostics"}).out;
  const auto page = document("docs/reference/diagnostics.md");
  for (const auto& info : base::all_diagnostics()) {
    const auto id = std::string(info.id);
    CHECK_MESSAGE(printed.find("| " + id + " |") != std::string::npos, id);
    const auto kind = id.starts_with("CPL") ? "CPL" : id.substr(0, id[1] == '-' ? 2 : 3);
    CHECK_MESSAGE(std::regex_search(page, std::regex("\\n\\|[^|]*\\b" + kind + "[,; ][^|]*\\|")),
                  id);
  }
}

TEST_CASE("`diagnostics CODE` says what to do, and refuses other words") {
  const CliFixture cli;
  for (const auto& info : base::all_diagnostics()) {
    if (info.id != "E0001" && info.id != "W-PAR") continue;
    const auto printed = cli.parallax({"diagnostics", std::string(info.id)});
    CHECK(printed.code == 0);
    for (const auto part : {info.id, info.format, info.help}) {
      CHECK_MESSAGE(printed.out.find(part) != std::string::npos, printed.out);
    }
  }
  const auto refused = cli.parallax({"diagnostics", "E0001", "E001"});
  CHECK(refused.code == 2);
  CHECK(refused.out.empty());
  CHECK_MESSAGE(refused.err.find("there is no such code") != std::string::npos, refused.err);
}

TEST_CASE("codes and names of diagnostics are unique") {
  std::set<std::string_view> ids;
  for (const auto& info : base::all_diagnostics()) {
    CHECK_MESSAGE(ids.insert(info.id).second, info.id << " is used twice");
    CHECK_MESSAGE(!info.help.empty(), info.id << " does not say what to do");
    const bool warning = info.severity == base::Severity::kWarning;
    CHECK_MESSAGE(warning == info.id.starts_with('W'), info.id << " has the wrong letter");
  }
}

TEST_CASE("every page that a text of the project names exists") {
  const std::regex page("docs/[a-z_/]+\\.md");
  const fs::path root = PARALLAX_SOURCE_DIR;
  std::set<std::string> named;
  for (const auto* folder : {"compiler", "runtime", "harness", "tools", "docs", "scenarios"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (!entry.is_regular_file()) continue;
      const auto text = document(fs::relative(entry.path(), root).string());
      for (auto it = std::sregex_iterator(text.begin(), text.end(), page);
           it != std::sregex_iterator(); ++it) {
        named.insert(it->str());
      }
    }
  }
  CHECK(named.size() > 5);
  for (const auto& name : named) CHECK_MESSAGE(fs::exists(root / name), name);
}

TEST_CASE("the page about the command line is what tools/update_docs makes") {
  const CliFixture cli;
  const auto page = document("docs/reference/command_line.md");
  std::istringstream lines(cli.parallax({"--help"}).out);
  const std::regex command("  ([a-z][a-z-]*) +([^ ].*)");
  std::smatch part;
  std::size_t commands = 0;
  for (std::string line; std::getline(lines, line) && line != "Examples:";) {
    if (!std::regex_match(line, part, command)) continue;
    const auto shown = "- `" + part[1].str() + "`: " + part[2].str() + '\n';
    CHECK_MESSAGE(page.find(shown) != page.npos, line);
    ++commands;
  }
  const std::regex item("\n- `");
  CHECK(commands > 30);
  CHECK(static_cast<std::size_t>(
            std::distance(std::sregex_iterator(page.begin(), page.end(), item), {})) == commands);
  for (const auto* topic : {"exit-codes", "files", "output", "seeds", "trust", "limits"}) {
    CHECK(cli.parallax({"help", topic}).code == 0);
    CHECK_MESSAGE(page.find('`' + std::string(topic) + '`') != page.npos, topic);
  }
}

TEST_CASE("every link from page to page leads to a file") {
  const fs::path root = PARALLAX_SOURCE_DIR;
  std::vector<fs::path> pages = {root / "README.md", root / "CHANGELOG.md"};
  for (const auto* folder : {"docs", "scenarios"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() == ".md") pages.push_back(entry.path());
    }
  }
  const std::regex link(R"(\]\(([^)#\s:]+)(#[^)\s]*)?\))");
  std::size_t links = 0;
  for (const auto& page : pages) {
    const auto text = document(fs::relative(page, root).string());
    for (auto it = std::sregex_iterator(text.begin(), text.end(), link);
         it != std::sregex_iterator(); ++it, ++links) {
      const auto target = page.parent_path() / (*it)[1].str();
      CHECK_MESSAGE(fs::exists(target), fs::relative(page, root).string() << ": " << it->str());
    }
  }
  CHECK(links > 200);
}

TEST_CASE("every folder of scenarios asks a question, with command, time, answer and picture") {
  const fs::path root = PARALLAX_SOURCE_DIR;
  std::size_t folders = 0;
  for (const auto& entry : fs::directory_iterator(root / "scenarios")) {
    if (!entry.is_directory()) continue;
    ++folders;
    CAPTURE(entry.path());
    const auto text = document(fs::relative(entry.path() / "README.md", root).string());
    CHECK(std::regex_search(text, std::regex(R"(\*\*Question:\*\* [^?]+\?\s\*\*Answer:\*\* )")));
    CHECK(std::regex_search(text, std::regex("\n    [^\n]*parallax [^\n]+    # [^\n]*[0-9] s\n")));
    // The classic problems have nothing to draw: a trace is shown.
    const bool has_trace = text.find("\n    trace 1\n") != std::string::npos;
    CHECK((has_trace || std::regex_search(text, std::regex(R"(!\[[^\]]+\]\()"))));
  }
  CHECK(folders > 8);
}

TEST_CASE("an entry of the changelog has at most three lines") {
  std::istringstream lines(document("CHANGELOG.md"));
  std::size_t entries = 0, length = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool begins = line.starts_with("- ");
    entries += begins ? 1 : 0;
    length = begins ? 1 : line.starts_with("  ") ? length + 1 : 0;
    CHECK_MESSAGE(length <= 3, line);
  }
  CHECK(entries > 20);
}

TEST_CASE("the documentation stays short: pages of 350 kB, a README of 5 kB") {
  const fs::path root = PARALLAX_SOURCE_DIR;
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") bytes += entry.file_size();
  }
  CHECK(bytes > 100'000);
  CHECK(bytes <= 350'000);
  CHECK(document("README.md").size() <= 5'000);
}

TEST_CASE("every command of the README is one that the program knows") {
  const CliFixture cli;
  const auto help = cli.parallax({"--help"}).out;
  const auto readme = document("README.md");
  const std::regex command("parallax ([a-z]+)[ `]");
  std::set<std::string> seen;
  for (auto it = std::sregex_iterator(readme.begin(), readme.end(), command);
       it != std::sregex_iterator(); ++it) {
    seen.insert((*it)[1]);
  }
  CHECK(seen.contains("run"));
  for (const auto& name : seen) {
    CHECK_MESSAGE(help.find("  " + name + " ") != std::string::npos, "README names " << name);
  }
}

TEST_CASE("the README's first run prints what the README shows") {
  const CliFixture cli;
  const auto readme = document("README.md");
  const std::string prompt = "    $ parallax run scenarios/two_regions/edge.yaml\n";
  const auto begin = readme.find(prompt);
  REQUIRE(begin != std::string::npos);
  std::string shown;
  std::istringstream lines(readme.substr(begin + prompt.size()));
  for (std::string line; std::getline(lines, line) && (line.empty() || line.starts_with("    "));) {
    shown += (line.empty() ? line : line.substr(4)) + '\n';
  }
  shown.pop_back();  // the empty line behind the block
  ProcessOptions options;
  options.folder = PARALLAX_SOURCE_DIR;
  const auto folder = (cli.folder() / "edge").string();
  auto printed =
      cli.parallax({"run", "scenarios/two_regions/edge.yaml", "--out", folder}, options).out;
  REQUIRE(printed.find(folder) != std::string::npos);
  for (auto out = printed.find(folder); out != std::string::npos; out = printed.find(folder)) {
    printed.replace(out, folder.size(), "out/edge");
  }
  CHECK(rounded(printed) == rounded(shown));
}

}  // namespace
}  // namespace parallax::test
